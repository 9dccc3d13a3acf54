// SPDX-License-Identifier: Apache-2.0
// Cryptomatte through the program: from the scene's names to the file's header, in parts and as a whole.
#include "renderer/matte.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdio>
#include <map>
#include <set>

#include "core/base/json.h"
#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

class Mattes : public Program {
 protected:
  Mattes() {
    write_text(folder_ / "scene.json", R"({
"camera": {"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1]},
"film": {"width": 40, "height": 24, "spectral": {"bins": 2}}, "sampler": {"spp": 24},
"materials": [{"name": "clay \"raw\"", "type": "lambert", "reflectance": 0.5},
              {"name": "glass", "type": "dielectric", "eta": 1.5}],
"shapes": [{"type": "sphere", "name": "ball", "material": "clay \"raw\""},
           {"type": "sphere", "material": "glass", "center": [1.5, 0, 0]}],
"lights": [{"type": "environment", "radiance": 1}]})");
  }
  Image render(const std::string& output, std::vector<std::string> options) const {
    options.insert(options.begin(), {"scene.json", "-o", output, "--aovs", "crypto_object,crypto_material"});
    const ProgramResult result = run(options);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    return read_image(folder_ / output);
  }
  std::string text(const std::string& file, const std::string& key) const {
    const Metadata metadata = read_metadata(folder_ / file);
    return metadata.contains(key) ? std::get<std::string>(metadata.at(key)) : "";
  }
  /// Names by id, as the header of `file` has them.
  std::map<std::string, std::string> manifest(const std::string& file, const std::string& key) const {
    JsonDocument document = JsonDocument::parse(text(file, key + "/manifest"), "manifest");
    std::map<std::string, std::string> names;
    for (const std::string& name : document.root().keys()) names[document.root().get(name).string()] = name;
    return names;
  }
};

TEST_F(Mattes, EveryIdOfTheImageIsInItsManifest) {
  const Image image = render("out.exr", {});
  const std::map<std::string, std::string> objects = manifest("out.exr", "cryptomatte/f834d0a");
  const std::map<std::string, std::string> materials = manifest("out.exr", "cryptomatte/bda530a");
  EXPECT_EQ(text("out.exr", "cryptomatte/f834d0a/name"), "crypto_object");
  EXPECT_EQ(text("out.exr", "cryptomatte/f834d0a/hash"), "MurmurHash3_32");
  EXPECT_EQ(text("out.exr", "cryptomatte/f834d0a/conversion"), "uint32_to_float32");
  EXPECT_EQ(text("out.exr", "cryptomatte/bda530a/name"), "crypto_material");
  std::map<std::string, std::set<std::string>> seen;
  for (const auto& [layer, names] :
       {std::pair("crypto_object", objects), std::pair("crypto_material", materials)}) {
    const std::size_t id = image.find_channel(std::string(layer) + "00.R").value();
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const float value = image.at(x, y, id);
        if (value == 0) continue;  // sky
        char digits[9];
        std::snprintf(digits, sizeof digits, "%08x", std::bit_cast<std::uint32_t>(value));
        ASSERT_TRUE(names.contains(digits)) << layer << ' ' << digits;
        seen[layer].insert(names.at(digits));
      }
    }
  }
  EXPECT_EQ(seen["crypto_object"], (std::set<std::string>{"ball", "shapes/1"}));
  EXPECT_EQ(seen["crypto_material"], (std::set<std::string>{"clay \"raw\"", "glass"}));
  EXPECT_EQ(text("out.spectral.exr", "cryptomatte/f834d0a/name"), "") << "that file has no such channels";
}

TEST_F(Mattes, PartsThreadsAndPausesChangeNoBit) {
  const Image whole = render("whole.exr", {"--threads", "1"});
  for (const char* threads : {"2", "7"}) {
    EXPECT_EQ(render("again.exr", {"--threads", threads}).data, whole.data) << threads;
  }
  (void)render("a.exr", {"--samples", "0:16", "--threads", "7"});
  (void)render("b.exr", {"--samples", "16:24", "--threads", "1"});
  ASSERT_EQ(run({"merge", "b.partial", "a.partial", "-o", "merged.exr"}).exit_code, 0);
  const Image merged = read_image(folder_ / "merged.exr");
  EXPECT_EQ(merged.channels, whole.channels);
  EXPECT_EQ(merged.data, whole.data);
  EXPECT_EQ(manifest("merged.exr", "cryptomatte/f834d0a"), manifest("whole.exr", "cryptomatte/f834d0a"));
  (void)render("paused.exr", {"--spp", "8", "--checkpoint", "1000"});
  EXPECT_EQ(render("paused.exr", {"--spp", "24", "--resume"}).data, whole.data);
}

TEST_F(Mattes, AreNoColoursToCompare) {
  (void)render("a.exr", {});
  (void)render("b.exr", {"--seed", "1"});
  const ProgramResult result = run({"compare", "a.exr", "b.exr"});
  EXPECT_FALSE(result.says("crypto")) << result.output;
}

}  // namespace
}  // namespace spectrace::test
