// SPDX-License-Identifier: Apache-2.0
// The small solvers of step 3, each against a search that knows nothing of derivatives.
#include "separation/spectral_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "separation/log_root.h"
#include "separation/two_lobe_fit.h"
#include "tests/support/chi_square.h"

namespace spectrace {
namespace {

constexpr double kEpsilon = 1e-3;

struct Samples {
  std::vector<double> y, b;
};

/// One-dimensional problems as eq. 20 poses them: strong, weak and clamped samples.
Samples random_samples(test::TestRandom& random) {
  Samples samples;
  const double scale = std::pow(10.0, -4 * double(random.uniform())), colour = 3 * double(random.uniform());
  for (int j = 0; j < 60; ++j) {
    const double b = scale * double(random.uniform());
    samples.b.push_back(b);
    samples.y.push_back(std::max(colour * b * (0.5 + double(random.uniform())) - 0.1 * scale, 0.0));
  }
  return samples;
}

double cost(const Samples& samples, double s) {
  double sum = 0;
  for (std::size_t j = 0; j < samples.b.size(); ++j) {
    const double r = std::log((samples.y[j] + kEpsilon) / (s * samples.b[j] + kEpsilon));
    sum += r * r;
  }
  return sum;
}

float solve(const Samples& samples, float towards, float prior) {
  Strip start{}, highest{};
  start[0] = towards;
  highest.fill(16);
  LogRoot root(start, 1, prior, float(kEpsilon), highest);
  while (!root.done()) {
    LogRootSums<double> sums;
    for (std::size_t j = 0; j < samples.b.size(); ++j) {
      const double specular = double(root.at()[0]) * samples.b[j], u = specular / (specular + kEpsilon);
      const double r = std::log((samples.y[j] + kEpsilon) / (specular + kEpsilon));
      sums.gradient[0] += r * u;
      sums.slope[0] += r * u * (1 - u) - u * u;
      sums.curvature[0] += u * (1 - u) * (r * (1 - 2 * u) - 3 * u);
      sums.information[0] += u * u;
    }
    root.step(sums);
  }
  return root.result()[0];
}

TEST(FastLog, AgreesWithTheLibraryOverNineDecades) {
  for (double exponent = -20; exponent < 20; exponent += 1e-3) {
    const auto x = static_cast<float>(std::exp(exponent));
    const double exact = std::log(double(x));
    ASSERT_NEAR(double(fast_log(x)), exact, 2e-7 * std::max(1.0, std::abs(exact))) << x;
  }
  EXPECT_EQ(fast_log(1.0F), 0.0F);
}

TEST(FastLog, TheExponentialsKeepTheirBounds) {
  for (float x = -12; x <= 12; x += 1.0F / 512) {
    const double exact = std::exp(double(x));
    ASSERT_NEAR(double(fast_wide_exp(x)) / exact, 1, 1.2e-5) << x;
    if (std::abs(x) <= 2) {
      ASSERT_NEAR(double(fast_exp(x)) / exact, 1, 1e-5) << x;
    }
  }
}

TEST(LogRoot, NoColourIsBetterThanTheOneFound) {
  test::TestRandom random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const Samples samples = random_samples(random);
    const float s = solve(samples, 1, 0);
    const double found = cost(samples, double(s));
    for (double t = -6; t < 3; t += 0.01) {
      // 1e-6 of the cost: the search stops at 1e-5 of ln s, where the cost is flat to its square
      ASSERT_LE(found, cost(samples, std::pow(10.0, t)) * (1 + 1e-6) + 1e-9) << "trial " << trial;
    }
  }
}

TEST(LogRoot, WithoutInformationThePriorDecidesAndWithMuchOfItNothing) {
  const Samples nothing{.y = {0.5, 0.1}, .b = {0, 0}};
  EXPECT_NEAR(solve(nothing, 0.7F, 5), 0.7F, 1e-4F);
  Samples strong;
  for (int j = 1; j <= 180; ++j) {
    strong.b.push_back(0.1 * j);
    strong.y.push_back(0.2 * j);
  }
  EXPECT_NEAR(solve(strong, 0.1F, 5), 2.0F, 2e-3F);
}

TEST(LogRoot, BlackDataGiveExactlyZero) {
  Samples black;
  for (int j = 1; j <= 20; ++j) {
    black.b.push_back(0.1 * j);
    black.y.push_back(0);
  }
  EXPECT_EQ(solve(black, 1, 0), 0.0F);
}

TEST(TwoLobeStep, NoAllowedStepIsBetter) {
  test::TestRandom random(11);
  for (int trial = 0; trial < 500; ++trial) {
    const auto number = [&] { return 2 * double(random.uniform()) - 1; };
    const double a = number(), b = number(), c = number(), d = number();
    const TwoLobeEquations e{.g_d = 3 * number(),
                             .g_s = 3 * number(),
                             .h_dd = a * a + b * b,
                             .h_ds = a * c + b * d,
                             .h_ss = c * c + d * d};
    const double s_d = std::abs(number()), s_s = std::abs(number());
    const auto model = [&](double x, double y) {
      return e.g_d * x + e.g_s * y + (e.h_dd * x * x + 2 * e.h_ds * x * y + e.h_ss * y * y) / 2;
    };
    const std::array<double, 2> step = bounded_step(e, 0, s_d, s_s);
    ASSERT_GE(s_d + step[0], -1e-12);
    ASSERT_GE(s_s + step[1], -1e-12);
    const double found = model(step[0], step[1]);
    for (double x = -s_d; x < 4; x += 0.05) {
      for (double y = -s_s; y < 4; y += 0.05) ASSERT_LE(found, model(x, y) + 1e-9) << trial;
    }
  }
}

}  // namespace
}  // namespace spectrace
