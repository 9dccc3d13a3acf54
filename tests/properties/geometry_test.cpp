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
#include "materials/half_difference_grid.h"
#include "materials/normal_square.h"

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

HalfDifferenceGrid random_grid() {
  return {.n_theta_h = *rc::gen::inRange(2, 100),
          .n_theta_d = *rc::gen::inRange(2, 100),
          .n_phi_d = *rc::gen::inRange(2, 200),
          .quadratic_theta_h = *rc::gen::arbitrary<bool>()};
}

RC_GTEST_PROP(HalfDifferenceGrid, CoordinatesAreUndoneByTheirInverses, ()) {
  const HalfDifferenceGrid grid = random_grid();
  const double h = *unit() * (grid.n_theta_h - 1), d = *unit() * (grid.n_theta_d - 1);
  const double p = *unit() * (grid.n_phi_d - 1);
  constexpr double kTolerance = 1e-11;  // double, times at most 200 nodes
  RC_ASSERT(std::abs(grid.coordinate_h(grid.theta_h(h)) - h) <= kTolerance);
  RC_ASSERT(std::abs(grid.coordinate_d(grid.theta_d(d)) - d) <= kTolerance);
  RC_ASSERT(std::abs(grid.coordinate_p(grid.phi_d(p)) - p) <= kTolerance);
  RC_ASSERT(grid.theta_h(0) == 0.0);
  RC_ASSERT(grid.theta_h(grid.n_theta_h) == std::numbers::pi / 2);
}

/// Weights that sum to 1 and whose mean of the nodes' angles is the angle itself: only the right two nodes,
/// in the right shares, do that everywhere.
RC_GTEST_PROP(HalfDifferenceGrid, NodesAroundAPlaceHaveItForTheirMean, ()) {
  const HalfDifferenceGrid grid = random_grid();
  HalfDifference angles;
  angles.theta_h = *unit() * grid.theta_h(grid.n_theta_h - 1);
  angles.theta_d = *unit() * grid.theta_d(grid.n_theta_d - 1);
  angles.phi_d = *unit() * grid.phi_d(grid.n_phi_d - 1);
  const GridPoint at = grid.locate(angles);
  double sum = 0, theta_h = 0, theta_d = 0, phi_d = 0;
  for (std::size_t i = 0; i < at.cell.size(); ++i) {
    const auto cell = int(at.cell[i]), p = cell % grid.n_phi_d, row = cell / grid.n_phi_d;
    const double weight = double(at.cell_weight[i]);
    RC_ASSERT(weight >= 0);
    sum += weight;
    theta_h += weight * grid.theta_h(row / grid.n_theta_d);
    theta_d += weight * grid.theta_d(row % grid.n_theta_d);
    phi_d += weight * grid.phi_d(p);
  }
  constexpr double kTolerance = 4e-6;  // weights of single precision on angles up to π
  RC_ASSERT(std::abs(sum - 1) <= kTolerance);
  RC_ASSERT(std::abs(theta_h - angles.theta_h) <= kTolerance);
  RC_ASSERT(std::abs(theta_d - angles.theta_d) <= kTolerance);
  RC_ASSERT(std::abs(phi_d - angles.phi_d) <= kTolerance);
}

RC_GTEST_PROP(NormalSquare, CoordinatesAreUndoneByTheirInverses, ()) {
  const auto x = Float(*unit());
  constexpr Float kTolerance = Float(1e-6);  // single precision of angles up to π
  RC_ASSERT(std::abs(polar_coordinate(polar_angle(x)) - x) <= kTolerance);
  const Float off = std::abs(azimuth_coordinate(azimuth_angle(x)) - x);
  RC_ASSERT(std::min(off, 1 - off) <= kTolerance);  // 0 and 1 are one azimuth
}

RC_GTEST_PROP(Warp, OfBlendedTablesIsUndoneByItsInverse, ()) {
  const auto values = *rc::gen::container<std::vector<Float>>(
      std::size_t(2 * 3 * 4 * 5),
      rc::gen::map(rc::gen::inRange(1, 1000), [](int i) { return Float(i) / 100; }));
  const std::vector<Float> first{0, 1}, second{0, Float(0.5), 1};
  const Warp2D warp(first, second, 4, 5, values, true);
  const Warp2D::Blend blend = warp.blend({.p0 = Float(*unit()), .p1 = Float(*unit())});
  const UnitPoint u{*unit(), *unit()};
  const Warp2D::Sample back = warp.invert(warp.sample(u, blend).position, blend);
  RC_ASSERT(std::abs(back.position.x - u.x) <= 1e-6);
  RC_ASSERT(std::abs(back.position.y - u.y) <= 1e-6);
}

}  // namespace
}  // namespace spectrace::test
