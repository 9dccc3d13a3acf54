// SPDX-License-Identifier: Apache-2.0
// `spectrace compare`: layers, spectra, limits by layer and from files, pages and maps, --update.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/file.h"
#include "core/base/json.h"
#include "tests/cli/compare_images.h"
#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

class CompareLayers : public CompareProgram {};

const std::vector<std::string> kTwoLayers{"R", "G", "B", "specular.R", "specular.G", "specular.B"};

TEST_F(CompareLayers, RefusesImagesOfSeveralParts) {
  const std::string one = file("one.exr", constant(0.5f, kTwoLayers));
  const std::string bad = file("bad.exr", constant(std::numeric_limits<float>::quiet_NaN(), kTwoLayers));
  const ProgramResult joined =
      run_program("/usr/bin/env", {"oiiotool", one, bad, "--siappend", "-o", "parts.exr"}, folder_.path());
  ASSERT_EQ(joined.exit_code, 0) << joined.errors;  // OpenImageIO's own program
  expect_bad_input({"compare", one, "parts.exr"}, "parts.exr: has several parts");
}

TEST_F(CompareLayers, LimitsMayDifferByLayer) {
  Image other = constant(0.5f, kTwoLayers);
  for (int x = 0; x < other.width; ++x) other.at(x, 0, 4) = 0;  // mae: 0.5 / 16 / 3 of the specular layer
  const std::string r = file("r.exr", constant(0.5f, kTwoLayers)), t = file("t.exr", other);
  EXPECT_EQ(run({"compare", r, t, "--max", "specular.mae=0.0105", "--max", "mae=0"}).exit_code, 0);
  const ProgramResult result =
      run({"compare", r, t, "--max", "specular.mae=0.0104", "--max", "beauty.mae=0"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(result.says("FAIL: specular mae <= 0.0104: found 0.0104167")) << result.output;
  EXPECT_TRUE(result.says("pass: beauty mae <= 0: found 0")) << result.output;
  EXPECT_EQ(run({"compare", r, t, "--max", "*.mae=0.0105"}).exit_code, 0);
  EXPECT_EQ(run({"compare", r, t, "--max", "*.mae=0.0104"}).exit_code, 1);
  EXPECT_EQ(run({"compare", r, t, "--layer", "beauty", "--max", "*.mae=0"}).exit_code, 0)
      << "of those compared";
  EXPECT_EQ(run({"compare", r, t, "--layer", "beauty", "--max", "specular.mae=0"}).exit_code, 1)
      << "a limit's layer is compared, whatever --layer says";
  expect_bad_input({"compare", r, t, "--max", "diffuse.mae=0"},
                   r + ": has no layer \"diffuse\", only beauty, specular");
  expect_usage_error({"compare", r, t, "--max", ".mae=0"});
  expect_usage_error({"compare", r, t, "--max", "specular.maee=0"});
}

TEST_F(CompareLayers, OtherThanColoursWhereNamed) {
  const std::vector<std::string> channels{"R", "G", "B", "depth.Z", "normal.X", "normal.Y", "normal.Z"};
  const Image reference = constant(0.25f, channels);
  Image test = reference;
  test.at(0, 0, 3) = 4.25f;
  test.at(0, 0, 5) = -0.75f;
  const std::string r = file("r.exr", reference), t = file("t.exr", test);
  const ProgramResult silent = run({"compare", r, t, "--max", "*.maxabs=0"});
  EXPECT_EQ(silent.exit_code, 0);
  EXPECT_FALSE(silent.says("depth") || silent.says("normal")) << silent.output;
  EXPECT_EQ(run({"compare", r, t, "--max", "depth.maxabs=4"}).exit_code, 0);
  EXPECT_EQ(run({"compare", r, t, "--max", "depth.maxabs=3.99"}).exit_code, 1);
  EXPECT_EQ(run({"compare", r, t, "--layer", "normal", "--max", "maxabs=1"}).exit_code, 0);
  EXPECT_EQ(run({"compare", r, t, "--layer", "normal", "--max", "maxabs=0.99"}).exit_code, 1);
  Image flat = constant(0.25f, {"R", "G", "B", "normal.X", "normal.Y"});
  expect_bad_input(
      {"compare", r, file("flat.exr", flat), "--layer", "normal"},
      (folder_ / "flat.exr").string() + ": layer \"normal\" has the channels normal.X, normal.Y, but in");
}

TEST_F(CompareLayers, LeaveStatisticsOutUnlessNamed) {
  const std::vector<std::string> channels{
      "R",          "G",          "B",         "beauty_variance.R", "beauty_variance.G", "beauty_variance.B",
      "beauty_a.R", "beauty_a.G", "beauty_a.B"};
  const std::string r = file("r.exr", constant(0.25f, channels));
  const ProgramResult plain = run({"compare", r, r});
  EXPECT_FALSE(plain.says("variance") || plain.says("beauty_a")) << plain.output;
  EXPECT_TRUE(run({"compare", r, r, "--layer", "beauty_variance"}).says("\nbeauty_variance "));
}

TEST_F(CompareLayers, SpectraByBand) {
  const Image reference =
      constant(0.5f, {"R", "G", "B", "S0.1000,000000nm", "S0.400,000000nm", "S0.700,000000nm"});
  Image test = reference;
  for (std::size_t i = 5; i < test.data.size(); i += 6) test.data[i] = 0.25f;  // the band at 700 nm
  const std::string r = file("r.exr", reference), t = file("t.exr", test);
  const std::string json = (folder_ / "figures.json").string();
  const ProgramResult result =
      run({"compare", r, t, "--max", "S0.mse=0.0209", "--max", "beauty.mse=0", "--json", json});
  EXPECT_EQ(result.exit_code, 0) << result.output;  // 0.0625 / 3
  EXPECT_EQ(run({"compare", r, t, "--max", "S0.mse=0.0208"}).exit_code, 1);
  JsonDocument document = JsonDocument::load(json);
  const JsonValue spectrum = document.root().require("layers").elements().at(1);
  EXPECT_EQ(spectrum.require("layer").string(), "S0");
  const auto bands = spectrum.require("bands").elements();
  ASSERT_EQ(bands.size(), 3U);
  const std::vector<double> lambda_nm{400, 700, 1000}, mse{0, 0.0625, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(bands[i].require("lambda_nm").number(0), lambda_nm[i]);
    EXPECT_EQ(bands[i].require("mse").number(-1), mse[i]);
    EXPECT_EQ(bands[i].require("data_range").number(-1), 0.5);
  }
  document.throw_if_wrong();
  Image other = constant(0.5f, {"R", "G", "B", "S0.400nm", "S0.600nm"});
  EXPECT_TRUE(run({"compare", r, file("o.exr", other)}).says("not compared: S0 (of different channels)"));
}

TEST_F(CompareLayers, LimitsComeFromAFile) {
  Image other = constant(0.5f, kTwoLayers);
  for (int x = 0; x < other.width; ++x) other.at(x, 0, 4) = 0;
  const std::string r = file("r.exr", constant(0.5f, kTwoLayers)), t = file("t.exr", other);
  const auto with = [&](const std::string& text, const std::vector<std::string>& more = {}) {
    write_text(folder_ / "limits.json", text);
    std::vector<std::string> arguments{"compare", r, t, "--limits", "limits.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  EXPECT_EQ(
      with(
          R"({"layers": {"specular": {"max": {"mae": 0.0105}, "min": {"psnr": 10}}, "*": {"max": {"mse": 1}}}})")
          .exit_code,
      0);
  EXPECT_EQ(with(R"({"layers": {"specular": {"max": {"mae": 0.0104}}}})").exit_code, 1);
  EXPECT_EQ(with(R"({"layers": {"specular": {"min": {"psnr": 99}}}})").exit_code, 1);
  EXPECT_EQ(with(R"({"layers": {"specular": {"max": {"mae": 1}}}})", {"--max", "specular.mae=0"}).exit_code,
            1)
      << "limits of the command line hold as well";
  const ProgramResult constants =
      with(R"({"data_range": 2, "epsilon": 0.5, "layers": {"beauty": {"max": {"mse": 1}}}})",
           {"--epsilon", "0.25"});
  EXPECT_TRUE(constants.says("data range: 2;") && constants.says("r^2 + 0.25")) << constants.output;
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {R"({"layers": {"beauty": {"max": {"relmsee": 1}}}})",
       "limits.json:1:32: /layers/beauty/max/relmsee: unknown key \"relmsee\"; did you mean \"relmse\"?"},
      {R"({"layers": {"beauty": {}}})", "limits.json:1:23: /layers/beauty: limits nothing"},
      {R"({"layers": {"beauty": {"max": {"mse": "1"}}}})",
       "limits.json:1:39: /layers/beauty/max/mse: expected"},
      {R"({"epsilon": 0, "layers": {"beauty": {"max": {"mse": 1}}}})",
       "limits.json:1:13: /epsilon: expected"},
      {R"({"z_test": {"alpha": 1}})", "limits.json:1:22: /z_test/alpha: expected"},
      {R"({})", "limits.json:1:1: limits nothing"},
      {R"({"layers")", "limits.json:1:"}};
  for (const auto& [text, message] : mistakes) {
    const ProgramResult result = with(text);
    EXPECT_EQ(result.exit_code, 3) << text;
    EXPECT_TRUE(result.errors.starts_with(message)) << text << "\n" << result.errors;
  }
}

TEST_F(CompareLayers, MapsAndPageShowWhatDiffers) {
  Image other = constant(0.5f, kTwoLayers);
  other.at(3, 4, 0) = 1;
  other.at(7, 2, 1) = std::numeric_limits<float>::quiet_NaN();
  const std::string r = file("r.exr", constant(0.5f, kTwoLayers)), t = file("t<1>.exr", other);
  const ProgramResult result =
      run({"compare", r, t, "--maps", "new/maps", "--html", "page.html", "--max", "mse=1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_TRUE(result.says("4 maps in new/maps")) << result.output;
  const Image difference = read_image(folder_ / "new/maps/beauty-difference.png");
  EXPECT_GT(difference.at(3, 4, 0), difference.at(3, 4, 1)) << "more red than before";
  EXPECT_EQ(difference.at(3, 4, 1), difference.at(0, 0, 1));
  EXPECT_EQ(difference.at(7, 2, 0), 1) << "magenta";
  EXPECT_EQ(difference.at(7, 2, 1), 0);
  const Image error = read_image(folder_ / "new/maps/beauty-error.png");
  EXPECT_EQ(error.at(0, 0, 0), 0);
  EXPECT_GT(error.at(3, 4, 0), 0.5f);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "new/maps/specular-error.png"));
  const std::string page = read_text(folder_ / "page.html");
  for (const char* text : {"t&lt;1&gt;.exr", "FAIL", "data:image/png;base64,", "<h3>specular</h3>",
                           "type=\"range\"", "channel G: 1 NaN"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
  for (const char* foreign : {"http:", "https:", "src=\"/", "t<1>"}) {
    EXPECT_EQ(page.find(foreign), std::string::npos) << foreign;
  }
}

TEST_F(CompareLayers, MapsOfSeveralTestsStayApart) {
  const std::string r = file("r.exr", constant(0.5f)), t = file("t.exr", constant(0.4f));
  EXPECT_EQ(run({"compare", r, t, r, t, "--maps", "maps"}).exit_code, 0);
  for (const char* name : {"1-t-beauty-error.png", "2-r-beauty-error.png", "3-t-beauty-difference.png"}) {
    EXPECT_TRUE(std::filesystem::exists(folder_ / "maps" / name)) << name;
  }
}

TEST_F(CompareLayers, UpdateReplacesTheReference) {
  const std::string r = file("r.exr", constant(0.5f)), t = file("t.exr", constant(0.25f));
  const ProgramResult updated = run({"compare", r, t, "--max", "mse=0", "--update"});
  EXPECT_EQ(updated.exit_code, 0) << updated.output;
  EXPECT_TRUE(updated.says("updated: " + r + " is now a copy of " + t)) << updated.output;
  EXPECT_EQ(read_file(r), read_file(t));
  EXPECT_TRUE(run({"compare", r, t, "--update"}).says("not updated: " + r + " is " + t + " already"));
}

TEST_F(CompareLayers, UpdateNeverTakesABadImage) {
  Image bad = constant(0.25f, {"R", "G", "B", "depth.Z"});
  bad.at(1, 1, 3) = std::numeric_limits<float>::infinity();
  const std::string r = file("r.exr", constant(0.5f)), t = file("t.exr", bad),
                    wide = file("wide.exr", constant(0.5f, {"R", "G", "B"}, 17, 16));
  const auto before = read_file(r);
  const ProgramResult refused = run({"compare", r, t, "--update"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_TRUE(refused.says("not updated: " + t + " has values that are NaN")) << refused.output;
  EXPECT_EQ(run({"compare", r, wide, "--update"}).exit_code, 3) << "nothing was compared";
  EXPECT_EQ(run({"compare", r, r, "--layer", "depth", "--update"}).exit_code, 3);
  expect_usage_error({"compare", r, t, t, "--update"});
  expect_usage_error({"compare", r, "t.png", "--update"});
  EXPECT_EQ(read_file(r), before);
  // A bad reference is what an update is for.
  EXPECT_EQ(run({"compare", t, r, "--update"}).exit_code, 0);
  EXPECT_EQ(read_file(t), before);
}

TEST_F(CompareLayers, FailOnAnyValueThatIsNoNumber) {
  const std::vector<std::string> channels{"R",        "G",        "B",      "beauty_variance.R",
                                          "S0.400nm", "S0.500nm", "depth.Z"};
  const Image clean = constant(0.5f, channels);
  const std::string c = file("clean.exr", clean);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  const std::vector<float> values{kNan, kInf, -kInf};
  for (std::size_t channel = 0; channel < channels.size(); ++channel) {
    Image broken = clean;
    broken.at(15, 15, channel) = values[channel % values.size()];
    const std::string b = file("bad.exr", broken);
    // Each in the test image or in the reference, whatever is asked for.
    const bool in_test = channel % 2 == 0;
    EXPECT_EQ(
        run({"compare", in_test ? c : b, in_test ? b : c, "--layer", "beauty", "--max", "mse=9"}).exit_code,
        1)
        << channels[channel];
  }
  const std::string all = file("all.exr", constant(kNan, channels));
  EXPECT_EQ(run({"compare", c, all}).exit_code, 1);
  EXPECT_EQ(run({"compare", all, c}).exit_code, 1);
  EXPECT_EQ(run({"compare", all, all, "--max", "mse=9"}).exit_code, 1) << "equal, and still no images";
}

}  // namespace
}  // namespace spectrace::test
