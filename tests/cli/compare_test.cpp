// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/json.h"
#include "core/image/image.h"
#include "tests/cli/compare_images.h"

namespace spectrace {
namespace {

using test::constant;
using test::ProgramResult;
using test::run_spectrace;

class Compare : public test::CompareProgram {};

TEST_F(Compare, PrintsFiguresWithTheirConstants) {
  const std::string r = file("r.exr", constant(0.5f)), t = file("t.exr", constant(0.25f));
  const ProgramResult result = run_spectrace({"compare", r, t, "--data-range", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_TRUE(result.says("12.041")) << "PSNR of a difference of 1/4: 20 log10(4) dB\n" << result.output;
  for (const char* text :
       {"beauty", "data range: 1", "11 x 11", "sigma 1.5", "r^2 + 0.01", "no tone mapping"}) {
    EXPECT_TRUE(result.says(text)) << text << "\n" << result.output;
  }
}

TEST_F(Compare, ExitsOneBeyondALimit) {
  const std::string r = file("r.exr", constant(0.5f)), t = file("t.exr", constant(0.25f));
  // mse is 0.0625 exactly.
  EXPECT_EQ(run_spectrace({"compare", r, t, "--max", "mse=0.0625"}).exit_code, 0);
  EXPECT_EQ(run_spectrace({"compare", r, t, "--max", "mse=0.0624"}).exit_code, 1);
  EXPECT_EQ(run_spectrace({"compare", r, t, "--min", "mse=0.0625"}).exit_code, 0);
  EXPECT_EQ(run_spectrace({"compare", r, t, "--min", "mse=0.0626"}).exit_code, 1);
  const ProgramResult both =
      run_spectrace({"compare", r, t, "--max", "mse=1", "--max", "mae=0.1", "--min", "ssim=0"});
  EXPECT_EQ(both.exit_code, 1) << "one of several limits";
  EXPECT_TRUE(both.says("FAIL: beauty mae <= 0.1: found 0.25")) << both.output;
  EXPECT_TRUE(both.says("pass: beauty mse <= 1")) << both.output;
}

TEST_F(Compare, ExitsZeroForEqualImages) {
  const std::string r = file("r.exr", constant(0.5f));
  EXPECT_EQ(
      run_spectrace({"compare", r, r, "--min", "psnr=200", "--min", "ssim=0.999999", "--max", "maxabs=0"})
          .exit_code,
      0);
}

TEST_F(Compare, AlwaysFailsOnANonFiniteValue) {
  const Image image = constant(0.5f, {"R", "G", "B", "specular.R", "specular.G", "specular.B", "depth.Z"});
  const std::string clean = file("clean.exr", image);
  const auto with = [&](float bad, std::size_t channel) {
    Image broken = image;
    broken.at(3, 5, channel) = bad;
    return file("bad.exr", broken);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  for (const std::size_t channel : {0, 5, 6}) {  // beauty, another layer, no layer at all
    const ProgramResult result = run_spectrace({"compare", clean, with(kNan, channel)});
    EXPECT_EQ(result.exit_code, 1);
    const std::string line =
        ": channel " + image.channels[channel] + ": 1 NaN or infinite values, the first at x = 3, y = 5";
    EXPECT_TRUE(result.says(line)) << result.output;
  }
  EXPECT_EQ(run_spectrace({"compare", clean, with(-kInf, 2)}).exit_code, 1);
  const std::string bad = with(kNan, 4);
  EXPECT_EQ(run_spectrace({"compare", bad, clean}).exit_code, 1) << "in the reference";
  EXPECT_EQ(run_spectrace({"compare", bad, bad, "--max", "mse=1e9"}).exit_code, 1) << "in both";
  EXPECT_EQ(run_spectrace({"compare", clean, bad, "--layer", "beauty"}).exit_code, 1) << "in any layer";
}

TEST_F(Compare, FailsALimitOnAFigureThatDoesNotExist) {
  const std::string small = file("small.exr", constant(0.5f, {"R", "G", "B"}, 8, 8));
  EXPECT_EQ(run_spectrace({"compare", small, small}).exit_code, 0);
  EXPECT_EQ(run_spectrace({"compare", small, small, "--min", "ssim=0"}).exit_code, 1)
      << "8 x 8 pixels have no SSIM";
  EXPECT_EQ(run_spectrace({"compare", small, small, "--max", "ssim=9"}).exit_code, 1);
}

TEST_F(Compare, AppliesLimitsToTheNamedLayers) {
  Image reference = constant(0.5f, {"R", "G", "B", "specular.R", "specular.G", "specular.B"});
  Image other = reference;
  for (int x = 0; x < other.width; ++x) other.at(x, 0, 4) = 0;
  const std::string r = file("r.exr", reference), t = file("t.exr", other);
  const ProgramResult all = run_spectrace({"compare", r, t, "--max", "mse=0"});
  EXPECT_EQ(all.exit_code, 0) << "the beauty is equal";
  EXPECT_TRUE(all.says("specular")) << all.output;
  EXPECT_EQ(run_spectrace({"compare", r, t, "--max", "mse=0", "--layer", "beauty"}).exit_code, 0);
  EXPECT_EQ(run_spectrace({"compare", r, t, "--max", "mse=0", "--layer", "specular"}).exit_code, 1);
  EXPECT_EQ(run_spectrace({"compare", r, t, "--max", "mse=0", "--layer", "beauty", "--layer", "specular"})
                .exit_code,
            1);
}

TEST_F(Compare, NamesLayersThatOnlyOneImageHas) {
  const std::string r = file("r.exr", constant(0.5f, {"R", "G", "B", "diffuse.R", "diffuse.G", "diffuse.B"}));
  const std::string t = file("t.exr", constant(0.5f));
  EXPECT_TRUE(run_spectrace({"compare", r, t}).says("not compared: diffuse (only in " + r + ")"));
  const ProgramResult missing = run_spectrace({"compare", r, t, "--layer", "diffuse"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_TRUE(missing.complains(t + ": has no layer \"diffuse\", only beauty")) << missing.errors;
}

TEST_F(Compare, RefusesImagesOfDifferentSizesAndFilesThatAreNone) {
  const std::string r = file("r.exr", constant(0.5f)),
                    t = file("t.exr", constant(0.5f, {"R", "G", "B"}, 17, 16));
  const ProgramResult sizes = run_spectrace({"compare", r, t});
  EXPECT_EQ(sizes.exit_code, 3);
  EXPECT_EQ(sizes.errors, t + ": 17 x 16 pixels, but " + r + " has 16 x 16\n");
  const ProgramResult absent = run_spectrace({"compare", r, (folder_ / "absent.exr").string()});
  EXPECT_EQ(absent.exit_code, 3);
  EXPECT_TRUE(absent.complains("absent.exr: cannot open")) << absent.errors;
  const std::string grey = file("grey.exr", constant(0.5f, {"Z"}));
  EXPECT_EQ(run_spectrace({"compare", grey, grey}).exit_code, 3) << "nothing to compare is no success";
}

TEST_F(Compare, RefusesWrongUse) {
  const std::string r = file("r.exr", constant(0.5f));
  for (const char* limit : {"foo=1", "mse", "mse=nan", "mse=1x"}) {
    EXPECT_EQ(run_spectrace({"compare", r, r, "--max", limit}).exit_code, 2) << limit;
  }
  EXPECT_TRUE(run_spectrace({"compare", r, r, "--min", "ssm=1"}).complains("did you mean \"ssim\"?"));
  EXPECT_EQ(run_spectrace({"compare", r}).exit_code, 2);
  EXPECT_EQ(run_spectrace({"compare", r, r, "--epsilon", "nan"}).exit_code, 2);
}

TEST_F(Compare, SaysWhereFiguresHoldNoise) {
  const auto rendered = [&](const std::string& name, const std::string& seed, std::int64_t paired,
                            const std::string& model) {
    Metadata metadata{
        {"spectrace:seed", seed}, {"spectrace:spp", std::int64_t(4)}, {"spectrace:paired", paired}};
    if (!model.empty()) metadata["spectrace:separation"] = model;
    write_exr(folder_ / name, constant(0.5f), metadata);
    return (folder_ / name).string();
  };
  const std::string raw = rendered("raw.exr", "0", 0, ""), raw_paired = rendered("rawp.exr", "0", 1, "");
  const std::string sun = rendered("sun.exr", "0", 0, "sun"),
                    sun_paired = rendered("sunp.exr", "0", 1, "sun");
  const std::string other = rendered("other.exr", "1", 0, "");
  const auto note = [](const std::string& a, const std::string& b) {
    return run_spectrace({"compare", a, b}).says("noise is part of these figures");
  };
  EXPECT_TRUE(note(raw, sun));
  EXPECT_TRUE(note(raw, sun_paired)) << "half paired is not paired";
  EXPECT_TRUE(note(raw, other)) << "seeds differ";
  EXPECT_FALSE(note(raw_paired, sun_paired));
  EXPECT_FALSE(note(raw, rendered("again.exr", "0", 0, ""))) << "the same model twice";
  EXPECT_FALSE(note(raw, file("foreign.exr", constant(0.5f)))) << "nothing is known of other programs' noise";
}

TEST_F(Compare, WritesItsFiguresAsJson) {
  const std::string r = file("r.exr", constant(0.5f)), t = file("t.exr", constant(0.25f));
  const std::string json = (folder_ / "figures.json").string();
  EXPECT_EQ(run_spectrace({"compare", r, t, "--max", "mse=0.01", "--json", json}).exit_code, 1);
  JsonDocument document = JsonDocument::load(json);
  const JsonValue root = document.root();
  EXPECT_FALSE(root.require("passes").boolean(true));
  const JsonValue layer = root.require("layers").elements().at(0);
  EXPECT_EQ(layer.require("layer").string(), "beauty");
  EXPECT_EQ(layer.require("mse").number(0), 0.0625);
  EXPECT_EQ(layer.require("data_range").number(0), 0.5);
  EXPECT_FALSE(root.require("limits").elements().at(0).require("holds").boolean(true));
  document.throw_if_wrong();
}

TEST_F(Compare, HelpShowsExamples) {
  const ProgramResult help = run_spectrace({"compare", "--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_TRUE(help.says("Examples:") && help.says("Exit codes:")) << help.output;
}

}  // namespace
}  // namespace spectrace
