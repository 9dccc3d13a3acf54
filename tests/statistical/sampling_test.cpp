// SPDX-License-Identifier: Apache-2.0
// Chi-square of every BSDF: do samples fall where the density says, and as many as it integrates to?
#include "tests/statistical/conformance.h"

namespace spectrace::test {
namespace {

/// What the quadrature resolves, of all mass: what the mass test forgives stays a tenth of a percent.
constexpr double kLeastMass = 1e-3;

class EveryBsdfSampling : public EveryBsdf {
 protected:
  /// From one side into the hemisphere of one: samples of the other count as lost.
  [[nodiscard]] SamplingTestResult test_half(double theta_deg, int side, int half) const {
    const Vec3 wo = on_side(direction(theta_deg, kAzimuthRad), side);
    SamplingTestOptions options;
    options.seed = seed_of(GetParam().name) + static_cast<std::uint64_t>(theta_deg * 10);
    if (keeps_sides(material())) options.samples /= 4;                // of each pair of sides: as many in all
    options.azimuth_zero = direction(90, kAzimuthRad + double(kPi));  // lobes lie opposite to wo
    return test_sampling(
        [&](TestRandom& random) -> std::optional<Vec3> {
          const std::optional<BsdfSample> s = sample(material(), wo, random_numbers(random), at());
          if (!s || s->is_delta) return std::nullopt;
          const bool other_half = keeps_sides(material()) && s->wi.z * Float(half) < 0;
          if (other_half) return std::nullopt;
          return on_side(s->wi, half);
        },
        [&](Vec3 wi) { return double(evaluate(material(), wo, on_side(wi, half), at()).pdf); }, options);
  }
};

TEST_P(EveryBsdfSampling, DrawsWhatItsDensitySays) {
  // Two tests, of the shape and of the mass, at each angle of each BSDF: all together at significance 0.01.
  // Those that light passes are tested from both sides into both.
  std::size_t trials = 0;
  for (const BsdfCase& c : bsdf_cases()) trials += 2 * kIncidenceDeg.size() * (c.is_two_sided ? 4 : 1);
  const double level = sidak_level(kFamilyAlpha, trials);
  for (const int side : sides()) {
    for (const double theta_deg : kIncidenceDeg) {
      double kept = 0, integral = 0;
      for (const int half : sides()) {
        const SamplingTestResult r = test_half(theta_deg, side, half);
        const std::string where = std::to_string(theta_deg) + " degrees, from " + std::to_string(side) +
                                  " to " + std::to_string(half);
        EXPECT_GT(r.p_value, level) << "shape at " << where << ": " << r.text();
        if (r.kept > kLeastMass) {
          EXPECT_GT(r.p_value_kept, level) << "mass at " << where << ": " << r.text();
        } else {  // a sliver that too few pilots have shown to the quadrature
          EXPECT_NEAR(r.integral, r.kept, kLeastMass) << "mass at " << where << ": " << r.text();
        }
        EXPECT_LT(r.integral_error, kLeastMass) << where;
        EXPECT_EQ(r.below_horizon, 0U) << where;
        kept += r.kept;
        integral += r.integral - r.integral_error;
      }
      // The density may lose mass, never gain any.
      EXPECT_LE(integral, 1 + SamplingTestOptions{}.quadrature_tolerance) << theta_deg << " degrees";
      EXPECT_GT(kept, 0.0) << theta_deg << " degrees";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryBsdfSampling, ::testing::ValuesIn(bsdf_cases()), case_name);

}  // namespace
}  // namespace spectrace::test
