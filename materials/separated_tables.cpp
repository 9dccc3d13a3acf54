// SPDX-License-Identifier: Apache-2.0
#include "materials/separated_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "materials/residual_file.h"
#include "materials/tensor_reader.h"

namespace spectrace {
namespace {

constexpr std::string_view kFormat = "spectrace separated material 1";

constexpr std::array<std::string_view, 13> kFields{
    "format",    "theta_h_spacing", "wavelengths", "c_d",         "diffuse_shape", "rho_s", "s_sun",
    "s_fresnel", "s_diffraction",   "analytic",    "source_name", "source_sha256", "report"};

HalfDifferenceGrid read_grid(const TensorFile& tensors, const TensorReader& reader) {
  HalfDifferenceGrid grid;
  grid.quadratic_theta_h = reader.is_quadratic();
  constexpr std::array kTypes{TensorType::kF32};
  constexpr std::array<std::size_t, 3> kAnyTable{0, 0, 0};
  const Tensor& rho_s = tensors.require("rho_s", kTypes, kAnyTable);
  for (std::size_t n : rho_s.shape) {
    if (n < 2 || n > HalfDifferenceGrid::kMaxDimension) {
      reader.fail("rho_s", fmt::format("shape {}: each dimension must lie in [2, {}]", rho_s.shape_text(),
                                       HalfDifferenceGrid::kMaxDimension));
    }
  }
  grid.n_theta_h = static_cast<int>(rho_s.shape[0]);
  grid.n_theta_d = static_cast<int>(rho_s.shape[1]);
  grid.n_phi_d = static_cast<int>(rho_s.shape[2]);
  if (grid.size() > HalfDifferenceGrid::kMaxSize) {
    reader.fail("rho_s", fmt::format("shape {}: more than {} cells", rho_s.shape_text(),
                                     HalfDifferenceGrid::kMaxSize));
  }
  return grid;
}

}  // namespace

std::string name_of(SeparationModel model) {
  return std::string(kSeparationModelNames.at(static_cast<std::size_t>(model)));
}

std::optional<SeparationModel> separation_model_named(std::string_view name) {
  const auto it = std::find(kSeparationModelNames.begin(), kSeparationModelNames.end(), name);
  if (it == kSeparationModelNames.end()) return std::nullopt;
  return static_cast<SeparationModel>(it - kSeparationModelNames.begin());
}

SeparatedTables read_separated(const std::filesystem::path& file) {
  return separated_from_tensors(TensorFile::read(file));
}

SeparatedTables separated_from_tensors(const TensorFile& tensors) {
  const TensorReader reader(tensors);
  if (!tensors.find("format")) {
    throw InputError(tensors.file_name(), {},
                     tensors.find("vndf")
                         ? "a measured BRDF, not a separated material: run `spectrace separate` on it"
                         : "not a separated material: field \"format\" is missing");
  }
  if (const std::string format = reader.text("format"); format != kFormat) {
    reader.fail("format", fmt::format("expected \"{}\"", kFormat));
  }
  reader.refuse_unknown({kFields, kResidualFields});
  SeparatedTables tables;
  tables.axis = reader.axis();
  tables.grid = read_grid(tensors, reader);
  const std::size_t n = tables.axis.size();
  const auto h = static_cast<std::size_t>(tables.grid.n_theta_h),
             d = static_cast<std::size_t>(tables.grid.n_theta_d),
             p = static_cast<std::size_t>(tables.grid.n_phi_d);
  tables.c_d = reader.non_negative("c_d", std::array{n});
  tables.rho_s = reader.non_negative("rho_s", std::array{h, d, p});
  if (tensors.find("diffuse_shape")) {
    tables.diffuse_shape = reader.non_negative("diffuse_shape", std::array{h, d, p});
    if (*std::max_element(tables.diffuse_shape.begin(), tables.diffuse_shape.end()) > 1) {
      reader.fail("diffuse_shape", "expected values in [0, 1]");
    }
  }
  tables.s_sun = reader.non_negative("s_sun", std::array{n});
  tables.s_fresnel = reader.non_negative("s_fresnel", std::array{d, n});
  tables.s_diffraction = reader.non_negative("s_diffraction", std::array{h, d, n});
  if (reader.has("analytic"))
    tables.analytic = reader.non_negative("analytic", std::array{std::size_t(4), n});
  if (reader.has("residual_basis")) tables.residual = read_residual(reader, tables.grid, n);
  tables.source_name = reader.optional_text("source_name");
  tables.source_sha256 = reader.optional_text("source_sha256");
  tables.report_json = reader.optional_text("report");
  return tables;
}

TensorFile separated_to_tensors(const SeparatedTables& tables) {
  const std::size_t n = tables.axis.size();
  const auto h = static_cast<std::size_t>(tables.grid.n_theta_h),
             d = static_cast<std::size_t>(tables.grid.n_theta_d),
             p = static_cast<std::size_t>(tables.grid.n_phi_d);
  TensorFile file;
  file.add(Tensor::from_text("format", kFormat));
  file.add(Tensor::from_text("theta_h_spacing", tables.grid.quadratic_theta_h ? "quadratic" : "uniform"));
  if (!tables.axis.is_rgb()) file.add(Tensor::from_floats("wavelengths", {n}, tables.axis.lambda_nm()));
  file.add(Tensor::from_floats("c_d", {n}, tables.c_d));
  if (!tables.diffuse_shape.empty()) {
    file.add(Tensor::from_floats("diffuse_shape", {h, d, p}, tables.diffuse_shape));
  }
  file.add(Tensor::from_floats("rho_s", {h, d, p}, tables.rho_s));
  file.add(Tensor::from_floats("s_sun", {n}, tables.s_sun));
  file.add(Tensor::from_floats("s_fresnel", {d, n}, tables.s_fresnel));
  file.add(Tensor::from_floats("s_diffraction", {h, d, n}, tables.s_diffraction));
  if (!tables.analytic.empty()) file.add(Tensor::from_floats("analytic", {4, n}, tables.analytic));
  if (!tables.residual.is_empty()) add_residual(tables.residual, tables.grid, file);
  // A container field cannot be empty, so an unknown source is an absent field.
  if (!tables.source_name.empty()) file.add(Tensor::from_text("source_name", tables.source_name));
  if (!tables.source_sha256.empty()) file.add(Tensor::from_text("source_sha256", tables.source_sha256));
  if (!tables.report_json.empty()) file.add(Tensor::from_text("report", tables.report_json));
  return file;
}

}  // namespace spectrace
