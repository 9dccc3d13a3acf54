// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/error.h"
#include "core/math/sampler.h"
#include "core/spectra/color.h"
#include "core/spectra/lane_to_xyz.h"
#include "core/spectra/sampled_wavelengths.h"
#include "tests/support/chi_square.h"

namespace spectrace {
namespace {

const std::vector<WavelengthRange> kRanges{
    {360, 830}, {Float(358.63), Float(1001.89)}, {400, 700}, {550, 551}, {900, 1000}};

std::vector<WavelengthDistribution> all_distributions() {
  std::vector<WavelengthDistribution> all;
  for (const WavelengthRange r : kRanges) {
    all.push_back(WavelengthDistribution::uniform(r));
    all.push_back(WavelengthDistribution::visible(r));
  }
  return all;
}

TEST(Wavelengths, DensityIntegratesToOneAndIsPositiveEverywhere) {
  for (const auto& d : all_distributions()) {
    const int n = 1 << 20;
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      const Float nm = d.range().min_nm + d.range().width_nm() * (Float(i) + Float(0.5)) / n;
      ASSERT_GT(d.pdf_per_nm(nm), 0) << nm;
      sum += double(d.pdf_per_nm(nm)) * double(d.range().width_nm()) / n;
    }
    EXPECT_NEAR(sum, 1, 3e-7);  // midpoint sum over 1024 constant pieces; 4x observed
    EXPECT_EQ(d.pdf_per_nm(d.range().min_nm - 1), 0);
    EXPECT_EQ(d.pdf_per_nm(d.range().max_nm + 1), 0);
    EXPECT_EQ(d.pdf_per_nm(std::nanf("")), 0);
  }
}

TEST(Wavelengths, SamplesLieInTheRangeWithTheirDensity) {
  for (const auto& d : all_distributions()) {
    for (const Float u : {Float(0), Float(1e-7), Float(0.25), Float(0.6), kOneMinusEpsilon, Float(1)}) {
      const SampledWavelengths w = d.sample(u);
      for (int i = 0; i < kLanes; ++i) {
        EXPECT_GE(w.lambda_nm(i), d.range().min_nm);
        EXPECT_LE(w.lambda_nm(i), d.range().max_nm);
        EXPECT_GT(w.pdf_per_nm(i), 0);
        EXPECT_EQ(w.pdf_per_nm(i), d.pdf_per_nm(w.lambda_nm(i)));
      }
    }
  }
}

TEST(Wavelengths, LanesAreRotationsThroughTheInverseDistribution) {
  // F(λ_i) = u + i / kLanes mod 1, with F integrated apart from the code under test.
  const auto d = WavelengthDistribution::visible({});
  const auto cumulative = [&](double nm) {
    double sum = 0;
    const int n = 200000;  // the density jumps 1024 times
    for (int i = 0; i < n; ++i) {
      sum += double(d.pdf_per_nm(static_cast<Float>(360 + (nm - 360) * (i + 0.5) / n))) * (nm - 360) / n;
    }
    return sum;
  };
  for (const Float u : {Float(0.01), Float(0.3), Float(0.77)}) {
    const SampledWavelengths w = d.sample(u);
    for (int i = 0; i < kLanes; ++i) {
      const double expected = std::fmod(double(u) + double(i) / kLanes, 1.0);
      EXPECT_NEAR(cumulative(w.lambda_nm(i)), expected, 2e-6);  // λ is rounded to 6e-5 nm; 3x observed
    }
  }
}

TEST(Wavelengths, EveryLaneHasTheDistributionItsPdfClaims) {
  // Chi-square of each lane over 47 bins of 10 nm; 2 distributions x kLanes trials, together at 0.01.
  for (const auto& d : {WavelengthDistribution::uniform({}), WavelengthDistribution::visible({})}) {
    const int n = 100000;
    std::vector<double> expected(47);
    for (std::size_t bin = 0; bin < 47; ++bin) {
      for (int i = 0; i < 100; ++i) {
        expected[bin] +=
            double(d.pdf_per_nm(static_cast<Float>(360 + 10.0 * double(bin) + (i + 0.5) / 10))) * n / 10;
      }
    }
    for (int lane = 0; lane < kLanes; ++lane) {
      std::vector<double> observed(47);
      for (int i = 0; i < n; ++i) {
        const Float u = Sampler(static_cast<std::uint64_t>(i), 0, 1).vertex(0).bsdf.x;
        observed[std::min<std::size_t>(46, std::size_t((d.sample(u).lambda_nm(lane) - 360) / 10))] += 1;
      }
      double statistic = 0;
      for (std::size_t b = 0; b < 47; ++b) statistic += std::pow(observed[b] - expected[b], 2) / expected[b];
      EXPECT_GT(test::chi_square_p_value(statistic, 46), test::sidak_level(0.01, 2 * kLanes))
          << "lane " << lane;
    }
  }
}

TEST(Wavelengths, EstimatesOfColourAgreeWithQuadrature) {
  // 3 spectra x 2 distributions x (all lanes, hero only) x XYZ = 36 trials, together at 0.01: each at 2.79e-4
  // by Šidák, two-sided, a quantile of 3.635.
  const TabulatedSpectrum line({500, 520, 521, 522, 560}, {0, 0, 10000, 0, 0});  // hard case H7
  for (const Spectrum& s : {Spectrum::constant(1), Spectrum(BlackbodySpectrum{3000, 1}), Spectrum(line)}) {
    const Xyz expected = spectrum_to_xyz(s);
    for (const auto& d : {WavelengthDistribution::uniform({}), WavelengthDistribution::visible({})}) {
      for (const bool hero_only : {false, true}) {
        const int n = 100000;
        Xyz sum{}, squares{};
        for (int i = 0; i < n; ++i) {
          SampledWavelengths w = d.sample(Sampler(static_cast<std::uint64_t>(i), 0, 2).vertex(0).bsdf.x);
          if (hero_only) w.terminate_secondary();
          PathXyz estimate{};
          EXPECT_TRUE(LaneToXyz(w).add(LaneSums() += s.sample(w), estimate));
          for (std::size_t c = 0; c < 3; ++c) {
            sum[c] += estimate[c] / n;
            squares[c] += estimate[c] * estimate[c] / n;
          }
        }
        for (std::size_t c = 0; c < 3; ++c) {
          const double sigma = std::sqrt((squares[c] - sum[c] * sum[c]) / n);
          EXPECT_NEAR(sum[c], expected[c], 3.635 * sigma) << "hero only: " << hero_only << ", channel " << c;
        }
      }
    }
  }
}

TEST(Wavelengths, FewerLanesAreEvenlySpacedAndCarriedByAll) {
  std::array<Float, kLanes> shifts{};
  for (int lane = 0; lane < kLanes; ++lane) shifts[std::size_t(lane)] = Float(lane) / 16;
  for (const WavelengthDistribution& whole : all_distributions()) {
    for (const int lanes : {1, 2, 4, kLanes}) {
      const WavelengthDistribution some = whole.carrying(lanes);
      for (const Float u : {Float(0), Float(0.3), Float(0.99)}) {
        for (const bool shifted : {false, true}) {
          const SampledWavelengths all = shifted ? whole.sample(u, shifts) : whole.sample(u);
          const SampledWavelengths few = shifted ? some.sample(u, shifts) : some.sample(u);
          for (int lane = 0; lane < kLanes; ++lane) {
            const int source = lane % lanes * (kLanes / lanes);
            EXPECT_EQ(few.lambda_nm(lane), all.lambda_nm(source));
            EXPECT_EQ(few.pdf_per_nm(lane), all.pdf_per_nm(source));
          }
        }
      }
    }
  }
  EXPECT_THROW((void)WavelengthDistribution::uniform({}).carrying(3), InternalError);
}

TEST(Wavelengths, TerminationIsIdempotentAndKeepsTheHero) {
  SampledWavelengths w = WavelengthDistribution::visible({}).sample(Float(0.4));
  EXPECT_FALSE(w.secondary_terminated());
  const Float nm = w.lambda_nm(0), pdf = w.pdf_per_nm(0);
  w.terminate_secondary();
  w.terminate_secondary();
  EXPECT_EQ(w.secondary_terminated(), kLanes > 1);
  EXPECT_EQ(w.lambda_nm(0), nm);
  EXPECT_EQ(w.pdf_per_nm(0), pdf / kLanes);
  for (int i = 1; i < kLanes; ++i) EXPECT_EQ(w.pdf_per_nm(i), 0);
}

TEST(Wavelengths, EmptyRangesAreRefused) {
  EXPECT_THROW((void)WavelengthDistribution::uniform({.min_nm = 500, .max_nm = 500}), InternalError);
  EXPECT_THROW((void)WavelengthDistribution::visible({.min_nm = 600, .max_nm = 500}), InternalError);
}

}  // namespace
}  // namespace spectrace
