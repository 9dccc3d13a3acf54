// SPDX-License-Identifier: Apache-2.0
#include "materials/separated_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "core/base/error.h"

namespace spectrace {
namespace {

constexpr double kHalfPi = std::numbers::pi / 2;
constexpr std::string_view kFormat = "spectrace separated material 1";
// A grid dimension beyond this is no measurement, but would overflow `int` arithmetic on indices.
constexpr std::size_t kMaxDimension = 1 << 14;

/// A node and its upper neighbour.
struct Bracket {
  std::uint32_t lower = 0, upper = 0;
  float fraction = 0;
};

Bracket bracket(double coordinate, int nodes) {
  const int lower = std::clamp(static_cast<int>(coordinate), 0, nodes - 1);
  return {static_cast<std::uint32_t>(lower), static_cast<std::uint32_t>(std::min(lower + 1, nodes - 1)),
          static_cast<float>(coordinate - lower)};
}

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

double HalfDifferenceGrid::theta_h(double i) const {
  const double x = i / n_theta_h;
  return (quadratic_theta_h ? x * x : x) * kHalfPi;
}
double HalfDifferenceGrid::theta_d(double j) const { return j / n_theta_d * kHalfPi; }
double HalfDifferenceGrid::phi_d(double k) const { return k / n_phi_d * std::numbers::pi; }

double HalfDifferenceGrid::coordinate_h(double theta_h_rad) const {
  const double x = std::max(theta_h_rad, 0.0) / kHalfPi;
  return std::min((quadratic_theta_h ? std::sqrt(x) : x) * n_theta_h, n_theta_h - 1.0);
}
double HalfDifferenceGrid::coordinate_d(double theta_d_rad) const {
  return std::clamp(theta_d_rad / kHalfPi * n_theta_d, 0.0, n_theta_d - 1.0);
}
double HalfDifferenceGrid::coordinate_p(double phi_d_rad) const {
  const double turns = phi_d_rad / std::numbers::pi;
  const double k = (turns - std::floor(turns)) * n_phi_d;
  return k < n_phi_d ? k : 0.0;  // rounding may reach n_phi_d, which is node 0
}

GridPoint HalfDifferenceGrid::locate(const HalfDifference& angles) const {
  // Between nodes linear in the angle itself: linear in its root would have a cusp at theta_h = 0.
  Bracket h = bracket(coordinate_h(angles.theta_h), n_theta_h);
  if (h.upper > h.lower) {
    const double first = theta_h(h.lower);
    h.fraction =
        static_cast<float>(std::clamp((angles.theta_h - first) / (theta_h(h.upper) - first), 0.0, 1.0));
  }
  const Bracket d = bracket(coordinate_d(angles.theta_d), n_theta_d);
  const double k = coordinate_p(angles.phi_d);
  const auto p0 = static_cast<std::uint32_t>(k);
  const std::uint32_t p1 = p0 + 1 < static_cast<std::uint32_t>(n_phi_d) ? p0 + 1 : 0;
  const auto fraction_p = static_cast<float>(k - p0);

  GridPoint point;
  const std::array<std::uint32_t, 4> angular{h.lower * n_theta_d + d.lower, h.lower * n_theta_d + d.upper,
                                             h.upper * n_theta_d + d.lower, h.upper * n_theta_d + d.upper};
  point.angular = angular;
  point.angular_weight = {(1 - h.fraction) * (1 - d.fraction), (1 - h.fraction) * d.fraction,
                          h.fraction * (1 - d.fraction), h.fraction * d.fraction};
  for (int i = 0; i < 4; ++i) {
    point.cell[2 * i] = angular[i] * n_phi_d + p0;
    point.cell[2 * i + 1] = angular[i] * n_phi_d + p1;
    point.cell_weight[2 * i] = point.angular_weight[i] * (1 - fraction_p);
    point.cell_weight[2 * i + 1] = point.angular_weight[i] * fraction_p;
  }
  point.theta_d = {d.lower, d.upper};
  point.theta_d_weight = {1 - d.fraction, d.fraction};
  return point;
}

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
