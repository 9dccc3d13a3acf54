// SPDX-License-Identifier: Apache-2.0
// What the tests over every BSDF share.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "core/math/math.h"
#include "tests/statistical/bsdf_registry.h"
#include "tests/support/chi_square.h"

namespace spectrace::test {

/// Incidence of wo [degrees], from the normal to where single precision and tables are worst.
inline constexpr std::array<double, 5> kIncidenceDeg{0, 60, 79, 85, 89.9};
inline constexpr double kFamilyAlpha = 0.01;  ///< significance of the suite as a whole

/// Off every axis and table node.
inline constexpr double kAzimuthRad = 0.7;

inline Vec3 direction(double theta_deg, double phi_rad) {
  const double theta = theta_deg * double(kPi) / 180;
  return {Float(std::sin(theta) * std::cos(phi_rad)), Float(std::sin(theta) * std::sin(phi_rad)),
          Float(std::cos(theta))};
}

/// Mirrored below the horizon where `side` is -1.
inline Vec3 on_side(Vec3 w, int side) { return {w.x, w.y, Float(side) * w.z}; }

inline BsdfRandom random_numbers(TestRandom& random) {
  const Float lobe = random.uniform();
  return {lobe, random.uniform2()};
}

/// Over the hemisphere, denser near the horizon than a cosine would be.
inline Vec3 random_direction(TestRandom& random) {
  const Vec2 u = random.uniform2();
  const double z = 1 - double(u.x), r = std::sqrt(1 - z * z), phi = 2 * double(kPi) * u.y;
  return {Float(r * std::cos(phi)), Float(r * std::sin(phi)), Float(z)};
}

/// The same on every platform, different for each name.
inline std::uint64_t seed_of(const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

class EveryBsdf : public ::testing::TestWithParam<BsdfCase> {
 protected:
  void SetUp() override {
    material_ = GetParam().make();
    if (!material_) GTEST_SKIP() << GetParam().name << " needs the shared data (set SPECTRACE_DATA)";
    ASSERT_EQ(keeps_sides(*material_), GetParam().is_two_sided);
  }
  [[nodiscard]] const Material& material() const { return *material_; }
  [[nodiscard]] ShadingPoint at() const { return {.lambda = test_wavelengths()}; }
  /// The sides it is asked from: 1 above, -1 below.
  [[nodiscard]] std::vector<int> sides() const {
    return keeps_sides(material()) ? std::vector{1, -1} : std::vector{1};
  }
  /// On either side where it tells them apart.
  [[nodiscard]] Vec3 random_side(Vec3 w, TestRandom& random) const {
    return keeps_sides(material()) && random.uniform() < Float(0.5) ? on_side(w, -1) : w;
  }
  /// Radiance over the square of the index is what an interface conserves (Veach 1997, sec. 5.2).
  [[nodiscard]] double index_squared(Vec3 w, int lane) const {
    return w.z < 0 ? sqr(double(GetParam().interior_eta.at(test_wavelengths().lambda_nm(lane)))) : 1;
  }

 private:
  std::optional<Material> material_;
};

inline std::string case_name(const ::testing::TestParamInfo<BsdfCase>& info) { return info.param.name; }

}  // namespace spectrace::test
