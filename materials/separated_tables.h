// SPDX-License-Identifier: Apache-2.0
// A separated material as data: what separation makes, the `.sep` file holds and the renderer evaluates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "materials/half_difference.h"
#include "materials/spectral_axis.h"
#include "materials/tensor_file.h"

namespace spectrace {

/// Where a direction pair falls in the grid: the one mapping all lookups use. Weights sum to 1.
struct GridPoint {
  std::array<std::uint32_t, 8> cell{};  ///< trilinear, index into [theta_h][theta_d][phi_d]
  std::array<float, 8> cell_weight{};
  std::array<std::uint32_t, 4> angular{};  ///< bilinear, index into [theta_h][theta_d]
  std::array<float, 4> angular_weight{};
  std::array<std::uint32_t, 2> theta_d{};  ///< linear
  std::array<float, 2> theta_d_weight{};
};

/// The table X and everything on its grid: [theta_h][theta_d][phi_d], nodes at theta_h(i) (paper: 90 of
/// them), theta_d = j · 90°/n_d, phi_d = k · 180°/n_p with wrap-around.
struct HalfDifferenceGrid {
  int n_theta_h = 90, n_theta_d = 90, n_phi_d = 180;
  bool quadratic_theta_h = true;  ///< theta_h = (i/n)² 90° as in MERL; otherwise i/n · 90°

  [[nodiscard]] std::size_t size() const { return std::size_t(n_theta_h) * n_theta_d * n_phi_d; }
  [[nodiscard]] std::size_t angular_size() const { return std::size_t(n_theta_h) * n_theta_d; }
  [[nodiscard]] std::size_t index(int h, int d, int p) const {
    return (std::size_t(h) * n_theta_d + d) * n_phi_d + p;
  }
  [[nodiscard]] double theta_h(double i) const;  ///< [rad] of a (fractional) node
  [[nodiscard]] double theta_d(double j) const;
  [[nodiscard]] double phi_d(double k) const;
  [[nodiscard]] double coordinate_h(double theta_h_rad) const;  ///< the inverses, clamped to the grid
  [[nodiscard]] double coordinate_d(double theta_d_rad) const;
  [[nodiscard]] double coordinate_p(double phi_d_rad) const;  ///< in [0, n_phi_d)
  [[nodiscard]] GridPoint locate(const HalfDifference& angles) const;
};

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
