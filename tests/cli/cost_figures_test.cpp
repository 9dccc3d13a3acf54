// SPDX-License-Identifier: Apache-2.0
// What `spectrace cost` says of a ball whose colour shifts with the angle: laws that noise and bias must
// obey. With fixed samples instead of a budget: the same on every machine.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <vector>

#include "core/base/json.h"
#include "core/image/error_model.h"
#include "core/image/metrics.h"
#include "tests/cli/program.h"

namespace spectrace::test {
namespace {

using Options = std::vector<std::string>;

/// scenes/material_ball.json at 48 x 48 pixels.
class CostFigures : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_.emplace();
    std::filesystem::create_directory(folder_->path() / "demo-out");
    std::filesystem::create_directory(folder_->path() / "scenes");
    const std::string text = read_text(kScenes / "material_ball.json");
    write_text(folder_->path() / "scenes/ball.json", std::regex_replace(text, std::regex("256"), "48"));
    const ProgramResult acquired = run_spectrace(
        {"acquire", (kScenes / "materials/pearlescent.json").string(), "-o", "demo-out/pearlescent.bsdf"},
        folder_->path());
    ASSERT_EQ(acquired.exit_code, 0) << acquired.errors;
    first_ = beauty(kReferenceSpp / 2, 1000, {});
    second_ = beauty(kReferenceSpp / 2, 1001, {});
    mean_ = first_;
    double sum = 0;
    for (std::size_t i = 0; i < mean_.data.size(); ++i) {
      mean_.data[i] = (first_.data[i] + second_.data[i]) / 2;
      sum += double(mean_.data[i]) / double(mean_.data.size());
    }
    epsilon_ = kRelativeEpsilon * sum * sum;
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static const std::filesystem::path& folder() { return folder_->path(); }
  static Image beauty(int spp, std::uint64_t seed, const Options& options,
                      const std::string& scene = "scenes/ball.json") {
    Options arguments{
        scene,    "-o",       "out.exr", "--spp", std::to_string(spp), "--seed", std::to_string(seed),
        "--grid", "45x45x90", "--cache", "cache"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramResult result = run_spectrace(arguments, folder_->path());
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    const std::array<std::string, 3> rgb{"R", "G", "B"};
    return read_image(folder_->path() / "out.exr").select(rgb, "out.exr");
  }
  static double rel_mse(int spp, std::uint64_t seed, const Options& options) {
    return compare_images(mean_, beauty(spp, seed, options), {.epsilon = epsilon_}).rel_mse;
  }
  /// Against the reference, without the reference's own noise.
  static double error(const Image& picture, double epsilon) {
    return std::sqrt(compare_images(mean_, picture, {.epsilon = epsilon}).rel_mse -
                     noise_rel_mse({first_, second_}, epsilon).value);
  }
  static double known() { return noise_rel_mse({first_, second_}, epsilon_).value; }
  static Estimate bias(const Options& options) {
    return bias_rel_mse({beauty(128, 20, options), beauty(128, 21, options)}, {first_, second_}, epsilon_);
  }
  /// As `cost` fits it.
  static ErrorModel fit(const Options& options) {
    std::vector<ErrorPoint> ladder;
    for (const int spp : {8, 16, 32, 64}) {
      ladder.push_back({double(spp), 1, rel_mse(spp, std::uint64_t(spp), options)});
    }
    return fit_error_model(ladder, bias(options).value, known());
  }

 private:
  static constexpr int kReferenceSpp = 1024;
  static inline std::optional<TemporaryFolder> folder_;
  static inline Image first_, second_, mean_;
  static inline double epsilon_ = 0;
};

const Options kIndependent{"--sampler", "independent"};

TEST_F(CostFigures, NoiseOfIndependentSamplesFallsAsOneOverTime) {
  constexpr double kSlopeTolerance = 0.1;  // the law is exact; what is left is the ladder's own noise
  const ErrorModel independent = fit(kIndependent), own = fit({});
  EXPECT_NEAR(independent.exponent, 1, kSlopeTolerance);
  EXPECT_GT(own.exponent, 1 + kSlopeTolerance) << "stratified samples";
  EXPECT_LT(own.rel_mse(64), independent.rel_mse(64));
}

TEST_F(CostFigures, FittedErrorHoldsForSettingsThatWereNotMeasured) {
  constexpr double kTolerance = 0.25;
  for (const Options& options : {Options{}, Options{"--separate", "sun"}, kIndependent}) {
    const ErrorModel model = fit(options);
    for (const int spp : {12, 24, 48, 128}) {  // between the ladder's rungs, and beyond the last
      const double expected = model.rel_mse(spp) + known();
      const double measured = rel_mse(spp, 300 + std::uint64_t(spp), options);
      EXPECT_NEAR(measured, expected, kTolerance * expected)
          << spp << " samples, " << (options.empty() ? "default" : options.back());
    }
  }
}

TEST_F(CostFigures, BiasOfOneColourExceedsThatOfColoursByAngle) {
  const Estimate sun = bias({"--separate", "sun"});
  // 4 standard errors: significance 6e-5.
  for (const char* model : {"fresnel", "diffraction", "residual"}) {
    const Estimate other = bias({"--separate", model});
    EXPECT_GT(sun.value, other.value + 4 * std::hypot(sun.standard_error, other.standard_error)) << model;
  }
  for (const Options& raw : {Options{}, kIndependent}) {
    const Estimate none = bias(raw);
    EXPECT_NEAR(none.value, 0, 4 * none.standard_error);
  }
}

/// A setting of cost.json.
struct Fit {
  ErrorModel model;
  std::vector<int> ladder;
};
struct Report {
  double epsilon = 0;
  std::map<std::string, Fit> fits;
};

Report read_report(const std::filesystem::path& file) {
  JsonDocument document = JsonDocument::load(file);
  Report report{.epsilon = document.root().require("epsilon").number(0), .fits = {}};
  for (const JsonValue& setting : document.root().require("settings").elements()) {
    Fit fit;
    fit.model.noise = setting.require("noise_rel_mse_at_one_sample").number(0);
    fit.model.exponent = setting.require("noise_exponent").number(0);
    fit.model.bias = std::max(0.0, setting.require("bias_rel_mse").number(0));
    for (const JsonValue& point : setting.require("points").elements()) {
      fit.ladder.push_back(int(point.require("spp").integer(0, 0, 1 << 20)));
    }
    report.fits[setting.require("knob").string() + ' ' + setting.require("name").string()] = fit;
  }
  return report;
}

TEST_F(CostFigures, ReportPredictsTheErrorOfWhatIsNotInItsLadders) {
  constexpr double kTolerance = 0.25;
  const ProgramResult cost = run_spectrace({"cost", "scenes/ball.json", "-o", "report", "--budget", "20",
                                            "--grid", "45x45x90", "--cache", "cache"},
                                           folder());
  ASSERT_EQ(cost.exit_code, 0) << cost.errors;
  const Report report = read_report(folder() / "report/cost.json");
  write_text(folder() / "scenes/short.json",
             std::regex_replace(read_text(folder() / "scenes/ball.json"), std::regex("\"max_depth\": 6"),
                                "\"max_depth\": 2"));
  struct Unseen {
    const char* name;
    const char* scene;
    Options options;
  };
  const std::array<Unseen, 4> unseen{{{"exact exact", "scenes/ball.json", {}},
                                      {"sampler independent", "scenes/ball.json", kIndependent},
                                      {"model sun", "scenes/ball.json", {"--separate", "sun"}},
                                      {"path depth 2", "scenes/short.json", {}}}};
  for (const auto& [name, scene, options] : unseen) {
    ASSERT_TRUE(report.fits.contains(name)) << name << '\n' << cost.output;
    const auto& [model, ladder] = report.fits.at(name);
    for (const int spp : {12, 24, 48}) {
      ASSERT_EQ(std::count(ladder.begin(), ladder.end(), spp), 0) << name;
      const double measured = error(beauty(spp, 500 + std::uint64_t(spp), options, scene), report.epsilon);
      EXPECT_NEAR(std::sqrt(model.rel_mse(spp)), measured, kTolerance * measured)
          << name << ", " << spp << " samples; measured at up to " << ladder.back();
    }
  }
}

}  // namespace
}  // namespace spectrace::test
