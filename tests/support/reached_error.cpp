// SPDX-License-Identifier: Apache-2.0
#include "tests/support/reached_error.h"

#include <cmath>
#include <string>

#include "core/image/metrics.h"
#include "renderer/render.h"

namespace spectrace::test {

namespace {

constexpr int kSize = 48;

SceneDesc small_scene(const std::string& name) {
  SceneDesc scene = load_scene(std::string(SPECTRACE_SOURCE_DIR "/scenes/") + name + ".json");
  scene.film.width = scene.film.height = kSize;
  return scene;
}

}  // namespace

ReachedError render_until(const std::string& name, double relative_error) {
  SilentProgress progress;
  const Scene scene = build_scene(small_scene(name), progress);
  RenderSession session(scene,
                        {.spp = 1 << 20, .seed = 7, .aovs = kNoAovs, .relative_error = relative_error});
  session.finish(progress);
  const Image image = session.film().resolve();
  RenderSession long_session(
      scene, {.spp = 1 << 20, .seed = 8, .aovs = kNoAovs, .relative_error = relative_error / 3});
  long_session.finish(progress);
  const Image reference = long_session.film().resolve();
  double squares = 0, sum = 0;
  std::size_t count = 0;
  for (const int c : {0, 1, 2}) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x, ++count) sum += double(reference.at(x, y, c));
    }
  }
  const double mean = sum / double(count), epsilon = kRelativeEpsilon * mean * mean;
  for (const int c : {0, 1, 2}) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const double r = reference.at(x, y, c), d = image.at(x, y, c) - r;
        squares += d * d / (r * r + epsilon);
      }
    }
  }
  const double known = long_session.film().relative_error();
  return {std::sqrt(squares / double(count) - known * known), session.report().samples.count()};
}

}  // namespace spectrace::test
