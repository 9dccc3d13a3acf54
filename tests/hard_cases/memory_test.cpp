// SPDX-License-Identifier: Apache-2.0
// H19, memory: what would not fit is refused with an estimate, before it is taken. What damaged files may
// take is bounded by their size: the readers' tests.
#include "core/base/memory.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "renderer/render.h"
#include "tests/support/render_scenes.h"
#include "tests/support/run_program.h"
#include "tests/support/synthetic_measured.h"

namespace spectrace::test {
namespace {

TEST(H19_Memory, MoreThanThereIsIsRefusedByName) {
  const auto available = available_memory_bytes();
  ASSERT_TRUE(available) << "Linux tells";
  EXPECT_GT(*available, 0U);
  EXPECT_NO_THROW(require_memory(*available / 2, "scene.json", "/film", "this"));
  try {
    require_memory(std::uint64_t(1) << 60, "scene.json", "/film", "this");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.diagnostics().at(0).text().find(
                  "scene.json:/film: this takes about 1152921504.61 GB of memory, and "),
              0U)
        << e.diagnostics().at(0).text();
  }
}

TEST(H19_Memory, AFilmHoldsWhatWasEstimated) {
  SceneDesc desc = empty_scene();
  desc.film.spectral = SpectralFilmDesc{.bins = {.range = desc.range, .count = 20}};
  SilentProgress progress;
  const Scene scene = build_scene(desc, progress);
  for (const int spp : {8, 16, 56, 100}) {
    RenderSession session(scene, {.spp = spp});
    session.finish(progress);
    const Film& film = session.film();
    std::uint64_t held = 0;
    for (const Film::Plane& plane : film.planes()) {
      held += plane.rows.size() * sizeof(double) + plane.bins.size() * sizeof(float);
    }
    const std::uint64_t image =
        std::max(film.resolve().data.size(), film.resolve_spectral(Layer::kBeauty).data.size()) *
        sizeof(float);
    EXPECT_EQ(Film::memory_bytes(film.width(), film.height(), film.layout(), film.target()), held + 2 * image)
        << spp;
  }
}

TEST(H19_Memory, PicturesAndTablesThatWouldNotFitAreInputErrors) {
  // Terabytes each, within what the options allow.
  const TemporaryFolder folder;
  write_text(folder / "scene.json",
             R"({"camera": {"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1]},
"film": {"width": 16384, "height": 16384, "spectral": {"bins": 1000}}, "materials": [], "shapes": []})");
  write_text(folder / "out.exr", "an old output");
  const auto expect_refused = [&](const std::vector<std::string>& arguments, const char* what) {
    const ProgramResult result = run_spectrace(arguments, folder.path());
    EXPECT_EQ(result.exit_code, 3) << result.output << result.errors;
    ASSERT_EQ(result.error_lines().size(), 1U) << result.errors;
    EXPECT_TRUE(result.complains(what)) << result.errors;
    EXPECT_TRUE(result.complains(" GB of memory, and ")) << result.errors;
  };
  expect_refused({"scene.json", "-o", "out.exr", "--spp", "1000000007"},
                 "scene.json:/film: 16384 x 16384 pixels with these AOVs and bins takes about ");
  EXPECT_EQ(read_text(folder / "out.exr"), "an old output");
}

}  // namespace
}  // namespace spectrace::test
