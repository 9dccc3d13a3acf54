// SPDX-License-Identifier: Apache-2.0
#include "tests/validation/subjects.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <utility>

#include "core/base/progress.h"
#include "materials/measured_brdf.h"
#include "materials/separated_brdf.h"
#include "separation/compact.h"
#include "separation/separate.h"
#include "tests/support/test_data.h"

namespace spectrace::test {

namespace {

constexpr std::array kRoughness{0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0};

bool begins(const std::string& name, const char* with) { return name.rfind(with, 0) == 0; }

/// Of a case of the registry; real files have subjects of their own.
std::string family_of(const std::string& name) {
  for (const char* family : {"Lambert", "RoughConductor", "Glossy", "Diffractive", "Plastic", "RoughGlass",
                             "Separated", "Compact", "Acquired", "Paired"}) {
    if (begins(name, family)) return family;
  }
  if (begins(name, "BuiltIn")) return "BuiltIn";
  if (begins(name, "Analytic") || begins(name, "TableX") || begins(name, "OrientedTable")) return "Tables";
  return "Nested";
}

Spectrum ramp(Float at_400_nm, Float at_700_nm) {
  return TabulatedSpectrum({400, 700}, {at_400_nm, at_700_nm});
}

void add_roughness(std::vector<Subject>& subjects, double roughness) {
  const auto alpha = Float(roughness);
  const auto add = [&](const std::string& family, std::function<std::optional<Material>()> make) {
    subjects.push_back({family,
                        {.name = fmt::format("{}_alpha_{}", family, roughness),
                         .make = std::move(make),
                         .is_reciprocal = true,
                         .conserves_energy = true}});
  };
  const ConductorFresnel gold{
      .eta = ramp(Float(1.5), Float(0.15)), .k = ramp(Float(1.9), Float(4)), .film = {}};
  const Spectrum base = ramp(Float(0.2), Float(0.8)), glass = ramp(Float(1.53), Float(1.5));
  add("RoughConductor", [=] { return RoughConductor{gold, {alpha, alpha}}; });
  add("Glossy", [=] {
    return Glossy{.reflectance = base,
                  .fresnel = SchlickFresnel{Spectrum::constant(Float(0.04))},
                  .ggx = {alpha, alpha},
                  .diffuse_scale = Float(0.5),
                  .specular_scale = Float(0.5)};
  });
  add("Diffractive", [=] {
    return Diffractive{.reflectance = base,
                       .fresnel = gold,
                       .ggx = {alpha, alpha},
                       .micro = {.rms_nm = 40, .correlation_nm = 2000, .exponent = Float(2.5)},
                       .diffuse_scale = Float(0.4),
                       .specular_scale = Float(0.6)};
  });
  add("Plastic", [=] { return Plastic(base, glass, alpha); });
  add("RoughGlass", [=] { return RoughDielectric(Spectrum::constant(Float(1.5)), {alpha, alpha}); });
  subjects.back().bsdf.interior_eta = Spectrum::constant(Float(1.5));
  subjects.back().bsdf.is_two_sided = true;
  if (roughness < 1) {
    subjects.push_back({"RoughConductor",
                        {.name = fmt::format("RoughConductor_alpha_{}_by_1", roughness),
                         .make =
                             [=] {
                               return RoughConductor{gold, {alpha, 1}};
                             },
                         .is_reciprocal = true,
                         .conserves_energy = true}});
  }
}

/// The separation of one file, made when the first of its models is asked for and dropped with the last.
class SharedSeparation {
 public:
  explicit SharedSeparation(std::filesystem::path file) : file_(std::move(file)) {}
  [[nodiscard]] std::shared_ptr<const CompactTables> tables() {
    if (!is_made_) {
      is_made_ = true;
      SeparationOptions options;
      options.residual_rank = kDefaultResidualRank;
      SilentProgress progress;
      const SeparationResult result = separate(MeasuredBrdf(read_measured(file_)), options, progress);
      if (result.report.usable) {
        tables_ = std::make_shared<const CompactTables>(compact(result.tables, kDefaultQuality).tables);
      }
    }
    return tables_;
  }
  void drop() { tables_.reset(); }

 private:
  std::filesystem::path file_;
  std::shared_ptr<const CompactTables> tables_;
  bool is_made_ = false;
};

void add_real(std::vector<Subject>& subjects, const std::filesystem::path& file) {
  const std::string name = file.stem().string();
  subjects.push_back({"real, measured", {.name = "measured " + name, .make = [file] {
                                           return MeasuredBrdf(read_measured(file));
                                         }}});
  const auto shared = std::make_shared<SharedSeparation>(file);
  for (const SeparationModel model : {SeparationModel::kSun, SeparationModel::kFresnel,
                                      SeparationModel::kDiffraction, SeparationModel::kResidual}) {
    const bool is_last = model == SeparationModel::kResidual;
    subjects.push_back({"real, " + name_of(model),
                        {.name = name_of(model) + " " + name,
                         .make = [shared, model, is_last]() -> std::optional<Material> {
                           const auto tables = shared->tables();
                           if (is_last) shared->drop();
                           if (!tables) return std::nullopt;
                           return SeparatedBrdf(tables, model);
                         },
                         .is_reciprocal = !is_last}});  // the residual keeps what the measurement has
  }
}

}  // namespace

std::vector<Subject> validation_subjects() {
  std::vector<Subject> subjects;
  for (const std::filesystem::path& file : measured_files("epfl_uplifted")) add_real(subjects, file);
  for (const double roughness : kRoughness) add_roughness(subjects, roughness);
  for (const std::filesystem::path& file : measured_files("cornell", ".brdf")) add_real(subjects, file);
  for (const std::filesystem::path& file : measured_files("epfl_rgb")) add_real(subjects, file);
  for (const BsdfCase& c : bsdf_cases()) {
    if (!begins(c.name, "Measured_")) subjects.push_back({family_of(c.name), c});
  }
  return subjects;
}

}  // namespace spectrace::test
