// SPDX-License-Identifier: Apache-2.0
// `spectrace inspect` of tensor files: measured and separated BRDFs.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "cli/inspect_report.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/math/math.h"
#include "materials/measured_albedo.h"
#include "materials/measured_tables.h"
#include "materials/separated_lookup.h"
#include "materials/tensor_file.h"

namespace spectrace::cli {

namespace {

double degrees(double radians) { return radians * 180 / kPi64; }

/// What the numbers of a field are measured in (Dupuy & Jakob 2018; for ours docs/file-formats.md).
std::string_view unit_of(std::string_view field) {
  struct Unit {
    std::string_view field, unit;
  };
  constexpr std::array kUnits = {Unit{"phi_i", "rad"},
                                 Unit{"theta_i", "rad"},
                                 Unit{"wavelengths", "nm"},
                                 Unit{"ndf", "1/sr"},
                                 Unit{"sigma", "1"},
                                 Unit{"vndf", "unnormalised density"},
                                 Unit{"luminance", "1"},
                                 Unit{"spectra", "f cos / (ndf / 4 sigma)"},
                                 Unit{"rgb", "f cos / (ndf / 4 sigma)"},
                                 Unit{"c_d", "1 (albedo)"},
                                 Unit{"rho_s", "1/sr"}};
  const auto it = std::find_if(kUnits.begin(), kUnits.end(), [&](const Unit& u) { return u.field == field; });
  return it == kUnits.end() ? "" : it->unit;
}

bool is_float(TensorType type) {
  return type == TensorType::kF16 || type == TensorType::kF32 || type == TensorType::kF64;
}

InspectSection field_table(const TensorFile& tensors) {
  InspectSection section;
  section.title = "fields";
  section.columns = {"field", "type", "shape", "min", "max", "zero", "negative", "non_finite", "unit"};
  for (const Tensor& tensor : tensors.tensors()) {
    std::vector<InspectCell> row = {tensor.name, std::string(name_of(tensor.type)), tensor.shape_text()};
    if (is_float(tensor.type) && tensor.count() > 0) {
      const std::vector<float> values = tensor.floats();
      const ValueStatistics s = statistics_of(values);
      row.insert(row.end(),
                 {s.min, s.max, std::int64_t(s.zero), std::int64_t(s.negative), std::int64_t(s.non_finite)});
    } else {
      row.insert(row.end(), 5, std::string());
    }
    row.emplace_back(std::string(unit_of(tensor.name)));
    section.rows.push_back(std::move(row));
  }
  return section;
}

void add_axis(InspectSection& section, const SpectralAxis& axis) {
  if (axis.is_rgb()) {
    section.add("spectral_axis", "RGB");
    return;
  }
  const auto lambda_nm = axis.lambda_nm();
  section.add("spectral_axis", "wavelengths");
  section.add("wavelengths", lambda_nm.size());
  section.add("first_nm", double(lambda_nm.front()));
  section.add("last_nm", double(lambda_nm.back()));
}

std::size_t count_zero(auto begin, auto end) {
  return static_cast<std::size_t>(std::count_if(begin, end, [](auto x) { return x == 0; }));
}

/// One row an elevation: what was measured there, and what was not.
InspectSection elevation_table(const MeasuredTables& tables) {
  InspectSection section;
  section.title = "elevations";
  section.columns = {"theta_i_deg", "source", "cells", "invalid", "zero_luminance"};
  const std::size_t cells = std::size_t(tables.table_size) * std::size_t(tables.table_size);
  const std::size_t n_theta = tables.theta_i.size();
  const float last = tables.last_measured_theta_i();
  for (std::size_t t = 0; t < n_theta; ++t) {
    std::size_t invalid = 0, dark = 0;
    for (std::size_t p = 0; p < tables.phi_i.size(); ++p) {
      const auto at = static_cast<std::ptrdiff_t>((p * n_theta + t) * cells),
                 n = static_cast<std::ptrdiff_t>(cells);
      if (!tables.valid.empty())
        invalid += count_zero(tables.valid.begin() + at, tables.valid.begin() + at + n);
      dark += count_zero(tables.luminance.begin() + at, tables.luminance.begin() + at + n);
    }
    const bool is_measured = tables.theta_i[t] <= last;
    section.rows.push_back(
        {degrees(tables.theta_i[t]), std::string(is_measured ? "measured" : "extrapolated"),
         std::int64_t(cells * tables.phi_i.size()), std::int64_t(invalid), std::int64_t(dark)});
  }
  return section;
}

void add_albedo(InspectSection& section, const MeasuredTables& tables) {
  const AlbedoPeak peak = largest_albedo(MeasuredBrdf(tables));
  section.add("albedo_max", peak.albedo);
  section.add("albedo_max_elevation_deg", peak.theta_deg);
  if (const auto warning = albedo_warning(peak, tables.axis)) section.add("warning", *warning);
}

InspectSection measured_summary(const MeasuredTables& tables) {
  InspectSection section;
  section.title = "measurement";
  section.add("description", tables.description);
  section.add("format", tables.source.format);
  if (tables.source.samples > 0) {
    section.add("samples", tables.source.samples);
    section.add("invalid_samples", tables.source.invalid_samples);
    section.add("filled_cells", tables.source.filled_cells);
  }
  section.add("isotropic", tables.is_isotropic());
  section.add("incident_azimuths", tables.phi_i.size());
  section.add("symmetry_reduction", tables.symmetry_reduction());
  section.add("incident_elevations", tables.theta_i.size());
  const float last = tables.last_measured_theta_i();
  section.add("last_measured_elevation_deg", degrees(last));
  const auto beyond =
      std::count_if(tables.theta_i.begin(), tables.theta_i.end(), [&](float t) { return t > last; });
  section.add("extrapolated_slices", static_cast<std::size_t>(beyond) * tables.phi_i.size());
  section.add("slices", tables.slices());
  add_axis(section, tables.axis);
  section.add("table_size", tables.table_size);
  section.add("warp_size", tables.warp_size);
  section.add("jacobian", tables.jacobian);
  section.add("has_valid_mask", !tables.valid.empty());
  section.add("valid_mask_was_inverted", tables.valid_was_inverted);
  section.add("invalid_cells", count_zero(tables.valid.begin(), tables.valid.end()));
  section.add("negative_values_clamped", tables.negative_values);
  section.add("most_negative_value", double(tables.most_negative));
  section.add("negative_luminances_clamped", tables.negative_luminances);
  section.add("ndf_cells_of_zero", count_zero(tables.ndf.begin(), tables.ndf.end()));
  section.add("smallest_sigma", double(*std::min_element(tables.sigma.begin(), tables.sigma.end())));
  add_albedo(section, tables);
  return section;
}

const std::vector<float>& rho_s_values(const SeparatedTables& tables) { return tables.rho_s; }
std::vector<float> rho_s_values(const CompactTables& tables) {
  std::vector<float> values(tables.rho_s.code.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = tables.rho_s[i];
  return values;
}

template <typename Tables>
InspectSection separated_summary(const Tables& tables, SeparationModel richest) {
  InspectSection section;
  section.title = "separated_material";
  section.add("source", tables.source_name);
  section.add("source_sha256", tables.source_sha256);
  section.add("theta_h_nodes", tables.grid.n_theta_h);
  section.add("theta_d_nodes", tables.grid.n_theta_d);
  section.add("phi_d_nodes", tables.grid.n_phi_d);
  section.add("theta_h_spacing", tables.grid.quadratic_theta_h ? "quadratic" : "uniform");
  add_axis(section, tables.axis);
  std::string models;
  for (int m = 0; m <= static_cast<int>(richest); ++m) {
    if (m > 0) models.push_back(' ');
    models += name_of(static_cast<SeparationModel>(m));
  }
  section.add("models", models);
  const ValueStatistics diffuse = statistics_of(tables.c_d), specular = statistics_of(rho_s_values(tables));
  section.add("diffuse_albedo_mean", diffuse.mean);
  section.add("diffuse_albedo_max", diffuse.max);
  section.add("specular_table_max_per_sr", specular.max);
  section.add("specular_cells_of_zero", specular.zero);
  if constexpr (std::is_same_v<Tables, CompactTables>) {
    section.add("rho_s_error_bound", std::exp2(double(tables.octaves_per_code) / 2) - 1);
    section.add("spectral_rank", tables.rank);
  }
  section.add("residual_rank", tables.residual.rank);
  if (!tables.report_json.empty()) section.add("report", "\n" + tables.report_json);
  return section;
}

InspectSection file_summary(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  InspectSection summary;
  summary.title = "file";
  summary.add("file", file.string());
  summary.add("bytes", bytes.size());
  summary.add("sha256", sha256_hex(bytes));
  return summary;
}

}  // namespace

InspectReport inspect_measured(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_file(file);
  const MeasuredTables tables = measured_from_bytes(bytes, file.string());
  InspectReport report = {file_summary(file, bytes)};
  report[0].add("kind", "measured BRDF, converted to the EPFL layout");
  report.push_back(measured_summary(tables));
  report.push_back(elevation_table(tables));
  return report;
}

InspectReport inspect_tensors(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_file(file);
  const TensorFile tensors = TensorFile::parse(bytes, file.string());
  InspectReport report = {file_summary(file, bytes), field_table(tensors)};
  if (tensors.find("format") != nullptr) {
    const SeparatedSource source = separated_source(tensors);
    report[0].add("kind", is_compact(tensors) ? "separated material, compact" : "separated material");
    report.push_back(
        std::visit([&](const auto& t) { return separated_summary(*t, richest_model(source)); }, source));
  } else if (tensors.find("vndf") != nullptr) {
    report[0].add("kind", "measured BRDF");
    const MeasuredTables tables = measured_from_tensors(tensors);
    report.push_back(measured_summary(tables));
    report.push_back(elevation_table(tables));
  } else {
    report[0].add("kind", "tensor file of another kind");
  }
  return report;
}

}  // namespace spectrace::cli
