// SPDX-License-Identifier: Apache-2.0
#include "tests/hard_cases/every_measurement.h"

#include <array>
#include <map>
#include <optional>

#include "tests/support/acquired.h"
#include "tests/support/synthetic_measured.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_data.h"

namespace spectrace::test {

namespace {

constexpr const char* kNoRealFiles = "real_files";
constexpr std::array kAcquired{"matte", "gold", "pearlescent", "diffractive_flakes"};

std::vector<std::filesystem::path> real_files() {
  std::vector<std::filesystem::path> files = measured_files("epfl_rgb");
  for (std::filesystem::path& file : measured_files("epfl_uplifted")) files.push_back(std::move(file));
  return files;
}

std::optional<MeasuredTables> made_tables(const std::string& name) {
  if (name == "synthetic") return make_measured({});
  if (name == "synthetic_rgb") return make_measured({.rgb = true});
  if (name == "synthetic_anisotropic") return make_measured({.isotropic = false});
  for (const char* material : kAcquired) {
    if (name == std::string("acquired_") + material) return acquired_tables(material);
  }
  return std::nullopt;
}

Measurement measure(const std::string& name) {
  static const TemporaryFolder folder;
  Measurement result;
  if (const auto tables = made_tables(name)) {
    result.file = folder / (name + ".bsdf");
    measured_to_tensors(*tables).write(result.file);
  } else {
    for (const std::filesystem::path& file : real_files()) {
      if (file.stem() == name) result.file = file;
    }
    if (result.file.empty()) return result;
  }
  result.brdf = std::make_unique<const MeasuredBrdf>(read_measured(result.file));
  SeparationOptions options;
  options.grid = {.n_theta_h = 45, .n_theta_d = 20, .n_phi_d = 18};
  options.residual_rank = kDefaultResidualRank;
  SilentProgress progress;
  SeparationResult separation = separate(*result.brdf, options, progress);
  if (separation.report.usable) {
    result.separated = std::make_shared<const SeparatedTables>(std::move(separation.tables));
  }
  return result;
}

}  // namespace

void EveryMeasurement::SetUp() {
  static std::map<std::string, Measurement> known;
  const auto [place, is_new] = known.try_emplace(GetParam());
  if (is_new) place->second = measure(GetParam());
  if (!place->second.brdf)
    GTEST_SKIP() << "no measurement below " << data_folder() << " (set SPECTRACE_DATA)";
  measurement_ = &place->second;
}

std::vector<std::pair<std::string, Material>> EveryMeasurement::forms() const {
  std::vector<std::pair<std::string, Material>> forms{{"measured", measured()}};
  if (!separated()) return forms;
  for (const std::string_view name : kSeparationModelNames) {
    forms.emplace_back(name, SeparatedBrdf(separated(), *separation_model_named(name)));
  }
  return forms;
}

std::vector<std::string> measurement_names() {
  std::vector<std::string> names{"synthetic", "synthetic_rgb", "synthetic_anisotropic"};
  for (const char* material : kAcquired) names.push_back(std::string("acquired_") + material);
  const std::size_t made = names.size();
  for (const std::filesystem::path& file : real_files()) names.push_back(file.stem().string());
  if (names.size() == made) names.emplace_back(kNoRealFiles);
  return names;
}

}  // namespace spectrace::test
