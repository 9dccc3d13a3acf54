// SPDX-License-Identifier: Apache-2.0
// A coated base: what the conformance suite cannot ask of it.
#include "materials/plastic.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/math/math.h"
#include "materials/fresnel.h"
#include "materials/lambert.h"
#include "tests/support/chi_square.h"
#include "tests/support/shading_point.h"

namespace spectrace {
namespace {

using test::kAt;

Vec3 at_cosine(double cosine) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {Float(0.6 * sine), Float(-0.8 * sine), Float(cosine)};
}

/// Albedo of the coat, by a finer sum over facets than the table's.
double facet_albedo(Float alpha, Float eta, double cosine) {
  if (alpha == 0) return double(fresnel_dielectric(Float(cosine), eta));
  constexpr int kFacets = 512;
  const Ggx ggx{alpha, alpha};
  double sum = 0;
  for (int i = 0; i < kFacets; ++i) {
    for (int j = 0; j < kFacets; ++j) {
      const double v = (j + 0.5) / kFacets;
      const Vec2 u{(Float(i) + Float(0.5)) / kFacets, Float(v)};
      const Ggx::Reflection r = ggx.reflect(at_cosine(cosine), ggx.sample(at_cosine(cosine), u));
      if (r.pdf > 0) sum += double(fresnel_dielectric(r.cos_half, eta) * r.value_cos) / double(r.pdf);
    }
  }
  return sum / sqr(double(kFacets));
}

/// Albedo of the diffuse lobe, which knows no azimuth: midpoints in the square root of the cosine.
double diffuse_albedo(const Plastic& plastic, double cosine) {
  constexpr int kSteps = 4096;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps;
    sum +=
        double(plastic.evaluate_lobes(at_cosine(cosine), at_cosine(t * t), kAt).diffuse[0]) * 2 * t / kSteps;
  }
  return sum * 2 * kPi64;
}

/// Fresnel's mean over the hemisphere, by midpoints: no code in common with the table.
double mean_fresnel(double eta) {
  constexpr int kSteps = 200'000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double c = (i + 0.5) / kSteps, t = std::sqrt(1 - (1 - c * c) / (eta * eta));
    const double s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
    sum += (s * s + p * p) / 2 * 2 * c / kSteps;
  }
  return sum;
}

TEST(CoatAlbedo, OfAMirrorIsFresnels) {
  const CoatAlbedo mirror(0, Float(1.5), Float(1.5));
  for (const double c : {0.01, 0.3, 0.7, 1.0}) {
    EXPECT_EQ(mirror.at(Float(c), Float(1.5)), fresnel_dielectric(Float(c), Float(1.5)));
  }
  // 0.0918 from outside; from within 1 - (1 - 0.0918) / 1.5² = 0.596: what Saunderson (1942) calls k2.
  EXPECT_NEAR(mirror.average(Float(1.5)), mean_fresnel(1.5), 1e-6);
  EXPECT_NEAR(1 - (1 - mirror.average(Float(1.5))) / sqr(1.5), 0.596, 5e-4);
}

/// What the table is good for, measured: 2e-4, and within four degrees of the horizon, where narrow lobes
/// fall behind it, 1e-3.
double table_error(double cosine) { return cosine < 0.07 ? 1e-3 : 2e-4; }

TEST(CoatAlbedo, IsThatOfTheFacets) {
  // At cosines and an index between the table's nodes.
  for (const Float alpha : {kMinAlpha, Float(0.05), Float(0.3), Float(1)}) {
    const CoatAlbedo table(alpha, Float(1.45), Float(1.55));
    for (const double c : {0.003, 0.051, 0.23, 0.77}) {
      EXPECT_NEAR(table.at(Float(c), Float(1.493)), facet_albedo(alpha, Float(1.493), c), table_error(c))
          << alpha << " " << c;
    }
  }
}

TEST(Plastic, AWhiteBaseSendsBackAllThatArrives) {
  for (const Float alpha : {Float(0), kMinAlpha, Float(0.1), Float(0.4), Float(1)}) {
    const Plastic white(Spectrum::constant(1), Spectrum::constant(Float(1.5)), alpha);
    for (const double c : {0.003, 0.05, 0.3, 0.7, 1.0}) {
      const double all = facet_albedo(alpha, Float(1.5), c) + diffuse_albedo(white, c);
      EXPECT_NEAR(all, 1, table_error(c)) << alpha << " " << c;
    }
  }
}

TEST(Plastic, SmoothIsTheClassicalCoat) {
  const double eta = 1.5, rho = 0.6;
  const Plastic plastic(Spectrum::constant(Float(rho)), Spectrum::constant(Float(eta)), 0);
  const double within = 1 - (1 - mean_fresnel(eta)) / (eta * eta);
  const double cos_o = 0.8, cos_i = 0.45;
  const double t_o = 1 - fresnel_dielectric(Float(cos_o), Float(eta)),
               t_i = 1 - fresnel_dielectric(Float(cos_i), Float(eta));
  const double expected = t_o * t_i / (eta * eta) * rho / (1 - rho * within) / kPi64 * cos_i;
  const BsdfValue v = plastic.evaluate(at_cosine(cos_o), at_cosine(cos_i), kAt);
  EXPECT_NEAR(v.value_cos[0] / expected, 1, 1e-5);
  EXPECT_EQ(plastic.evaluate_lobes(at_cosine(cos_o), at_cosine(cos_i), kAt).diffuse, v.value_cos);
  const auto mirror = plastic.sample(at_cosine(cos_o), {}, kAt);
  ASSERT_TRUE(mirror && mirror->is_delta);
  EXPECT_NEAR(mirror->weight[0] * mirror->pdf, 1 - t_o, 1e-6);
}

TEST(Plastic, BouncesBetweenBaseAndCoatDeepenColours) {
  // The ratio of two reflectances grows: rho / (1 - rho F) is convex.
  const Plastic plastic(Spectrum(TabulatedSpectrum({420, 500}, {Float(0.8), Float(0.4)})),
                        Spectrum::constant(Float(1.5)), 0);
  const BsdfValue v = plastic.evaluate(at_cosine(0.7), at_cosine(0.7), kAt);
  EXPECT_GT(v.value_cos[0] / v.value_cos[1], 2.5);
}

TEST(Plastic, WithoutACoatIsItsBase) {
  const Spectrum base = TabulatedSpectrum({400, 700}, {Float(0.2), Float(0.9)});
  const Lambert lambert{base};
  for (const Float alpha : {Float(0), Float(0.3)}) {
    const Plastic plastic(base, Spectrum::constant(1), alpha);
    for (const double c : {0.1, 0.5, 1.0}) {
      const BsdfValue a = plastic.evaluate(at_cosine(0.4), at_cosine(c), kAt),
                      b = lambert.evaluate(at_cosine(0.4), at_cosine(c), kAt);
      EXPECT_NEAR(a.pdf, b.pdf, 1e-6);
      for (int i = 0; i < kLanes; ++i) EXPECT_NEAR(a.value_cos[i], b.value_cos[i], 1e-6);
    }
  }
}

}  // namespace
}  // namespace spectrace
