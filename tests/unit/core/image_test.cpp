// SPDX-License-Identifier: Apache-2.0
#include "core/image/image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace spectrace {
namespace {

using test::read_text;
using test::TemporaryFolder;
using test::write_text;

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Every value tells its place.
Image numbered(int width, int height, std::vector<std::string> channels) {
  Image image(width, height, std::move(channels));
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i) / 8;
  return image;
}

std::string problem_of(const std::filesystem::path& file) {
  try {
    static_cast<void>(read_image(file));
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics()[0].file, file.string());
    return error.diagnostics()[0].problem;
  }
  return "read";
}

TEST(Image, SelectsChannelsInTheAskedOrder) {
  const Image image = numbered(2, 1, {"R", "G", "B"});
  const std::vector<std::string> names = {"B", "R"};
  EXPECT_EQ(image.select(names, "f").data, (std::vector<float>{0.25f, 0, 0.625f, 0.375f}));
}

TEST(Image, NamesFileAndChannelThatIsMissing) {
  const std::vector<std::string> names = {"diffuse.R"};
  try {
    static_cast<void>(numbered(1, 1, {"R", "G"}).select(names, "x.exr"));
    FAIL() << "a missing channel was found";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "x.exr: has no channel \"diffuse.R\", only R, G");
  }
}

TEST(Image, ListsLayersThatHaveRedGreenAndBlue) {
  const Image image(1, 1,
                    {"R", "G", "B", "A", "diffuse.R", "diffuse.G", "diffuse.B", "normal.X", "half.R",
                     "half.G", "a.b.B", "a.b.G", "a.b.R"});
  EXPECT_EQ(image.rgb_layers(), (std::vector<std::string>{"", "diffuse", "a.b"}));
}

TEST(Exr, ReturnsEveryBitOfPixelsAndChannels) {
  const TemporaryFolder folder;
  Image image =
      numbered(5, 3, {"R", "G", "B", "A", "normal.X", "normal.Y", "normal.Z", "diagnostics.invalid"});
  image.at(0, 0, 0) = kNotANumber;
  image.at(1, 0, 1) = kInfinity;
  image.at(2, 0, 2) = -kInfinity;
  image.at(3, 0, 3) = -1e-40f;
  image.at(4, 2, 6) = 16777217.0f;
  write_exr(folder / "f.exr", image, {});
  const Image back = read_image(folder / "f.exr");
  EXPECT_EQ(back.width, 5);
  EXPECT_EQ(back.height, 3);
  EXPECT_EQ(back.channels, (std::vector<std::string>{"R", "G", "B", "A", "diagnostics.invalid", "normal.X",
                                                     "normal.Y", "normal.Z"}));
  const Image ordered = back.select(image.channels, "f.exr");
  EXPECT_EQ(std::memcmp(ordered.data.data(), image.data.data(), image.data.size() * sizeof(float)), 0);
}

TEST(Exr, KeepsMetadata) {
  const TemporaryFolder folder;
  const Metadata metadata = {{"spectrace:version", std::string("0.1.0")},
                             {"spectrace:aNameThatIsLongerThan31Characters", std::string("")},
                             {"spectrace:seconds", 0.1},
                             {"spectrace:spp", std::int64_t(-64)},
                             {"spectrace:seed", std::int64_t(1) << 40}};
  write_exr(folder / "f.exr", numbered(1, 1, {"R"}), metadata);
  Metadata expected = metadata;
  expected["spectrace:seed"] = std::string("1099511627776");  // EXR integers have 32 bits
  EXPECT_EQ(read_metadata(folder / "f.exr"), expected);
}

TEST(Exr, WritesTheSameBytesForTheSameImage) {
  const TemporaryFolder folder;
  for (const char* name : {"a.exr", "b.exr"})
    write_exr(folder / name, numbered(40, 30, {"R", "G", "B"}), {{"n", 1.0}});
  EXPECT_EQ(read_text(folder / "a.exr"), read_text(folder / "b.exr"));
  EXPECT_EQ(folder.entries(), 2u);
}

TEST(Exr, IsToldByContent) {
  const TemporaryFolder folder;
  write_exr(folder / "image.dat", numbered(2, 2, {"R", "G", "B"}), {});
  EXPECT_EQ(read_image(folder / "image.dat").channels.size(), 3u);
}

TEST(Exr, ChecksTheCaller) {
  const TemporaryFolder folder;
  Image short_data = numbered(2, 2, {"R"});
  short_data.data.pop_back();
  EXPECT_THROW(write_exr(folder / "f.exr", short_data, {}), InternalError);
  EXPECT_THROW(write_exr(folder / "f.exr", Image(), {}), InternalError);
}

TEST(Exr, TruncatedAnywhereIsBadInput) {
  const TemporaryFolder folder;
  write_exr(folder / "f.exr", numbered(30, 40, {"R", "G", "B"}), {{"text", std::string("value")}});
  const std::string whole = read_text(folder / "f.exr");
  for (std::size_t length = 4; length < whole.size(); length += 1 + length / 16) {
    write_text(folder / "cut.exr", whole.substr(0, length));
    EXPECT_THROW(read_image(folder / "cut.exr"), InputError) << length << " of " << whole.size() << " bytes";
  }
}

TEST(Exr, AnnouncingMorePixelsThanItsBytesHoldIsRefused) {
  const TemporaryFolder folder;
  write_exr(folder / "f.exr", numbered(3, 3, {"R", "G", "B"}), {});
  std::string bytes = read_text(folder / "f.exr");
  const std::size_t window = bytes.find(std::string("dataWindow\0box2i\0", 17)) + 17 + 4;
  for (const std::int32_t size : {1 << 13, 1 << 15, 1 << 30, std::numeric_limits<std::int32_t>::max()}) {
    const std::int32_t last = size - 1;
    std::memcpy(&bytes[window + 8], &last, sizeof last);
    std::memcpy(&bytes[window + 12], &last, sizeof last);
    write_text(folder / "huge.exr", bytes);
    EXPECT_NE(problem_of(folder / "huge.exr"), "read") << size;
  }
}

TEST(Exr, FlippedHeaderBytesNeverCrash) {
  const TemporaryFolder folder;
  write_exr(folder / "f.exr", numbered(8, 8, {"R", "G", "B"}), {{"text", std::string("value")}});
  const std::string whole = read_text(folder / "f.exr");
  std::mt19937 random(1);
  constexpr int kTrials = 300;
  for (int i = 0; i < kTrials; ++i) {
    std::string damaged = whole;
    damaged[4 + random() % (whole.size() - 4)] ^= static_cast<char>(1 << random() % 8);
    write_text(folder / "damaged.exr", damaged);
    try {
      const Image image = read_image(folder / "damaged.exr");
      EXPECT_EQ(image.data.size(), std::size_t(image.width) * image.height * image.channels.size());
    } catch (const InputError&) {  // a clear refusal is as good as harmless damage
    }
  }
}

TEST(ReadImage, RefusesMoreThanMaxPixels) {
  const TemporaryFolder folder;
  write_exr(folder / "f.exr", numbered(4, 4, {"R", "G", "B"}), {});
  write_png(folder / "f.png", numbered(4, 4, {"R", "G", "B"}));
  for (const char* name : {"f.exr", "f.png"}) {
    EXPECT_NO_THROW(static_cast<void>(read_image(folder / name, 16)));
    EXPECT_THROW(read_image(folder / name, 15), InputError);
  }
}

TEST(ReadImage, NamesWhatIsNoImage) {
  const TemporaryFolder folder;
  write_text(folder / "text.png", "this is no image");
  write_text(folder / "empty.hdr", "");
  EXPECT_NE(problem_of(folder / "text.png").find("cannot be read as an image"), std::string::npos);
  EXPECT_NE(problem_of(folder / "empty.hdr"), "read");
  EXPECT_NE(problem_of(folder / "absent.png"), "read");
}

TEST(ReadImage, TruncatedPngIsBadInput) {
#ifdef __SANITIZE_ADDRESS__
  // OpenImageIO 2.4 leaks its message here: libpng jumps out of PngReadCallback past the string's destructor.
  const __lsan::ScopedDisabler their_leak;
#endif
  const TemporaryFolder folder;
  write_png(folder / "f.png", numbered(64, 64, {"R", "G", "B"}), "", 1e-3);
  const std::string whole = read_text(folder / "f.png");
  for (const std::size_t length : {whole.size() / 2, std::size_t(40), std::size_t(9)}) {
    write_text(folder / "cut.png", whole.substr(0, length));
    EXPECT_NE(problem_of(folder / "cut.png"), "read") << length;
  }
}

TEST(WritePng, EncodesSrgbWithExposureAndClips) {
  const TemporaryFolder folder;
  Image image(4, 1, {"R", "G", "B", "x.R", "x.G", "x.B"});
  const float linear[4] = {0.0f, 0.25f, 2.0f, -1.0f};
  for (int x = 0; x < 4; ++x) {
    for (int c = 3; c < 6; ++c) image.at(x, 0, c) = linear[x];
  }
  write_png(folder / "f.png", image, "x", 0.5);
  const Image back = read_image(folder / "f.png");
  EXPECT_EQ(back.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_EQ(back.at(0, 0, 0), 0);
  // Linear 0.125 is encoded as 255 (1.055 · 0.125^(1/2.4) - 0.055) = 99.07 -> 99, decoded ((99/255 +
  // 0.055)/1.055)^2.4.
  EXPECT_NEAR(back.at(1, 0, 1), std::pow((99.0 / 255 + 0.055) / 1.055, 2.4), 1e-6);
  EXPECT_EQ(back.at(2, 0, 2), 1);
  EXPECT_EQ(back.at(3, 0, 0), 0);
}

TEST(WritePng, PaintsNonFinitePixelsMagenta) {
  const TemporaryFolder folder;
  Image image = numbered(3, 1, {"R", "G", "B"});
  image.at(0, 0, 1) = kNotANumber;
  image.at(1, 0, 2) = -kInfinity;
  write_png(folder / "f.png", image, "", 0.1);
  const Image back = read_image(folder / "f.png");
  for (int x = 0; x < 2; ++x) {
    EXPECT_EQ(back.at(x, 0, 0), 1);
    EXPECT_EQ(back.at(x, 0, 1), 0);
    EXPECT_EQ(back.at(x, 0, 2), 1);
  }
  EXPECT_NE(back.at(2, 0, 1), 0);
}

TEST(WritePng, NamesAMissingLayerAndLeavesTheOldFile) {
  const TemporaryFolder folder;
  write_text(folder / "f.png", "old");
  EXPECT_THROW(write_png(folder / "f.png", numbered(1, 1, {"R", "G", "B"}), "diffuse"), InputError);
  EXPECT_EQ(read_text(folder / "f.png"), "old");
}

TEST(ReadImage, ReadsRadianceEnvironments) {
  const std::filesystem::path file = test::data_folder() / "envmaps/brown_photostudio_02_1k.hdr";
  SPECTRACE_SKIP_WITHOUT(file);
  const Image image = read_image(file);
  EXPECT_EQ(image.width, 1024);
  EXPECT_EQ(image.height, 512);
  EXPECT_EQ(image.rgb_layers(), std::vector<std::string>{""});
  EXPECT_GT(*std::max_element(image.data.begin(), image.data.end()), 1.0f) << "not clipped";
}

}  // namespace
}  // namespace spectrace
