// SPDX-License-Identifier: Apache-2.0
// Maps of the unit square and of pairs of directions, and their inverses.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/math/concentric_disk.h"
#include "core/math/warp2d.h"
#include "materials/half_difference.h"

namespace spectrace::test {
namespace {

/// In [0, 1], both ends among them.
rc::Gen<double> unit() {
  return rc::gen::map(rc::gen::inRange(0, (1 << 24) + 1), [](int i) { return double(i) / (1 << 24); });
}

RC_GTEST_PROP(ConcentricDisk, KeepsDistancesFromTheMiddle, ()) {
  const Vec2 u{Float(*unit()), Float(*unit())};
  const Vec2 disk = concentric_disk(u);
  const double radius = std::max(std::abs(2 * double(u.x) - 1), std::abs(2 * double(u.y) - 1));
  // Single precision of a cosine.
  RC_ASSERT(std::abs(std::hypot(double(disk.x), double(disk.y)) - radius) <= 1e-6);
}

RC_GTEST_PROP(Warp, IsUndoneByItsInverse, ()) {
  const int width = *rc::gen::inRange(2, 7), height = *rc::gen::inRange(2, 7);
  // Positive everywhere: where the density is 0 all u between two places go to one.
  const auto data = *rc::gen::container<std::vector<Float>>(
      std::size_t(width * height),
      rc::gen::map(rc::gen::inRange(1, 1000), [](int i) { return Float(i) / 100; }));
  const std::vector<Float> none{0};
  const Warp2D warp(none, none, width, height, data, true);
  const UnitPoint u{*unit(), *unit()};
  const Warp2D::Sample drawn = warp.sample(u);
  RC_ASSERT(drawn.position.x >= 0 && drawn.position.x <= 1 && drawn.position.y >= 0 && drawn.position.y <= 1);
  RC_ASSERT(drawn.pdf > 0);
  RC_ASSERT(std::abs(warp.eval(drawn.position) - drawn.pdf) <= Float(1e-5) * drawn.pdf);
  const Warp2D::Sample back = warp.invert(drawn.position);
  // Densities within a factor of 1,000: so much more than the position can u be off.
  RC_ASSERT(std::abs(back.position.x - u.x) <= 1e-6);
  RC_ASSERT(std::abs(back.position.y - u.y) <= 1e-6);
}

RC_GTEST_PROP(HalfDifferenceAngles, ComeBackFromTheirDirections, ()) {
  HalfDifference angles;
  angles.theta_h = *unit() * std::numbers::pi / 2;
  angles.theta_d = *unit() * std::numbers::pi / 2;
  angles.phi_d = *unit() * std::numbers::pi;
  const DirectionPair pair = from_half_difference(angles);
  RC_ASSERT(std::abs(length(pair.wo) - 1) <= Float(1e-6));
  RC_ASSERT(std::abs(length(pair.wi) - 1) <= Float(1e-6));
  // At the ends azimuths are undefined and the half vector has no length.
  RC_PRE(angles.theta_d > 0.01 && angles.theta_d < 1.56 && angles.theta_h > 0.01 && angles.theta_h < 1.56);
  const HalfDifference again = to_half_difference(pair.wo, pair.wi);
  // Unit vectors of single precision, their sum no shorter than 2 cos(1.56) = 0.02.
  constexpr double kTolerance = 2e-5;
  RC_ASSERT(std::abs(again.theta_h - angles.theta_h) <= kTolerance);
  RC_ASSERT(std::abs(again.theta_d - angles.theta_d) <= kTolerance);
  // 0 and π are the same, the pair exchanged.
  const double off = std::abs(again.phi_d - angles.phi_d);
  RC_ASSERT(std::min(off, std::numbers::pi - off) * std::sin(angles.theta_d) <= kTolerance * 10);
}

RC_GTEST_PROP(HalfDifferenceAngles, DoNotTellWhichDirectionIsWhich, ()) {
  HalfDifference angles;
  angles.theta_h = *unit() * 1.5;
  angles.theta_d = 0.01 + *unit() * 1.5;
  angles.phi_d = *unit() * std::numbers::pi;
  const DirectionPair pair = from_half_difference(angles);
  RC_PRE(pair.wo.z > 0 && pair.wi.z > 0);
  const HalfDifference one = to_half_difference(pair.wo, pair.wi),
                       other = to_half_difference(pair.wi, pair.wo);
  RC_ASSERT(std::abs(one.theta_h - other.theta_h) <= 1e-6);
  RC_ASSERT(std::abs(one.theta_d - other.theta_d) <= 1e-6);
}

}  // namespace
}  // namespace spectrace::test
