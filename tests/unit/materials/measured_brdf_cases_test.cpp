// SPDX-License-Identifier: Apache-2.0
// The measured BRDF where tables end, are empty or are folded by symmetry; its agreement with the reference
// is tested in measured_brdf_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "core/math/math.h"
#include "materials/measured_brdf.h"
#include "tests/support/chi_square.h"
#include "tests/support/synthetic_measured.h"
#include "tests/support/test_data.h"

namespace spectrace {
namespace {

using test::make_measured;
using test::SyntheticMeasured;

const SampledWavelengths kLambda({450, 550, 610, 690, 400, 500, 580, 650}, {1, 1, 1, 1, 1, 1, 1, 1});
const ShadingPoint kPoint{kLambda};
static_assert(kLanes == 8);

Vec3 direction(double theta, double phi) {
  return {Float(std::sin(theta) * std::cos(phi)), Float(std::sin(theta) * std::sin(phi)),
          Float(std::cos(theta))};
}

double degrees(double x) { return x * kPi64 / 180; }

/// Numbers and uniform directions, the same on every run.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double unit() { return unit_(random_); }
  Vec3 hemisphere() { return direction(std::acos(1 - unit()), 2 * kPi64 * unit()); }
  BsdfRandom numbers() { return {Float(unit()), {Float(unit()), Float(unit())}}; }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<double> unit_{0, 1};
};

struct Estimate {
  double mean = 0, error = 0;  ///< with its standard error
};

template <typename Sample>
Estimate estimate(int count, const Sample& sample) {
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    const double x = sample();
    sum += x;
    squares += x * x;
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean) / count)};
}

/// ∫ f cos dωi of one lane, by sample() and by uniform directions into evaluate().
Estimate albedo_by_sampling(const MeasuredBrdf& brdf, Vec3 wo, int lane, int count) {
  Draw draw(21);
  return estimate(count, [&] {
    const auto s = brdf.sample(wo, draw.numbers(), kPoint);
    return s ? double(s->weight[lane]) : 0.0;
  });
}
Estimate albedo_by_evaluation(const MeasuredBrdf& brdf, Vec3 wo, int lane, int count) {
  Draw draw(22);
  return estimate(count, [&] {
    return 2 * kPi64 * double(brdf.evaluate(wo, draw.hemisphere(), kPoint).value_cos[lane]);
  });
}

void expect_equal_estimates(const Estimate& a, const Estimate& b) {
  // Fixed seeds; 4 standard errors are passed by chance 6e-5 of the time, were they not fixed.
  EXPECT_NEAR(a.mean, b.mean, 4 * std::hypot(a.error, b.error));
}

TEST(MeasuredBrdf, TableOfASymmetricMaterialMayBeStoredInPart) {
  struct Case {
    int symmetry, stored;
    double first_phi_i;
  };
  for (const Case& c : {Case{2, 2, -kPi64}, Case{2, 2, 0}, Case{2, 2, kPi64 / 4}, Case{4, 2, -kPi64},
                        Case{4, 4, -kPi64}, Case{4, 4, 0}, Case{4, 4, kPi64 / 2}}) {
    const SyntheticMeasured whole{.isotropic = false, .symmetry = c.symmetry};
    const SyntheticMeasured part{.isotropic = false,
                                 .symmetry = c.symmetry,
                                 .stored_reduction = c.stored,
                                 .first_phi_i = c.first_phi_i};
    const MeasuredBrdf a(make_measured(whole)), b(make_measured(part));
    ASSERT_EQ(b.tables().symmetry_reduction(), c.stored);
    Draw draw(3);
    for (int i = 0; i < 5000; ++i) {
      const Vec3 wo = draw.hemisphere(), wi = draw.hemisphere();
      const BsdfValue va = a.evaluate(wo, wi, kPoint), vb = b.evaluate(wo, wi, kPoint);
      // Single precision at azimuths that differ: 1e-4 of the value, or of one that is not near 0.
      EXPECT_NEAR(va.value_cos[0], vb.value_cos[0], 1e-4 * std::max(va.value_cos[0], Float(0.01)));
      EXPECT_NEAR(va.pdf, vb.pdf, 1e-4 * std::max(va.pdf, Float(0.01)));
    }
  }
}

TEST(MeasuredBrdf, FootprintSumsToTheValue) {
  for (const bool rgb : {false, true}) {
    const MeasuredBrdf brdf(make_measured({.isotropic = false, .rgb = rgb}));
    const SpectralAxis::Lookup lookup = brdf.axis().lookup(kLambda);
    EXPECT_TRUE(brdf.tables().spectra.empty());
    Draw draw(4);
    for (int i = 0; i < 2000; ++i) {
      const Vec3 wo = draw.hemisphere(), wi = draw.hemisphere();
      const auto footprint = brdf.footprint(wo, wi);
      ASSERT_TRUE(footprint);
      ASSERT_LE(footprint->count, MeasuredBrdf::Footprint::kMaxNodes);
      SampledSpectrum sum;
      for (int k = 0; k < footprint->count; ++k) {
        sum += lookup.apply(brdf.spectrum(footprint->row[k])) * Float(footprint->weight[k]);
      }
      const SampledSpectrum value = brdf.evaluate(wo, wi, kPoint).value_cos;
      const LobeValues lobes = brdf.evaluate_lobes(wo, wi, kPoint);
      for (int lane = 0; lane < kLanes; ++lane) EXPECT_NEAR(sum[lane], value[lane], 1e-6 * value[lane]);
      EXPECT_EQ(lobes.fresnel, value);
      EXPECT_EQ(lobes.total(), value);
    }
  }
}

TEST(MeasuredBrdf, FootprintTellsWhatWasMeasured) {
  MeasuredTables tables = make_measured({});
  const Vec3 wi = direction(0.4, 2.0), inside = direction(1.29, 0), beyond = direction(1.31, 0);
  const MeasuredBrdf brdf(tables);
  EXPECT_FALSE(brdf.footprint(inside, wi)->extrapolated);
  EXPECT_TRUE(brdf.footprint(inside, wi)->measured);
  EXPECT_TRUE(brdf.footprint(beyond, wi)->extrapolated);
  EXPECT_FALSE(brdf.footprint(beyond, wi)->measured);
  tables.valid.clear();  // a file that does not say
  EXPECT_TRUE(MeasuredBrdf(tables).footprint(inside, wi)->measured);
  tables.valid.assign(tables.luminance.size(), 0);
  EXPECT_FALSE(MeasuredBrdf(tables).footprint(inside, wi)->measured);
}

TEST(MeasuredBrdf, GrazingIsFiniteAndBelowTheHorizonIsNothing) {  // hard cases H1, H3, H4
  const MeasuredBrdf brdf(make_measured({}));
  for (const double theta : {89.9, 89.99, 89.9999}) {
    for (const double other : {0.0, 45.0, 89.99}) {
      const Vec3 wo = direction(degrees(theta), 0.3), wi = direction(degrees(other), 2.5);
      for (const BsdfValue& v : {brdf.evaluate(wo, wi, kPoint), brdf.evaluate(wi, wo, kPoint)}) {
        EXPECT_TRUE(v.value_cos.is_finite() && v.value_cos.min() >= 0);
        EXPECT_TRUE(std::isfinite(v.pdf) && v.pdf >= 0);
      }
    }
  }
  const Vec3 above = direction(0.5, 0), level{1, 0, 0}, below = direction(degrees(90.01), 1);
  for (const Vec3& dark : {level, below, -above}) {
    for (const auto& [wo, wi] : {std::pair(above, dark), std::pair(dark, above), std::pair(dark, -dark)}) {
      const BsdfValue v = brdf.evaluate(wo, wi, kPoint);
      EXPECT_TRUE(v.value_cos.is_zero());
      EXPECT_EQ(v.pdf, 0);
      EXPECT_FALSE(brdf.footprint(wo, wi));
    }
    EXPECT_FALSE(brdf.sample(dark, {Float(0.5), {Float(0.5), Float(0.5)}}, kPoint));
  }
}

TEST(MeasuredBrdf, HalfVectorAtTheNormalHasNoAzimuth) {  // hard case H5
  const MeasuredBrdf brdf(make_measured({}));
  const auto mirror_value = [&](double phi) {
    const Vec3 wo = direction(0.6, phi);
    return brdf.evaluate(wo, {-wo.x, -wo.y, wo.z}, kPoint);
  };
  const BsdfValue first = mirror_value(0);
  EXPECT_GT(first.value_cos[0], 0);
  for (double phi = 0.1; phi < 6.2; phi += 0.1) {
    const BsdfValue v = mirror_value(phi);
    for (int lane = 0; lane < kLanes; ++lane) {
      EXPECT_NEAR(v.value_cos[lane], first.value_cos[lane], 1e-5 * first.value_cos[lane]);
    }
    EXPECT_TRUE(std::isfinite(v.pdf));
  }
}

TEST(MeasuredBrdf, IsotropicValuesDoNotTurn) {
  const MeasuredBrdf brdf(make_measured({}));
  Draw draw(8);
  for (int i = 0; i < 2000; ++i) {
    const double to = 1.4 * draw.unit(), ti = 1.4 * draw.unit(), phi = 6 * draw.unit(),
                 turn = 6 * draw.unit();
    const BsdfValue a = brdf.evaluate(direction(to, 0), direction(ti, phi), kPoint);
    const BsdfValue b = brdf.evaluate(direction(to, turn), direction(ti, phi + turn), kPoint);
    EXPECT_NEAR(a.value_cos[1], b.value_cos[1], 2e-5 * std::max(a.value_cos[1], Float(0.01)));
  }
}

TEST(MeasuredBrdf, EndsOfTheUnitIntervalGiveDirectionsOrNothing) {  // hard case H6
  const std::array<Float, 5> ends{0, std::numeric_limits<Float>::denorm_min(), Float(0.5), kOneMinusEpsilon,
                                  1};
  for (const auto& options : {SyntheticMeasured{}, SyntheticMeasured{.isotropic = false}}) {
    const MeasuredBrdf brdf(make_measured(options));
    for (const double theta : {0.0, 0.7, 1.5, 1.5707}) {
      for (const Float x : ends) {
        for (const Float y : ends) {
          const auto s = brdf.sample(direction(theta, 1), {Float(0.5), {x, y}}, kPoint);
          if (!s) continue;
          EXPECT_GT(s->wi.z, 0);
          EXPECT_NEAR(length(s->wi), 1, 1e-5);
          EXPECT_GT(s->pdf, 0);
          EXPECT_TRUE(std::isfinite(s->pdf) && s->weight.is_finite() && s->weight.min() >= 0);
        }
      }
    }
  }
}

TEST(MeasuredBrdf, ZerosOfTheTablesDivideNothing) {  // hard case H2
  MeasuredTables tables = make_measured({});
  std::fill(tables.sigma.begin(), tables.sigma.end(), 0.0f);
  std::fill(tables.luminance.begin(), tables.luminance.end(), 0.0f);
  std::fill_n(tables.vndf.begin(), tables.vndf.size() / 2, 0.0f);
  const MeasuredBrdf brdf(tables);
  Draw draw(9);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 wo = draw.hemisphere();
    const BsdfValue v = brdf.evaluate(wo, draw.hemisphere(), kPoint);
    EXPECT_TRUE(v.value_cos.is_zero());
    EXPECT_TRUE(std::isfinite(v.pdf));
    const auto s = brdf.sample(wo, draw.numbers(), kPoint);
    if (s) {
      EXPECT_TRUE(s->weight.is_zero());
    }
  }
}

TEST(MeasuredBrdf, SamplingAndEvaluationReflectTheSameEnergy) {
  for (const auto& options : {SyntheticMeasured{}, SyntheticMeasured{.isotropic = false, .rgb = true},
                              SyntheticMeasured{.isotropic = false, .symmetry = 4, .stored_reduction = 4}}) {
    const MeasuredBrdf brdf(make_measured(options));
    for (const double theta : {0.1, 0.8, 1.4}) {
      const Vec3 wo = direction(theta, 2.2);
      const Estimate a = albedo_by_sampling(brdf, wo, 2, 100000);
      const Estimate b = albedo_by_evaluation(brdf, wo, 2, 100000);
      expect_equal_estimates(a, b);
    }
  }
}

TEST(MeasuredBrdf, LightTheEyeDoesNotSeeIsSampled) {  // hard case H7
  MeasuredTables tables = make_measured({});
  const std::size_t cells = std::size_t(tables.table_size) * tables.table_size;
  // One wavelength of seven has all the energy, and the luminance knows nothing of it.
  for (std::size_t i = 0; i < tables.spectra.size(); ++i) {
    tables.spectra[i] = (i / cells) % tables.axis.size() == 6 ? 1e4f * tables.spectra[i] : 0.0f;
  }
  for (std::size_t i = 0; i < tables.luminance.size(); ++i) {
    if (i % cells < cells / 2) tables.luminance[i] = 0;
  }
  const MeasuredBrdf brdf(tables);
  const Vec3 wo = direction(0.8, 0);
  const Estimate a = albedo_by_sampling(brdf, wo, 3, 100000), b = albedo_by_evaluation(brdf, wo, 3, 100000);
  EXPECT_GT(a.mean, 100);
  expect_equal_estimates(a, b);
}

TEST(MeasuredBrdf, SamplesFollowTheirDensity) {
  const std::array layouts{SyntheticMeasured{}, SyntheticMeasured{.isotropic = false},
                           SyntheticMeasured{.isotropic = false, .symmetry = 2, .stored_reduction = 2},
                           SyntheticMeasured{.isotropic = false, .symmetry = 4, .stored_reduction = 4}};
  const std::array azimuths{0.4, 2.5};  // inside and outside the stored range
  const double level = test::sidak_level(0.01, 2 * layouts.size() * azimuths.size());
  for (const SyntheticMeasured& layout : layouts) {
    const MeasuredBrdf brdf(make_measured(layout));
    for (const double phi : azimuths) {
      const Vec3 wo = direction(0.9, phi);
      const auto result = test::test_sampling(
          [&](test::TestRandom& random) -> std::optional<Vec3> {
            const auto s = brdf.sample(wo, {random.uniform(), random.uniform2()}, kPoint);
            if (!s) return std::nullopt;
            return s->wi;
          },
          [&](Vec3 wi) { return double(brdf.evaluate(wo, wi, kPoint).pdf); },
          {.samples = 100000, .pilots = 20000});
      EXPECT_GT(result.p_value, level) << result.text();
      EXPECT_GT(result.p_value_kept, level) << result.text();
      EXPECT_EQ(result.below_horizon, 0u);
    }
  }
}

TEST(MeasuredBrdf, WhitePaperIsWhiteAndRough) {
  const auto file = test::data_folder() / "epfl_uplifted/paper_white_spec.bsdf";
  SPECTRACE_SKIP_WITHOUT(file);
  const MeasuredBrdf brdf(read_measured(file));
  for (const double theta : {0.0, 30.0, 60.0, 75.0}) {
    const Vec3 wo = direction(degrees(theta), 1);
    const Estimate a = albedo_by_sampling(brdf, wo, 1, 20000), b = albedo_by_evaluation(brdf, wo, 1, 20000);
    expect_equal_estimates(a, b);
    EXPECT_GT(a.mean, 0.7);
    EXPECT_LT(a.mean, 1.0);
    // Away from the mirror direction it reflects like a Lambert surface of its albedo.
    const Vec3 wi = direction(degrees(30), 1);
    const double f = brdf.evaluate(wo, wi, kPoint).value_cos[1] / wi.z;
    EXPECT_NEAR(f * kPi64, a.mean, 0.2 * a.mean) << theta;
  }
}

}  // namespace
}  // namespace spectrace
