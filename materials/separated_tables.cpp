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

namespace spectrace {
namespace {

constexpr std::string_view kFormat = "spectrace separated material 1";
// A grid dimension beyond this is no measurement, but would overflow `int` arithmetic on indices.
constexpr std::size_t kMaxDimension = 1 << 14;

std::string text_of(const Tensor& tensor) {
  std::string text(tensor.bytes.size(), '\0');
  std::transform(tensor.bytes.begin(), tensor.bytes.end(), text.begin(),
                 [](std::byte b) { return static_cast<char>(b); });
  return text;
}

class Reader {
 public:
  explicit Reader(const TensorFile& file) : file_(file) {}

  /// Every field of the format is finite and >= 0: anything else would reach pixels.
  std::vector<float> non_negative(std::string_view name, std::span<const std::size_t> shape) const {
    constexpr std::array kTypes{TensorType::kF32};
    std::vector<float> values = file_.require(name, kTypes, shape).floats();
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i]) || values[i] < 0) {
        fail(name, fmt::format("expected finite values >= 0, element {} is {}", i, values[i]));
      }
    }
    return values;
  }
  std::string text(std::string_view name) const {
    constexpr std::array kTypes{TensorType::kU8};
    constexpr std::array<std::size_t, 1> kAnyLength{0};
    return text_of(file_.require(name, kTypes, kAnyLength));
  }
  /// The text of a field that may be absent.
  std::string optional_text(std::string_view name) const {
    return file_.find(name) ? text(name) : std::string();
  }
  [[noreturn]] void fail(std::string_view name, std::string problem) const {
    throw InputError(file_.file_name(), fmt::format("field \"{}\"", name), std::move(problem));
  }

 private:
  const TensorFile& file_;
};

SpectralAxis read_axis(const TensorFile& tensors, const Reader& reader) {
  if (!tensors.find("wavelengths")) return SpectralAxis::rgb();
  constexpr std::array<std::size_t, 1> kAnyLength{0};
  std::vector<float> lambda_nm = reader.non_negative("wavelengths", kAnyLength);
  if (lambda_nm.empty()) reader.fail("wavelengths", "expected at least one wavelength");
  if (std::adjacent_find(lambda_nm.begin(), lambda_nm.end(), std::greater_equal<>()) != lambda_nm.end()) {
    reader.fail("wavelengths", "expected strictly increasing wavelengths");
  }
  return SpectralAxis::wavelengths(std::move(lambda_nm));
}

HalfDifferenceGrid read_grid(const TensorFile& tensors, const Reader& reader) {
  HalfDifferenceGrid grid;
  const std::string spacing = reader.text("theta_h_spacing");
  if (spacing != "quadratic" && spacing != "uniform") {
    reader.fail("theta_h_spacing", "expected \"quadratic\" or \"uniform\"");
  }
  grid.quadratic_theta_h = spacing == "quadratic";
  constexpr std::array kTypes{TensorType::kF32};
  constexpr std::array<std::size_t, 3> kAnyTable{0, 0, 0};
  const Tensor& rho_s = tensors.require("rho_s", kTypes, kAnyTable);
  for (std::size_t n : rho_s.shape) {
    if (n < 2 || n > kMaxDimension) {
      reader.fail("rho_s", fmt::format("shape {}: each dimension must lie in [2, {}]", rho_s.shape_text(),
                                       kMaxDimension));
    }
  }
  grid.n_theta_h = static_cast<int>(rho_s.shape[0]);
  grid.n_theta_d = static_cast<int>(rho_s.shape[1]);
  grid.n_phi_d = static_cast<int>(rho_s.shape[2]);
  return grid;
}

}  // namespace

std::string name_of(SeparationModel model) {
  switch (model) {
    case SeparationModel::kSun:
      return "sun";
    case SeparationModel::kFresnel:
      return "fresnel";
    case SeparationModel::kDiffraction:
      return "diffraction";
  }
  SPECTRACE_CHECK(!"a separation model");
  return {};
}

SeparatedTables read_separated(const std::filesystem::path& file) {
  return separated_from_tensors(TensorFile::read(file));
}

SeparatedTables separated_from_tensors(const TensorFile& tensors) {
  const Reader reader(tensors);
  if (!tensors.find("format")) {
    throw InputError(tensors.file_name(), {},
                     tensors.find("vndf")
                         ? "a measured BRDF, not a separated material: run `spectrace separate` on it"
                         : "not a separated material: field \"format\" is missing");
  }
  if (const std::string format = reader.text("format"); format != kFormat) {
    reader.fail("format", fmt::format("expected \"{}\"", kFormat));
  }
  SeparatedTables tables;
  tables.axis = read_axis(tensors, reader);
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
  // A container field cannot be empty, so an unknown source is an absent field.
  if (!tables.source_name.empty()) file.add(Tensor::from_text("source_name", tables.source_name));
  if (!tables.source_sha256.empty()) file.add(Tensor::from_text("source_sha256", tables.source_sha256));
  if (!tables.report_json.empty()) file.add(Tensor::from_text("report", tables.report_json));
  return file;
}

}  // namespace spectrace
