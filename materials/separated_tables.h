// SPDX-License-Identifier: Apache-2.0
// A separated material as data: what separation makes, the `.sep` file holds and the renderer evaluates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "materials/half_difference_grid.h"
#include "materials/residual_table.h"
#include "materials/spectral_axis.h"
#include "materials/tensor_file.h"

namespace spectrace {

/// What the specular lobe's colour depends on, cheapest first: the paper's models, then ours.
enum class SeparationModel : std::uint8_t {
  kSun,          ///< one colour (eq. 4)
  kFresnel,      ///< theta_d (eq. 5)
  kDiffraction,  ///< theta_h and theta_d (eq. 6)
  kResidual,     ///< the same, and what that leaves of X in a few signed terms (ADR 0007)
};
[[nodiscard]] std::string name_of(SeparationModel model);
/// "sun", "fresnel", "diffraction", "residual": in the order of SeparationModel.
inline constexpr std::array<std::string_view, 4> kSeparationModelNames{"sun", "fresnel", "diffraction",
                                                                       "residual"};
/// The inverse of name_of().
[[nodiscard]] std::optional<SeparationModel> separation_model_named(std::string_view name);

/// ρ(wi, wo, λ) = c_d(λ)/π + ρ_s(wi, wo) · s(θh, θd, λ), the first term times `diffuse_shape` where there is
/// one. `rho_s` holds ρ_s · (cosθi + cosθo) = ρ_s · 2 cosθh cosθd, which stays bounded at grazing (ADR 0005);
/// node pairs below the horizon are filled from their nearest neighbour in phi_d, then theta_h.
struct SeparatedTables {
  HalfDifferenceGrid grid;
  SpectralAxis axis;
  std::vector<float> c_d;  ///< [axis], albedo of the Lambert lobe, >= 0
  /// [theta_h][theta_d][phi_d] in [0, 1], or empty: then the diffuse lobe is exactly Lambertian.
  std::vector<float> diffuse_shape;
  std::vector<float> rho_s;          ///< [theta_h][theta_d][phi_d], >= 0 [1/sr]
  std::vector<float> s_sun;          ///< [axis], >= 0
  std::vector<float> s_fresnel;      ///< [theta_d][axis]
  std::vector<float> s_diffraction;  ///< [theta_h][theta_d][axis]
  /// [4][axis]: albedo_d, rho_0, f_0, alpha of the analytic model (AnalyticBrdf); empty where not fitted.
  std::vector<float> analytic;
  ResidualTable residual;   ///< empty where none was fitted
  std::string source_name;  ///< the measured file
  std::string source_sha256;
  std::string report_json;  ///< separation's report
};

/// Throws InputError naming file and field where shapes disagree or values are negative or not finite.
SeparatedTables read_separated(const std::filesystem::path& file);
SeparatedTables separated_from_tensors(const TensorFile& tensors);
TensorFile separated_to_tensors(const SeparatedTables& tables);

}  // namespace spectrace
