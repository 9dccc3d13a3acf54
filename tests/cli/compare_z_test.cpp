// SPDX-License-Identifier: Apache-2.0
// `spectrace compare --z-test`: against a reference that carries its variance.
#include <gtest/gtest.h>

#include <random>

#include "core/base/file.h"
#include "core/base/json.h"
#include "tests/cli/compare_images.h"

namespace spectrace::test {
namespace {

const std::vector<std::string> kColour{"R", "G", "B"};
const std::vector<std::string> kWithVariance{
    "R", "G", "B", "beauty_variance.R", "beauty_variance.G", "beauty_variance.B"};

/// 0.5 with Gaussian noise, and with more channels the noise's variance.
Image noisy(const std::vector<std::string>& channels, unsigned seed, double sigma, double bias = 0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> gauss(0.5 + bias, sigma);
  Image image(48, 48, channels);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<float>(i % channels.size() < 3 ? gauss(random) : sigma * sigma);
  }
  return image;
}

class CompareZ : public CompareProgram {};

TEST_F(CompareZ, PassesNoiseAndFailsABias) {
  const std::string r = file("r.exr", noisy(kWithVariance, 1, 0.01));
  const std::string t = file("t.exr", noisy(kWithVariance, 2, 0.03));
  const ProgramResult passes = run({"compare", r, t, "--z-test"});
  EXPECT_EQ(passes.exit_code, 0) << passes.output;
  EXPECT_TRUE(passes.says("pass: beauty z-test: 100 % of pixels accept (|z| <= 4.817)")) << passes.output;
  EXPECT_TRUE(passes.says("noise of the test image: its own variance")) << passes.output;
  // Two standard deviations of the difference, 0.01 and 0.03 together.
  const std::string biased = file("b.exr", noisy(kWithVariance, 2, 0.03, 2 * 0.0316));
  EXPECT_EQ(run({"compare", r, biased, "--z-test"}).exit_code, 1);
  EXPECT_EQ(run({"compare", r, biased}).exit_code, 0) << "only where it is asked for";
  const std::string little = file("l.exr", noisy(kWithVariance, 2, 0.03, 0.15 * 0.0316));
  EXPECT_EQ(run({"compare", r, little, "--z-test"}).exit_code, 0);
  EXPECT_EQ(run({"compare", r, little, "--z-test", "--z-mean", "4"}).exit_code, 1);
  EXPECT_EQ(run({"compare", r, t, "--z-test", "--z-mean", "4"}).exit_code, 0);
}

TEST_F(CompareZ, TakesTheNoiseOfTheTestImageIntoAccount) {
  const Metadata many{{"spectrace:spp", std::int64_t(900)}}, few{{"spectrace:spp", std::int64_t(100)}};
  const std::string r = file("r.exr", noisy(kWithVariance, 1, 0.01), many);
  const std::string own = file("own.exr", noisy(kWithVariance, 2, 0.03), few);
  const std::string scaled = file("scaled.exr", noisy(kColour, 2, 0.03), few);
  const std::string unknown = file("unknown.exr", noisy(kColour, 2, 0.03));
  EXPECT_EQ(run({"compare", r, own, "--z-test"}).exit_code, 0);
  const ProgramResult by_samples = run({"compare", r, scaled, "--z-test"});
  EXPECT_EQ(by_samples.exit_code, 0) << by_samples.output;
  EXPECT_TRUE(by_samples.says("the reference's variance times 900 / 100 samples")) << by_samples.output;
  const ProgramResult without = run({"compare", r, unknown, "--z-test"});
  EXPECT_EQ(without.exit_code, 1) << "three times the reference's noise, taken for a difference";
  EXPECT_TRUE(without.says("taken as without noise")) << without.output;
  // The variance of the test is used, not only noticed: a hundredth of it is not enough.
  Image understated = noisy(kWithVariance, 2, 0.03);
  for (std::size_t i = 0; i < understated.data.size(); ++i) {
    if (i % 6 >= 3) understated.data[i] *= 0.01f;
  }
  EXPECT_EQ(run({"compare", r, file("u.exr", understated), "--z-test"}).exit_code, 1);
}

TEST_F(CompareZ, NeedsTheReferencesVariance) {
  const std::string plain = file("plain.exr", noisy(kColour, 1, 0.01)),
                    r = file("r.exr", noisy(kWithVariance, 1, 0.01));
  expect_bad_input({"compare", plain, r, "--z-test"},
                   plain + ": has no layer \"beauty_variance\", only beauty");
  Image negative = noisy(kWithVariance, 1, 0.01);
  negative.at(3, 3, 4) = -1e-6f;
  expect_bad_input({"compare", file("n.exr", negative), r, "--z-test"},
                   (folder_ / "n.exr").string() + ": layer \"beauty_variance\": -1e-06 is no variance");
  for (const char* alpha : {"0", "1", "nan", "-1"}) {
    expect_usage_error({"compare", r, r, "--z-test", "--z-alpha", alpha});
  }
}

TEST_F(CompareZ, TestsEveryLayerThatHasAVariance) {
  const std::vector<std::string> channels{"R",
                                          "G",
                                          "B",
                                          "diffuse.R",
                                          "diffuse.G",
                                          "diffuse.B",
                                          "diffuse_variance.R",
                                          "diffuse_variance.G",
                                          "diffuse_variance.B"};
  Image reference = constant(0.5f, channels);
  Image test = reference;
  for (std::size_t i = 0; i < test.data.size(); i += 9) test.data[i] = 0.9f;  // the beauty, which has none
  for (Image* image : {&reference, &test}) {
    for (std::size_t i = 6; i < image->data.size(); i += 9) image->data[i] = 0.01f;
  }
  const std::string r = file("r.exr", reference), t = file("t.exr", test);
  const ProgramResult result = run({"compare", r, t, "--z-test"});
  EXPECT_EQ(result.exit_code, 0) << result.output;
  EXPECT_TRUE(result.says("pass: diffuse z-test") && !result.says("beauty z-test")) << result.output;
  expect_bad_input({"compare", r, t, "--z-test", "--layer", "beauty"},
                   r + ": has no layer \"beauty_variance\"");
}

TEST_F(CompareZ, SaysItsFindingsAsJsonMapAndPage) {
  Image test = noisy(kWithVariance, 2, 0.01);
  test.at(7, 5, 2) += 1;
  const std::string r = file("r.exr", noisy(kWithVariance, 1, 0.01)), t = file("t.exr", test);
  write_text(folder_ / "limits.json", R"({"z_test": {"accepted": 1}})");
  const ProgramResult result = run(
      {"compare", r, t, "--limits", "limits.json", "--json", "f.json", "--maps", "m", "--html", "p.html"});
  EXPECT_EQ(result.exit_code, 1) << "all pixels must accept";
  JsonDocument document = JsonDocument::load(folder_ / "f.json");
  EXPECT_EQ(document.root().require("z_test").require("accepted").number(0), 1);
  const JsonValue z = document.root().require("layers").elements().at(0).require("z_test");
  EXPECT_FALSE(z.require("holds").boolean(true));
  EXPECT_EQ(z.require("accepted").number(0), 2303.0 / 2304);
  EXPECT_EQ(z.require("x").number(0), 7);
  EXPECT_EQ(z.require("y").number(0), 5);
  EXPECT_EQ(z.require("mean_z").elements().size(), 3U);
  document.throw_if_wrong();
  const Image map = read_image(folder_ / "m" / "beauty-z.png");
  EXPECT_EQ(map.at(7, 5, 2), 1);
  EXPECT_NE(read_text(folder_ / "p.html").find("beauty z-test"), std::string::npos);
}

TEST_F(CompareZ, UpdateKeepsReferencesTestable) {
  const std::string r = file("r.exr", noisy(kWithVariance, 1, 0.01)),
                    plain = file("plain.exr", noisy(kColour, 1, 0.01));
  const auto before = read_file(r);
  const ProgramResult refused = run({"compare", r, plain, "--z-test", "--update"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_TRUE(refused.complains("a reference without it allows no z-test")) << refused.errors;
  EXPECT_EQ(read_file(r), before);
}

}  // namespace
}  // namespace spectrace::test
