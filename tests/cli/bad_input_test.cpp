// SPDX-License-Identifier: Apache-2.0
// Input that is wrong or damaged: exit code 3, one line a mistake, no output, an old output untouched.
#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <span>

#include "core/base/error.h"
#include "materials/measured_tables.h"
#include "materials/tensor_file.h"
#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

using BadInput = Program;

constexpr const char* kOld = "an old output";

TEST_F(BadInput, MisspeltKeysAreNamedWithTheirPlaceAndTheNearestKey) {
  write_text(folder_ / "scene.json", R"({
  "camera": {"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1], "fov": 40},
  "materials": [{"name": "m", "type": "lambert", "relfectance": 0.5}],
  "shapes": [{"type": "sphere", "material": "n"}]
})");
  const ProgramResult result = run({"scene.json", "-o", "out.exr"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.output, "");
  const std::vector<std::string> lines = result.error_lines();
  ASSERT_EQ(lines.size(), 4U) << result.errors;
  EXPECT_EQ(lines[0], "scene.json:2:74: /camera/fov: unknown key \"fov\"; did you mean \"fov_deg\"?");
  EXPECT_EQ(lines[1], "scene.json:3:17: /materials/0: missing required key \"reflectance\"");
  EXPECT_EQ(lines[2],
            "scene.json:3:50: /materials/0/relfectance: unknown key \"relfectance\"; did you mean "
            "\"reflectance\"?");
  EXPECT_EQ(lines[3], "scene.json:4:45: /shapes/0/material: there is no material \"n\"");
  EXPECT_EQ(names(), std::vector<std::string>{"scene.json"});
}

TEST_F(BadInput, FilesThatAreNotThere) {
  expect_bad_input({"none.json"}, "none.json:");
  expect_bad_input({"inspect", "none.bsdf"}, "none.bsdf:");
  expect_bad_input({"separate", "none.bsdf", "-o", "out.sep"}, "none.bsdf:");
  expect_bad_input({"acquire", "none.json", "-o", "out.bsdf"}, "none.json:");
  expect_bad_input({"compare", "none.exr", "none.exr"}, "none.exr:");
  expect_bad_input({"sheet", "out.png", "none.exr"}, "none.exr:");
  EXPECT_TRUE(names().empty());
}

TEST_F(BadInput, FoldersAndForeignFilesInPlaceOfInput) {
  std::filesystem::create_directory(folder_ / "folder");
  write_text(folder_ / "empty", "");
  write_text(folder_ / "noise.json", std::string("\x93\x01{{\0;\xff", 7));
  write_text(folder_ / "noise.bsdf", "TREE 4 0.1 0.2");
  write_text(folder_ / "noise.exr", "\x76\x2f\x31\x01 and nothing behind the magic");
  for (const std::string name : {"folder", "empty", "noise.json", "noise.bsdf", "noise.exr"}) {
    expect_bad_input({name}, name + ":");
    expect_bad_input({"inspect", name}, name + ":");
    expect_bad_input({"separate", name, "-o", "out.sep"}, name + ":");
    expect_bad_input({"acquire", name, "-o", "out.bsdf"}, name + ":");
    expect_bad_input({"compare", name, name}, name + ":");
  }
  EXPECT_EQ(names().size(), 5U);
}

TEST_F(BadInput, OneKindOfOursInPlaceOfAnother) {
  write_measured("m.bsdf");
  ASSERT_EQ(separate("m.bsdf", "m.sep").exit_code, 0);
  expect_bad_input({"separate", "m.sep", "-o", "out.sep"},
                   "m.sep: a separated material (.sep), not a measurement");
  expect_bad_input({"m.bsdf"}, "m.bsdf: a measurement or separated material, not a scene");
  expect_bad_input({"m.sep"}, "m.sep: a measurement or separated material, not a scene");
}

TEST_F(BadInput, ADamagedNameIsNotQuotedWhole) {
  const std::string name(30'000, '\x01');
  std::string bytes("tensor_file\0\x01\0\x01\0\0\0", 18);
  bytes += std::string("\x30\x75", 2) + name + std::string(64, '\0');
  write_text(folder_ / "long.bsdf", bytes);
  const ProgramResult result = run({"inspect", "long.bsdf"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_NE(result.errors.find("... of 30000 bytes"), std::string::npos) << result.errors.substr(0, 300);
  EXPECT_LT(result.errors.size(), 400U);
}

TEST_F(BadInput, ALongKeyIsNotQuotedWhole) {
  write_text(folder_ / "scene.json", "{\"camera\": {\"" + std::string(200'000, '(') + "\": 1}}");
  const ProgramResult result = run({"scene.json"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(result.complains("scene.json:1:13: /camera/((("));
  EXPECT_TRUE(result.complains("bytes) ..."));
  EXPECT_LT(result.errors.size(), 10'000U);
}

TEST_F(BadInput, HostileJson) {
  for (const std::string& text :
       {std::string(100000, '['), std::string(R"({"camera": 1e400})"),
        std::string("{\"camera\": \"\xc3\x28\"}"), std::string(R"({"a": 1, "a": 2})"),
        std::string("{\"camera\": {}"), std::string("\xef\xbb\xbf[]"), std::string("null")}) {
    write_text(folder_ / "scene.json", text);
    expect_bad_input({"scene.json"}, "scene.json:1:");
  }
}

TEST_F(BadInput, OutputsThatCannotBeWritten) {
  write_lambert_scene("scene.json");
  write_measured("m.bsdf");
  std::filesystem::create_directory(folder_ / "folder.exr");
  expect_bad_input({"scene.json", "-o", "no/such/out.exr"}, "no/such");
  expect_bad_input({"scene.json", "-o", "folder.exr"}, "folder.exr:");
  expect_bad_input({"separate", "m.bsdf", "-o", "no/such/out.sep"}, "no/such");
  expect_bad_input({"acquire", (kScenes / "materials/matte.json").string(), "-o", "no/such/out.bsdf"},
                   "no/such");
}

/// Damaged copies of one measured file, and what the program makes of them.
class Damaged : public Program {
 protected:
  void SetUp() override {
    write_measured("whole.bsdf");
    whole_ = read_text(folder_ / "whole.bsdf");
    write_scene("scene.json", R"({"name": "m", "type": "measured", "file": "damaged.bsdf"})");
    write_text(folder_ / "out.sep", kOld);
    write_text(folder_ / "out.exr", kOld);
    names_ = names();
    names_.insert(std::lower_bound(names_.begin(), names_.end(), "damaged.bsdf"), "damaged.bsdf");
  }

  /// A command that reads such a file refuses it in one line that names it, and leaves nothing behind.
  void expect_refused(std::size_t command) const {
    static const std::array<std::vector<std::string>, 3> kCommands{
        {{"inspect", "damaged.bsdf"},
         {"separate", "damaged.bsdf", "-o", "out.sep"},
         {"scene.json", "-o", "out.exr"}}};
    expect_bad_input(kCommands.at(command), "damaged.bsdf:");
    expect_untouched();
  }
  void expect_refused_everywhere() const {
    for (const std::size_t command : {0, 1, 2}) expect_refused(command);
  }
  void expect_untouched() const {
    EXPECT_EQ(read_text(folder_ / "out.sep"), kOld);
    EXPECT_EQ(read_text(folder_ / "out.exr"), kOld);
    EXPECT_EQ(names(), names_);
  }

  std::string whole_;
  std::vector<std::string> names_;
};

TEST_F(Damaged, TruncatedAtTwentyPlaces) {
  std::mt19937 random(1);  // NOLINT(cert-msc51-cpp): the same places on every run
  std::set<std::size_t> lengths{0, 1, 11, whole_.size() - 1};
  while (lengths.size() < 20) lengths.insert(random() % whole_.size());
  std::size_t i = 0;
  for (const std::size_t length : lengths) {
    SCOPED_TRACE(length);
    write_text(folder_ / "damaged.bsdf", whole_.substr(0, length));
    expect_refused(i++ % 3);  // in turn, for time: starting the program costs 0.2 s, the reader is one
  }
  expect_refused_everywhere();
}

// The reader alone takes each of them, and NoFlippedByteOfTheHeaderGoesUnnoticed all there are; the program,
// as starting it costs 0.2 s, one in ten.
TEST_F(Damaged, TwoHundredFlippedBytesOfTheHeader) {
  std::uint64_t header = whole_.size();  // ends where the first field's values begin
  const TensorFile tensors = TensorFile::read(folder_ / "whole.bsdf");
  for (const Tensor& tensor : tensors.tensors()) header = std::min(header, tensor.offset);
  std::mt19937 random(2);  // NOLINT(cert-msc51-cpp): the same bytes on every run
  std::size_t refused = 0;
  for (std::size_t i = 0; i < 200; ++i) {
    std::string damaged = whole_;
    const std::size_t at = random() % header;
    damaged[at] = static_cast<char>(static_cast<unsigned char>(damaged[at]) ^ (1 + random() % 255));
    SCOPED_TRACE(testing::Message() << "byte " << at);
    try {
      (void)measured_from_bytes(std::as_bytes(std::span(damaged)), "damaged.bsdf");
    } catch (const InputError& e) {
      EXPECT_EQ(e.diagnostics().size(), 1U);
      write_text(folder_ / "damaged.bsdf", damaged);
      if (refused++ % 10 == 0) expect_refused(i % 3);
    }
  }
  EXPECT_GE(refused,
            195U);  // padding, and what is the same if read: see NoFlippedByteOfTheHeaderGoesUnnoticed
}

}  // namespace
}  // namespace spectrace::test
