// SPDX-License-Identifier: Apache-2.0
#include "materials/measured_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/math/math.h"

namespace spectrace {

namespace {

/// On theta_i <= π/2 [rad]: the database writes 1.5707963 and 1.5707964, single precision either side of π/2;
/// tools that convert from degrees add their own rounding.
constexpr double kThetaTolerance = 1e-4;
/// On the span and the ends of phi_i [rad]: single precision at 2π, times a thousand for converted degrees.
constexpr double kPhiTolerance = 1e-3;

constexpr std::array kFloatTypes{TensorType::kF32, TensorType::kF64, TensorType::kF16};
constexpr std::array kByteTypes{TensorType::kU8};

// What a file of the database may lack. Nothing is read from `version`.
constexpr std::array<std::string_view, 2> kOptionalFields{"version", "valid"};

/// One field: where its problems are reported.
struct Field {
  const TensorFile& file;
  const Tensor& tensor;

  [[noreturn]] void fail(std::string problem) const {
    throw InputError(file.file_name(), fmt::format("byte {}: field \"{}\"", tensor.offset, tensor.name),
                     std::move(problem));
  }
  /// "[0,3,17,2]"
  [[nodiscard]] std::string place(std::size_t flat) const {
    std::vector<std::size_t> index(tensor.shape.size());
    for (std::size_t d = index.size(); d-- > 0; flat /= tensor.shape[d]) index[d] = flat % tensor.shape[d];
    return fmt::format("[{}]", fmt::join(index, ","));
  }
};

Field require(const TensorFile& file, std::string_view name, std::span<const TensorType> types,
              std::initializer_list<std::size_t> shape) {
  return {file, file.require(name, types, std::span(shape.begin(), shape.size()))};
}

std::vector<float> finite_values(const Field& field) {
  std::vector<float> values = field.tensor.floats();
  const auto bad = std::find_if(values.begin(), values.end(), [](float x) { return !std::isfinite(x); });
  if (bad != values.end()) {
    field.fail(
        fmt::format("value {} at {}, expected a finite number", *bad, field.place(bad - values.begin())));
  }
  return values;
}

std::vector<float> non_negative_values(const Field& field) {
  std::vector<float> values = finite_values(field);
  const auto bad = std::find_if(values.begin(), values.end(), [](float x) { return x < 0; });
  if (bad != values.end()) {
    field.fail(fmt::format("value {} at {}, expected none below 0", *bad, field.place(bad - values.begin())));
  }
  return values;
}

/// Of the micro-surface, over that of the surface.
std::vector<float> projected_areas(const Field& field) {
  // The database's files have 1 at most, exactly; twice that is left to files that are normalised otherwise.
  constexpr float kLargest = 2;
  std::vector<float> values = non_negative_values(field);
  const auto bad = std::find_if(values.begin(), values.end(), [](float x) { return x > kLargest; });
  if (bad != values.end()) {
    field.fail(fmt::format("value {} at {}, expected projected areas of at most {}", *bad,
                           field.place(bad - values.begin()), kLargest));
  }
  return values;
}

/// Strictly increasing, at least one entry.
std::vector<float> increasing_values(const Field& field) {
  std::vector<float> values = finite_values(field);
  if (values.empty()) field.fail("no entry, expected at least one");
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] <= values[i - 1]) {
      field.fail(fmt::format("entry {} is {} after {}, expected strictly increasing values", i, values[i],
                             values[i - 1]));
    }
  }
  return values;
}

/// How many are below 0, and the least of them; they are clamped to 0.
std::pair<std::size_t, float> clamp_negative(std::vector<float>& values) {
  std::size_t count = 0;
  float least = 0;
  for (float& x : values) {
    if (x >= 0) continue;
    least = std::min(least, x);
    x = 0;
    ++count;
  }
  return {count, least};
}

std::string read_description(const Field& field) {
  std::string text;
  std::span<const std::byte> bytes = field.tensor.bytes;
  while (!bytes.empty() && bytes.back() == std::byte(0)) bytes = bytes.first(bytes.size() - 1);
  for (const std::byte b : bytes) {
    const auto c = static_cast<unsigned char>(b);
    // It ends up in one-line messages and in JSON: neither takes control characters or broken UTF-8.
    text += c >= 0x20 && c < 0x7f ? static_cast<char>(c) : c < 0x7f ? ' ' : '?';
  }
  return text;
}

/// 2π / span where that is 1, 2 or 4, else 0.
int reduction_of(const std::vector<float>& phi_i) {
  const double span = double(phi_i.back()) - phi_i.front();
  for (const int reduction : {1, 2, 4}) {
    if (std::abs(span - 2 * kPi64 / reduction) < kPhiTolerance) return reduction;
  }
  return 0;
}

void read_incident_directions(const TensorFile& file, MeasuredTables& out) {
  const Field phi = require(file, "phi_i", kFloatTypes, {0});
  out.phi_i = increasing_values(phi);
  if (!out.is_isotropic()) {
    const int reduction = reduction_of(out.phi_i);
    if (reduction == 0) {
      phi.fail(fmt::format("spans {} to {} rad, expected a whole, half or quarter turn", out.phi_i.front(),
                           out.phi_i.back()));
    }
    const double quadrants = out.phi_i.front() / (kPi64 / 2);
    if (reduction == 4 && std::abs(quadrants - std::round(quadrants)) * (kPi64 / 2) > kPhiTolerance) {
      phi.fail(
          fmt::format("a quarter turn from {} rad, expected it to begin on an axis of the mirror symmetry",
                      out.phi_i.front()));
    }
  }
  const Field theta = require(file, "theta_i", kFloatTypes, {0});
  out.theta_i = increasing_values(theta);
  if (out.theta_i.front() < 0 || out.theta_i.back() > kPi64 / 2 + kThetaTolerance) {
    theta.fail(fmt::format("spans {} to {} rad, expected values in [0, pi/2]", out.theta_i.front(),
                           out.theta_i.back()));
  }
}

/// The common size of the last two dimensions.
int square_size(const Field& field) {
  const auto& shape = field.tensor.shape;
  const std::size_t height = shape[shape.size() - 2], width = shape.back();
  if (height != width) field.fail(fmt::format("shape {}, last two must be equal", field.tensor.shape_text()));
  if (width < 2)
    field.fail(fmt::format("shape {}, expected grids of at least 2x2", field.tensor.shape_text()));
  return static_cast<int>(width);
}

void read_angular_tables(const TensorFile& file, MeasuredTables& out) {
  const Field ndf = require(file, "ndf", kFloatTypes, {0, 0});
  const std::size_t height = ndf.tensor.shape[0], width = ndf.tensor.shape[1];
  if (height < 2 || width < 2) {
    ndf.fail(fmt::format("shape {}, expected a grid of at least 2x2", ndf.tensor.shape_text()));
  }
  out.ndf_height = static_cast<int>(height);
  out.ndf_width = static_cast<int>(width);
  out.ndf = non_negative_values(ndf);
  out.sigma = projected_areas(require(file, "sigma", kFloatTypes, {height, width}));

  const Field vndf = require(file, "vndf", kFloatTypes, {out.phi_i.size(), out.theta_i.size(), 0, 0});
  out.warp_size = square_size(vndf);
  out.vndf = non_negative_values(vndf);
  const Field luminance =
      require(file, "luminance", kFloatTypes, {out.phi_i.size(), out.theta_i.size(), 0, 0});
  out.table_size = square_size(luminance);
  out.luminance = finite_values(luminance);
  out.negative_luminances = clamp_negative(out.luminance).first;
}

void read_spectra(const TensorFile& file, MeasuredTables& out) {
  const auto size = static_cast<std::size_t>(out.table_size);
  const std::size_t phis = out.phi_i.size(), thetas = out.theta_i.size();
  const bool is_rgb = file.find("rgb") != nullptr;
  if (is_rgb == (file.find("spectra") != nullptr)) {
    throw InputError(
        file.file_name(), "",
        fmt::format(R"({} of the fields "spectra" and "rgb", expected one)", is_rgb ? "both" : "neither"));
  }
  if (is_rgb) {
    out.axis = SpectralAxis::rgb();
    out.spectra = finite_values(require(file, "rgb", kFloatTypes, {phis, thetas, 3, size, size}));
  } else {
    const Field wavelengths = require(file, "wavelengths", kFloatTypes, {0});
    std::vector<float> lambda_nm = increasing_values(wavelengths);
    if (lambda_nm.front() <= 0)
      wavelengths.fail(fmt::format("{} nm, expected positive values", lambda_nm.front()));
    out.axis = SpectralAxis::wavelengths(std::move(lambda_nm));
    out.spectra =
        finite_values(require(file, "spectra", kFloatTypes, {phis, thetas, out.axis.size(), size, size}));
  }
  std::tie(out.negative_values, out.most_negative) = clamp_negative(out.spectra);
  out.jacobian = require(file, "jacobian", kByteTypes, {1}).tensor.bytes[0] != std::byte(0);
}

/// The database packs eight cells a byte, first cell in the highest bit. Some of its files set the bits of
/// the cells that were measured, others of those that were not; most cells are measured, and light was seen
/// there.
void read_valid(const TensorFile& file, MeasuredTables& out) {
  const Tensor* const tensor = file.find("valid");
  if (tensor == nullptr) return;
  const Field field{file, *tensor};
  const std::size_t cells = out.luminance.size();
  if (tensor->type != TensorType::kU8)
    field.fail(fmt::format("element type {}, expected u8", name_of(tensor->type)));
  const bool packed = tensor->bytes.size() == (cells + 7) / 8;
  if (!packed && tensor->bytes.size() != cells) {
    field.fail(fmt::format("{} bytes for {} cells, expected one bit or one byte a cell", tensor->bytes.size(),
                           cells));
  }
  out.valid.resize(cells);
  std::size_t lit_set = 0, lit_unset = 0;
  for (std::size_t i = 0; i < cells; ++i) {
    const auto byte = std::to_integer<unsigned>(tensor->bytes[packed ? i / 8 : i]);
    const bool set = packed ? ((byte >> (7 - i % 8)) & 1) != 0 : byte != 0;
    out.valid[i] = set ? 1 : 0;
    if (out.luminance[i] > 0) ++(set ? lit_set : lit_unset);
  }
  out.valid_was_inverted = lit_unset > lit_set;
  if (out.valid_was_inverted) {
    for (unsigned char& v : out.valid) v = v == 0 ? 1 : 0;
  }
}

/// An optional field under a damaged name would be missed unnoticed: a name like that of an optional field
/// that is not there is an error. Other unknown fields are the writer's own business.
void refuse_misspelt_fields(const TensorFile& file) {
  std::vector<std::string> absent;
  for (const std::string_view name : kOptionalFields) {
    if (file.find(name) == nullptr) absent.emplace_back(name);
  }
  for (const Tensor& tensor : file.tensors()) {
    const std::string hint = suggestion(tensor.name, absent);
    if (!hint.empty()) Field{file, tensor}.fail("is no field of a measurement" + hint);
  }
}

Tensor packed_bits(std::string name, const std::vector<unsigned char>& flags) {
  Tensor tensor{
      .name = std::move(name), .type = TensorType::kU8, .shape = {(flags.size() + 7) / 8}, .bytes = {}};
  tensor.bytes.resize(tensor.shape[0]);
  for (std::size_t i = 0; i < flags.size(); ++i) {
    if (flags[i] != 0) tensor.bytes[i / 8] |= std::byte(0x80 >> (i % 8));
  }
  return tensor;
}

/// Whether, in a table [phi][theta][slice_size], the last two slices of every phi have the same bits.
bool last_slices_equal(const std::vector<float>& table, std::size_t phis, std::size_t thetas) {
  const std::size_t slice = table.size() / (phis * thetas);
  for (std::size_t p = 0; p < phis; ++p) {
    const float* const last = table.data() + (p * thetas + thetas - 1) * slice;
    if (std::memcmp(last - slice, last, slice * sizeof(float)) != 0) return false;
  }
  return true;
}

}  // namespace

int MeasuredTables::symmetry_reduction() const { return is_isotropic() ? 1 : reduction_of(phi_i); }

float MeasuredTables::last_measured_theta_i() const {
  const std::size_t phis = phi_i.size(), thetas = theta_i.size();
  const bool is_copy =
      thetas > 1 && last_slices_equal(luminance, phis, thetas) && last_slices_equal(spectra, phis, thetas);
  return is_copy ? theta_i[thetas - 2] : theta_i.back();
}

MeasuredTables measured_from_tensors(const TensorFile& tensors) {
  if (tensors.find("c_d") != nullptr) {
    throw InputError(tensors.file_name(), "", "a separated material (.sep), not a measurement");
  }
  refuse_misspelt_fields(tensors);
  MeasuredTables out;
  out.file_name = tensors.file_name();
  out.description = read_description(require(tensors, "description", kByteTypes, {0}));
  read_incident_directions(tensors, out);
  read_angular_tables(tensors, out);
  read_spectra(tensors, out);
  read_valid(tensors, out);
  return out;
}

TensorFile measured_to_tensors(const MeasuredTables& tables) {
  const std::size_t phis = tables.phi_i.size(), thetas = tables.theta_i.size();
  const auto n = static_cast<std::size_t>(tables.warp_size), m = static_cast<std::size_t>(tables.table_size);
  const std::vector<std::size_t> ndf_shape{std::size_t(tables.ndf_height), std::size_t(tables.ndf_width)};
  TensorFile file;
  file.add(Tensor::from_text("description", tables.description));
  file.add(Tensor::from_floats("phi_i", {phis}, tables.phi_i));
  file.add(Tensor::from_floats("theta_i", {thetas}, tables.theta_i));
  file.add(Tensor::from_floats("sigma", ndf_shape, tables.sigma));
  file.add(Tensor::from_floats("ndf", ndf_shape, tables.ndf));
  file.add(Tensor::from_floats("vndf", {phis, thetas, n, n}, tables.vndf));
  file.add(Tensor::from_floats("luminance", {phis, thetas, m, m}, tables.luminance));
  if (tables.axis.is_rgb()) {
    file.add(Tensor::from_floats("rgb", {phis, thetas, 3, m, m}, tables.spectra));
  } else {
    file.add(Tensor::from_floats("wavelengths", {tables.axis.size()}, tables.axis.lambda_nm()));
    file.add(Tensor::from_floats("spectra", {phis, thetas, tables.axis.size(), m, m}, tables.spectra));
  }
  Tensor jacobian{.name = "jacobian", .type = TensorType::kU8, .shape = {1}, .bytes = {}};
  jacobian.bytes = {std::byte(tables.jacobian ? 1 : 0)};
  file.add(std::move(jacobian));
  if (!tables.valid.empty()) file.add(packed_bits("valid", tables.valid));
  return file;
}

}  // namespace spectrace
