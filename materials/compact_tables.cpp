// SPDX-License-Identifier: Apache-2.0
#include "materials/compact_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "materials/packed_table.h"
#include "materials/residual_file.h"
#include "materials/tensor_reader.h"

namespace spectrace {
namespace {

constexpr std::string_view kFormat = "spectrace compact separated material 1";

constexpr std::array<std::string_view, 19> kFields{"format",
                                                   "nodes",
                                                   "theta_h_spacing",
                                                   "wavelengths",
                                                   "c_d",
                                                   "s_sun",
                                                   "rho_s_octaves_per_code",
                                                   "rho_s_max",
                                                   "rho_s_codes",
                                                   "diffuse_shape",
                                                   "spectral_basis",
                                                   "s_fresnel_scale",
                                                   "s_fresnel_codes",
                                                   "s_diffraction_scale",
                                                   "s_diffraction_codes",
                                                   "analytic",
                                                   "source_name",
                                                   "source_sha256",
                                                   "report"};
constexpr std::array<std::size_t, 1> kOne{1};
constexpr float kMaxOctaves = 24;  // of LogCodes: the precision of float's own mantissa
constexpr float kShort = 32767;    // largest code of a signed weight

/// Signed weights, [rows][rank], each column to 1/32767 of its largest: half that is the error.
struct ShortCodes {
  std::vector<float> scale;         // [rank]
  std::vector<std::uint16_t> code;  // [rank][rows], two's complement
};

ShortCodes encode(const std::vector<float>& weights, std::size_t rank) {
  const std::size_t rows = weights.size() / rank;
  ShortCodes out{.scale = std::vector<float>(rank), .code = std::vector<std::uint16_t>(weights.size())};
  for (std::size_t k = 0; k < rank; ++k) {
    for (std::size_t r = 0; r < rows; ++r) {
      out.scale[k] = std::max(out.scale[k], std::abs(weights[r * rank + k]) / kShort);
    }
    for (std::size_t r = 0; r < rows && out.scale[k] > 0; ++r) {
      const auto code = static_cast<std::int16_t>(std::lround(weights[r * rank + k] / out.scale[k]));
      out.code[k * rows + r] = static_cast<std::uint16_t>(code);
    }
  }
  return out;
}

std::vector<float> decode(const std::vector<float>& scale, const std::vector<std::uint16_t>& code) {
  const std::size_t rank = scale.size(), rows = code.size() / rank;
  std::vector<float> weights(code.size());
  for (std::size_t k = 0; k < rank; ++k) {
    for (std::size_t r = 0; r < rows; ++r) {
      weights[r * rank + k] = scale[k] * float(static_cast<std::int16_t>(code[k * rows + r]));
    }
  }
  return weights;
}

PlaneShape angles_of(const HalfDifferenceGrid& grid, std::size_t planes) {
  return {.planes = planes, .rows = std::size_t(grid.n_theta_h), .columns = std::size_t(grid.n_theta_d)};
}

PlaneShape fresnel_of(const HalfDifferenceGrid& grid, std::size_t planes) {
  return {.planes = planes, .rows = 1, .columns = std::size_t(grid.n_theta_d)};
}

HalfDifferenceGrid read_nodes(const TensorReader& reader) {
  constexpr std::array<std::size_t, 1> kThree{3};
  const std::vector<float> nodes = reader.non_negative("nodes", kThree);
  for (float n : nodes) {
    if (!(n >= 2 && n <= float(HalfDifferenceGrid::kMaxDimension) && n == std::floor(n))) {
      reader.fail("nodes",
                  fmt::format("each must be a whole number in [2, {}]", HalfDifferenceGrid::kMaxDimension));
    }
  }
  const HalfDifferenceGrid grid{.n_theta_h = int(nodes[0]),
                                .n_theta_d = int(nodes[1]),
                                .n_phi_d = int(nodes[2]),
                                .quadratic_theta_h = reader.is_quadratic()};
  if (grid.size() > HalfDifferenceGrid::kMaxSize) {
    reader.fail("nodes", fmt::format("more than {} cells", HalfDifferenceGrid::kMaxSize));
  }
  return grid;
}

/// The basis, and what there is of s_F and s_D: a file holds what its richest model needs.
void read_spectra(const TensorReader& reader, CompactTables& tables) {
  if (!reader.has("spectral_basis")) return;
  tables.rank = reader.rank("spectral_basis", kMaxSpectralRank);
  tables.basis = reader.finite("spectral_basis", std::array{tables.rank, tables.axis.size()});
  const std::array rank{tables.rank};
  tables.s_fresnel = decode(reader.non_negative("s_fresnel_scale", rank),
                            reader.shorts("s_fresnel_codes", fresnel_of(tables.grid, tables.rank)));
  if (!reader.has("s_diffraction_codes")) return;
  tables.s_diffraction = decode(reader.non_negative("s_diffraction_scale", rank),
                                reader.shorts("s_diffraction_codes", angles_of(tables.grid, tables.rank)));
}

void add_spectra(const CompactTables& tables, TensorFile& file) {
  if (tables.s_fresnel.empty()) return;
  file.add(Tensor::from_floats("spectral_basis", {tables.rank, tables.axis.size()}, tables.basis));
  const ShortCodes fresnel = encode(tables.s_fresnel, tables.rank);
  file.add(Tensor::from_floats("s_fresnel_scale", {tables.rank}, fresnel.scale));
  file.add(pack("s_fresnel_codes", std::span<const std::uint16_t>(fresnel.code),
                fresnel_of(tables.grid, tables.rank)));
  if (tables.s_diffraction.empty()) return;
  const ShortCodes diffraction = encode(tables.s_diffraction, tables.rank);
  file.add(Tensor::from_floats("s_diffraction_scale", {tables.rank}, diffraction.scale));
  file.add(pack("s_diffraction_codes", std::span<const std::uint16_t>(diffraction.code),
                angles_of(tables.grid, tables.rank)));
}

}  // namespace

LogCodes LogCodes::from_codes(std::vector<std::uint16_t> code, float max, float octaves_per_code) {
  LogCodes out{.code = std::move(code), .level = {0}};
  const auto last = static_cast<int>(kMaxOctaves / octaves_per_code) + 1;
  for (int c = 1; c <= last; ++c) {
    out.level.push_back(static_cast<float>(double(max) * std::exp2((c - last) * double(octaves_per_code))));
  }
  return out;
}

LogCodes LogCodes::encode(const std::vector<float>& values, float octaves_per_code) {
  const float max = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
  LogCodes out = from_codes(std::vector<std::uint16_t>(values.size()), max, octaves_per_code);
  const int last = static_cast<int>(out.level.size()) - 1;
  SPECTRACE_CHECK(last <= std::numeric_limits<std::uint16_t>::max());
  if (!(max > 0)) return out;
  std::transform(values.begin(), values.end(), out.code.begin(), [&](float x) {
    if (!(x > 0)) return std::uint16_t(0);
    const double below = std::log2(double(max) / double(x)) / double(octaves_per_code);
    return static_cast<std::uint16_t>(
        std::max(last - static_cast<int>(std::lround(std::min(below, 1e6))), 0));
  });
  return out;
}

bool is_compact(const TensorFile& tensors) {
  const Tensor* const format = tensors.find("format");
  return format != nullptr && format->bytes.size() == kFormat.size() &&
         std::memcmp(format->bytes.data(), kFormat.data(), kFormat.size()) == 0;
}

CompactTables compact_from_tensors(const TensorFile& tensors) {
  const TensorReader reader(tensors);
  reader.refuse_unknown({kFields, kResidualFields});
  CompactTables tables;
  tables.axis = reader.axis();
  tables.grid = read_nodes(reader);
  const std::size_t n = tables.axis.size();
  tables.c_d = reader.non_negative("c_d", std::array{n});
  tables.s_sun = reader.non_negative("s_sun", std::array{n});

  tables.octaves_per_code = reader.non_negative("rho_s_octaves_per_code", kOne)[0];
  if (!(tables.octaves_per_code >= kMaxOctaves / 65000 && tables.octaves_per_code <= 1)) {
    reader.fail("rho_s_octaves_per_code", "expected a value in [24/65000, 1]");
  }
  const float max = reader.non_negative("rho_s_max", kOne)[0];
  tables.rho_s =
      LogCodes::from_codes(reader.shorts("rho_s_codes", cells_of(tables.grid)), max, tables.octaves_per_code);
  const auto highest = std::max_element(tables.rho_s.code.begin(), tables.rho_s.code.end());
  if (*highest >= tables.rho_s.level.size()) reader.fail("rho_s_codes", "a code lies beyond the last level");
  if (reader.has("diffuse_shape"))
    tables.diffuse_shape = reader.bytes("diffuse_shape", cells_of(tables.grid));

  read_spectra(reader, tables);
  if (reader.has("residual_basis")) tables.residual = read_residual(reader, tables.grid, n);
  if (reader.has("analytic"))
    tables.analytic = reader.non_negative("analytic", std::array{std::size_t(4), n});
  tables.source_name = reader.optional_text("source_name");
  tables.source_sha256 = reader.optional_text("source_sha256");
  tables.report_json = reader.optional_text("report");
  return tables;
}

TensorFile compact_to_tensors(const CompactTables& tables) {
  const HalfDifferenceGrid& grid = tables.grid;
  const std::size_t n = tables.axis.size();
  TensorFile file;
  file.add(Tensor::from_text("format", kFormat));
  const std::array nodes{float(grid.n_theta_h), float(grid.n_theta_d), float(grid.n_phi_d)};
  file.add(Tensor::from_floats("nodes", {3}, nodes));
  file.add(Tensor::from_text("theta_h_spacing", grid.quadratic_theta_h ? "quadratic" : "uniform"));
  if (!tables.axis.is_rgb()) file.add(Tensor::from_floats("wavelengths", {n}, tables.axis.lambda_nm()));
  file.add(Tensor::from_floats("c_d", {n}, tables.c_d));
  file.add(Tensor::from_floats("s_sun", {n}, tables.s_sun));
  file.add(Tensor::from_floats("rho_s_octaves_per_code", {1}, std::array{tables.octaves_per_code}));
  file.add(Tensor::from_floats("rho_s_max", {1}, std::array{tables.rho_s.level.back()}));
  file.add(pack("rho_s_codes", std::span<const std::uint16_t>(tables.rho_s.code), cells_of(grid)));
  if (!tables.diffuse_shape.empty()) {
    file.add(pack("diffuse_shape", std::span<const std::uint8_t>(tables.diffuse_shape), cells_of(grid)));
  }
  add_spectra(tables, file);
  if (!tables.residual.is_empty()) add_residual(tables.residual, grid, file);
  if (!tables.analytic.empty()) file.add(Tensor::from_floats("analytic", {4, n}, tables.analytic));
  // A container field cannot be empty, so an unknown source is an absent field.
  if (!tables.source_name.empty()) file.add(Tensor::from_text("source_name", tables.source_name));
  if (!tables.source_sha256.empty()) file.add(Tensor::from_text("source_sha256", tables.source_sha256));
  if (!tables.report_json.empty()) file.add(Tensor::from_text("report", tables.report_json));
  return file;
}

}  // namespace spectrace
