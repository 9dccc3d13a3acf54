// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/bench_materials.h"

#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <utility>

#include "core/math/sampler.h"
#include "materials/acquisition.h"
#include "materials/compact_tables.h"
#include "separation/compact.h"
#include "separation/tabulate.h"
#include "tests/support/test_data.h"

namespace spectrace::bench {
namespace {

constexpr std::size_t kVertices = std::size_t(1) << 16;
constexpr const char* kBuiltIn = "pearlescent";  // a thin film over a diffuse base: all models differ

std::filesystem::path real_file(Axis axis) {
  return test::data_folder() / (axis == Axis::kRgb ? "epfl_rgb/irid_flake_paint2_rgb.bsdf"
                                                   : "epfl_uplifted/cc_nothern_aurora_spec.bsdf");
}

bool has_real_file(Axis axis) {
  std::error_code absent;
  return std::filesystem::exists(real_file(axis), absent);
}

/// The database's layout and size; of the RGB axis the values at three wavelengths stand for the channels.
MeasuredTables acquired(Axis axis) {
  AcquisitionOptions options;
  if (axis == Axis::kRgb) options.lambda_nm = {465, 550, 610};
  SilentProgress progress;
  const std::filesystem::path folder = std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes/materials";
  MeasuredTables tables =
      acquire(build_material(load_material(folder / (std::string(kBuiltIn) + ".json"))), options, progress);
  if (axis == Axis::kRgb) tables.axis = SpectralAxis::rgb();
  return tables;
}

/// The tables that forms of one axis share.
struct Source {
  MeasuredTables tables;
  std::shared_ptr<const SeparatedTables> plain;
  std::shared_ptr<const CompactTables> compacted;

  explicit Source(Axis axis)
      : tables(has_real_file(axis) ? read_measured(real_file(axis)) : acquired(axis)) {}

  void separate_once() {
    if (plain) return;
    SilentProgress progress;
    plain = std::make_shared<const SeparatedTables>(
        separate(MeasuredBrdf(tables), separation_options(), progress).tables);
    compacted = std::make_shared<const CompactTables>(compact(*plain, kDefaultQuality).tables);
  }
};

Source& source(Axis axis) {
  static std::map<Axis, Source> sources;
  return sources.try_emplace(axis, axis).first->second;
}

Material make(Axis axis, const std::string& form) {
  Source& from = source(axis);
  if (form == kRaw) return MeasuredBrdf(from.tables);
  if (form == "tabulated") {
    return TabulatedBrdf(std::make_shared<const HalfDifferenceTable>(
        tabulate(MeasuredBrdf(from.tables), separation_options())));
  }
  from.separate_once();
  const std::size_t slash = form.find('/');
  const SeparationModel model = separation_model_named(form.substr(slash + 1)).value();
  return form.substr(0, slash) == "compact" ? SeparatedBrdf(from.compacted, model)
                                            : SeparatedBrdf(from.plain, model);
}

}  // namespace

std::string_view name_of(Axis axis) { return axis == Axis::kRgb ? "rgb" : "spectral"; }

std::vector<std::string> forms() {
  std::vector<std::string> out{std::string(kRaw), "tabulated"};
  for (const char* const storage : {"compact/", "plain/"}) {
    for (const std::string_view model : kSeparationModelNames) out.push_back(storage + std::string(model));
  }
  return out;
}

const MeasuredTables& measured_tables(Axis axis) { return source(axis).tables; }

std::string source_of(Axis axis) {
  return has_real_file(axis) ? real_file(axis).filename().string() : kBuiltIn + std::string(" (acquired)");
}

SeparationOptions separation_options() {
  SeparationOptions options;
  options.residual_rank = kDefaultResidualRank;
  return options;
}

const Material& material(Axis axis, const std::string& form) {
  static std::map<std::pair<Axis, std::string>, Material> made;
  const auto key = std::make_pair(axis, form);
  auto it = made.find(key);
  if (it == made.end()) it = made.emplace(key, make(axis, form)).first;
  return it->second;
}

const std::vector<Vertex>& vertices() {
  static const std::vector<Vertex> all = [] {
    const WavelengthDistribution lambda = WavelengthDistribution::visible({});
    std::vector<Vertex> out;
    for (std::size_t i = 0; i < kVertices; ++i) {
      const Sampler random(i, 0, 1);
      out.push_back({.wo = sample_cosine_hemisphere(random.vertex(0).light),
                     .wi = sample_cosine_hemisphere(random.vertex(1).light),
                     .lambda = lambda.sample(random.path().wavelength),
                     .random = {.lobe = random.vertex(0).lobe,
                                .direction = random.vertex(0).bsdf}});
    }
    return out;
  }();
  return all;
}

}  // namespace spectrace::bench
