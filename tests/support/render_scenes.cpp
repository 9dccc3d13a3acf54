// SPDX-License-Identifier: Apache-2.0
#include "tests/support/render_scenes.h"

#include <cmath>

#include "core/base/error.h"
#include "core/math/math.h"

namespace spectrace::test {

namespace {

std::vector<ShapeDesc> box(const std::string& material, bool inward) {
  std::vector<ShapeDesc> walls;
  for (int axis = 0; axis < 3; ++axis) {
    for (Float side : {Float(-1), Float(1)}) {
      Float p[3], u[3] = {0, 0, 0}, v[3] = {0, 0, 0};
      p[axis] = side;
      p[(axis + 1) % 3] = -1;
      p[(axis + 2) % 3] = -1;
      u[(axis + 1) % 3] = 2;
      v[(axis + 2) % 3] = 2;
      const Vec3 corner{p[0], p[1], p[2]}, a{u[0], u[1], u[2]}, b{v[0], v[1], v[2]};
      // a x b points along +axis: outwards on the positive side.
      const bool along = (side > 0) != inward;
      walls.push_back(along ? quad(corner, a, b, material) : quad(corner, b, a, material));
    }
  }
  return walls;
}

}  // namespace

std::vector<ShapeDesc> inward_box(const std::string& material) { return box(material, true); }
std::vector<ShapeDesc> outward_box(const std::string& material) { return box(material, false); }

MeshDesc polyhedral_sphere(int rings, int segments) {
  MeshDesc mesh;
  for (int r = 0; r <= rings; ++r) {
    const double theta = kPi64 * r / rings;
    for (int s = 0; s < segments; ++s) {
      const double phi = 2 * kPi64 * s / segments;
      mesh.positions.push_back({Float(std::sin(theta) * std::cos(phi)),
                                Float(std::sin(theta) * std::sin(phi)), Float(std::cos(theta))});
    }
  }
  const auto index = [&](int r, int s) { return std::uint32_t(r * segments + s % segments); };
  for (int r = 0; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      if (r > 0) mesh.triangles.push_back({index(r, s), index(r + 1, s), index(r, s + 1)});
      if (r + 1 < rings) mesh.triangles.push_back({index(r, s + 1), index(r + 1, s), index(r + 1, s + 1)});
    }
  }
  return mesh;
}

RenderResult render_scene(const SceneDesc& scene, RenderOptions options) {
  SilentProgress progress;
  return render(build_scene(scene, progress), options, progress);
}

Xyz pixel_xyz(const Image& image, int x, int y, const std::string& layer) {
  const std::string prefix = layer.empty() ? "" : layer + ".";
  Rgb rgb;
  for (int c = 0; c < 3; ++c) {
    const auto channel = image.find_channel(prefix + "RGB"[c]);
    SPECTRACE_CHECK(channel.has_value());
    rgb[c] = image.at(x, y, *channel);
  }
  return rgb_to_xyz(rgb);
}

Estimate estimate_xyz(const Image& image, const std::string& layer, int component) {
  double sum = 0, squares = 0;
  const double n = double(image.width) * image.height;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double value = pixel_xyz(image, x, y, layer)[component];
      sum += value;
      squares += value * value;
    }
  }
  const double mean = sum / n;
  const double variance = std::max(0.0, (squares - n * mean * mean) / (n - 1));
  return {mean, std::sqrt(variance / n)};
}

}  // namespace spectrace::test
