// SPDX-License-Identifier: Apache-2.0
// A separated material as data: what separation makes, the `.sep` file holds and the renderer evaluates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "materials/half_difference_grid.h"
#include "materials/spectral_axis.h"
#include "materials/tensor_file.h"

namespace spectrace {

/// The specular models of the paper, cheapest first.
enum class SeparationModel : std::uint8_t { kSun, kFresnel, kDiffraction };
[[nodiscard]] std::string name_of(SeparationModel model);  ///< "sun", "fresnel", "diffraction"

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
  std::string source_name;           ///< the measured file
  std::string source_sha256;
  std::string report_json;  ///< separation's report
};

/// Throws InputError naming file and field where shapes disagree or values are negative or not finite.
SeparatedTables read_separated(const std::filesystem::path& file);
SeparatedTables separated_from_tensors(const TensorFile& tensors);
TensorFile separated_to_tensors(const SeparatedTables& tables);

}  // namespace spectrace
