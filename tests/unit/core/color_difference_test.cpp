// SPDX-License-Identifier: Apache-2.0
// CIEDE2000 against the pairs that Sharma, Wu and Dalal (2005) publish in table 1: all kinds of its case
// distinctions.
#include "core/spectra/color_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/spectra/color.h"

namespace spectrace {
namespace {

struct Pair {
  Xyz a, b;
  double difference;
};

TEST(ColorDifference, HasThePublishedValues) {
  const std::vector<Pair> pairs{{{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
                                {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
                                {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
                                {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
                                {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
                                {{50, 0, 0}, {50, -1, 2}, 2.3669},
                                {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
                                {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
                                {{50, -0.0010, 2.4900}, {50, 0.0009, -2.4900}, 4.8045},
                                {{50, -0.0010, 2.4900}, {50, 0.0011, -2.4900}, 4.7461},
                                {{50, 2.5, 0}, {50, 0, -2.5}, 4.3065},
                                {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
                                {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
                                {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
                                {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
                                {{50, 2.5, 0}, {50, 3.1736, 0.5854}, 1.0000},
                                {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
                                {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
                                {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082}};
  for (const Pair& pair : pairs) {
    EXPECT_NEAR(ciede2000(pair.a, pair.b), pair.difference, 5e-5);
    EXPECT_NEAR(ciede2000(pair.b, pair.a), pair.difference, 5e-5);
    EXPECT_EQ(ciede2000(pair.a, pair.a), 0);
  }
}

TEST(ColorDifference, OfGreysIsThatOfTheirLightness) {
  const Xyz white = rgb_to_xyz({1, 1, 1});
  const Xyz grey = xyz_to_lab(rgb_to_xyz({0.18, 0.18, 0.18}), white);
  EXPECT_NEAR(grey[0], 116 * std::cbrt(0.18) - 16, 1e-9);
  EXPECT_NEAR(grey[1], 0, 1e-9);
  EXPECT_NEAR(grey[2], 0, 1e-9);
  // S_L is 1 at L* = 50 (eq. 15).
  EXPECT_NEAR(ciede2000({49.5, 0, 0}, {50.5, 0, 0}), 1, 1e-12);
}

}  // namespace
}  // namespace spectrace
