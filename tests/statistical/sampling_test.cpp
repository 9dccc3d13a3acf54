// SPDX-License-Identifier: Apache-2.0
// Chi-square of every BSDF: do samples fall where the density says, and as many as it integrates to?
#include "tests/statistical/conformance.h"

namespace spectrace::test {
namespace {

class EveryBsdfSampling : public EveryBsdf {};

TEST_P(EveryBsdfSampling, DrawsWhatItsDensitySays) {
  // Two tests, of the shape and of the mass, at each angle of each BSDF: all together at significance 0.01.
  const double level = sidak_level(kFamilyAlpha, 2 * kIncidenceDeg.size() * bsdf_cases().size());
  for (const double theta_deg : kIncidenceDeg) {
    const Vec3 wo = direction(theta_deg, kAzimuthRad);
    SamplingTestOptions options;
    options.seed = seed_of(GetParam().name) + static_cast<std::uint64_t>(theta_deg * 10);
    options.azimuth_zero = direction(90, kAzimuthRad + double(kPi));  // lobes lie opposite to wo
    const SamplingTestResult r = test_sampling(
        [&](TestRandom& random) -> std::optional<Vec3> {
          const std::optional<BsdfSample> s = sample(material(), wo, random_numbers(random), at());
          if (!s) return std::nullopt;
          return s->wi;
        },
        [&](Vec3 wi) { return double(evaluate(material(), wo, wi, at()).pdf); }, options);
    EXPECT_GT(r.p_value, level) << "shape at " << theta_deg << " degrees: " << r.text();
    EXPECT_GT(r.p_value_kept, level) << "mass at " << theta_deg << " degrees: " << r.text();
    // What the mass test forgives stays a tenth of a percent of the mass.
    EXPECT_LT(r.integral_error, 1e-3) << theta_deg << " degrees";
    EXPECT_EQ(r.below_horizon, 0U) << theta_deg << " degrees";
    // The density may lose mass below the horizon, never gain any.
    EXPECT_LE(r.integral, 1 + options.quadrature_tolerance + r.integral_error) << theta_deg << " degrees";
    EXPECT_GT(r.kept, 0.0) << theta_deg << " degrees";
  }
}

INSTANTIATE_TEST_SUITE_P(All, EveryBsdfSampling, ::testing::ValuesIn(bsdf_cases()), case_name);

}  // namespace
}  // namespace spectrace::test
