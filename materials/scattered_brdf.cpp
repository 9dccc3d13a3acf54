// SPDX-License-Identifier: Apache-2.0
#include "materials/scattered_brdf.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "materials/half_difference.h"

namespace spectrace {
namespace {

// Added to f before the logarithm [1/sr]: the noise of such instruments. Far below it the fit is linear in f,
// so that noise around 0 is averaged and not drawn down by its logarithm.
constexpr double kEpsilon = 1e-3;
// Samples nearer than this to each other are the same directions, or mirror images: no distance between
// samples.
constexpr double kSameDirections = 1e-4;
// "Most" samples: the share of them that has a neighbour within near_radius().
constexpr double kNearShare = 0.9;
// Holds the linear fit to its mean where the neighbours do not span a direction.
constexpr double kRidge = 1e-2;

// So that equally distant neighbours, all weights 0, still have a mean.
constexpr double kLeastWeight = 1e-9;

double distance_squared(const ScatteredBrdf::Point& a, const ScatteredBrdf::Point& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return sum;
}

using Vector = std::array<double, 4>;
using Matrix = std::array<Vector, 4>;

/// The first row of A⁻¹, A symmetric and positive definite: by Cholesky's decomposition.
Vector first_row_of_inverse(const Matrix& a) {
  Matrix l{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
    }
  }
  Vector x{1, 0, 0, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < i; ++k) x[i] -= l[i][k] * x[k];
    x[i] /= l[i][i];
  }
  for (std::size_t i = 4; i-- > 0;) {
    for (std::size_t k = i + 1; k < 4; ++k) x[i] -= l[k][i] * x[k];
    x[i] /= l[i][i];
  }
  return x;
}

Vec3 direction(double theta, double phi) {
  return {Float(std::sin(theta) * std::cos(phi)), Float(std::sin(theta) * std::sin(phi)),
          Float(std::cos(theta))};
}

}  // namespace

ScatteredBrdf::Point ScatteredBrdf::point_of(Vec3 wo, Vec3 wi) {
  constexpr double kThetaD = 0.6;  // relative to the others
  const HalfDifference a = to_half_difference(wo, wi);
  return {std::sqrt(a.theta_h), kThetaD * a.theta_d,
          std::sin(a.theta_h) * std::sin(a.theta_d) * std::abs(std::cos(a.phi_d))};
}

ScatteredBrdf::ScatteredBrdf(const ScatteredSamples& samples)
    : axis_(SpectralAxis::wavelengths(samples.lambda_nm)) {
  std::vector<Point> points;
  for (const ScatteredSamples::Directions& d : samples.directions) {
    points.push_back(point_of(direction(d.theta_o, d.phi_o), direction(d.theta_i, d.phi_i)));
  }
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return points[a] < points[b]; });
  const std::size_t n = axis_.size();
  for (const std::size_t i : order) {
    points_.push_back(points[i]);
    for (std::size_t k = 0; k < n; ++k) {
      log_values_.push_back(static_cast<float>(std::log(double(samples.f[i * n + k]) + kEpsilon)));
    }
  }
  near_radius_ = neighbour_quantile();
}

double ScatteredBrdf::neighbour_quantile() const {
  std::vector<double> distances;
  for (const Point& p : points_) distances.push_back(nearest(p, kSameDirections)[0].distance_squared);
  const auto at = distances.begin() + std::ptrdiff_t(double(distances.size() - 1) * kNearShare);
  std::nth_element(distances.begin(), at, distances.end());
  return std::sqrt(*at);
}

ScatteredBrdf::Neighbours ScatteredBrdf::nearest(const Point& at, double beyond) const {
  Neighbours best;
  best.fill({std::numeric_limits<double>::infinity(), 0});
  const auto consider = [&](std::size_t i) {
    const double d2 = distance_squared(points_[i], at);
    if (d2 >= best.back().distance_squared || d2 < beyond * beyond) return;
    auto to = best.end() - 1;
    for (; to != best.begin() && (to - 1)->distance_squared > d2; --to) *to = *(to - 1);
    *to = {d2, i};
  };
  // Outwards from the sample whose first coordinate is nearest, until that alone is too far.
  const auto too_far = [&](std::size_t i) {
    return (points_[i][0] - at[0]) * (points_[i][0] - at[0]) >= best.back().distance_squared;
  };
  const auto start = static_cast<std::size_t>(
      std::lower_bound(points_.begin(), points_.end(), Point{at[0], -1, -1}) - points_.begin());
  std::size_t above = start, below = start;
  while (above < points_.size() || below > 0) {
    if (above < points_.size()) above = too_far(above) ? points_.size() : (consider(above), above + 1);
    if (below > 0) below = too_far(below - 1) ? 0 : (consider(below - 1), below - 1);
  }
  return best;
}

bool ScatteredBrdf::read(Vec3 wo, Vec3 wi, std::span<float> value_cos) const {
  const Point at = point_of(wo, wi);
  const Neighbours near = nearest(at, 0);
  const double reach_squared = std::max(near.back().distance_squared, kSameDirections * kSameDirections);
  // Smooth, and 0 at the one beyond the last. Not infinite at a sample: reciprocal twins of it differ.
  std::array<double, kNeighbours> weight{};
  double sum = 0;
  for (std::size_t i = 0; i < kNeighbours; ++i) {
    const double within = 1 - near[i].distance_squared / reach_squared;
    weight[i] = std::max(within * within, kLeastWeight);
    sum += weight[i];
  }
  Matrix normal{};
  std::array<Vector, kNeighbours> row{};
  for (std::size_t i = 0; i < kNeighbours; ++i) {
    weight[i] /= sum;
    row[i] = {1, points_[near[i].sample][0] - at[0], points_[near[i].sample][1] - at[1],
              points_[near[i].sample][2] - at[2]};
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) normal[a][b] += weight[i] * row[i][a] * row[i][b];
    }
  }
  const double ridge = kRidge * (normal[1][1] + normal[2][2] + normal[3][3]) + 1e-12;
  for (std::size_t a = 1; a < 4; ++a) normal[a][a] += ridge;
  const Vector inverse = first_row_of_inverse(normal);
  for (std::size_t i = 0; i < kNeighbours; ++i) {
    weight[i] *= std::inner_product(inverse.begin(), inverse.end(), row[i].begin(), 0.0);
  }
  const std::size_t n = axis_.size();
  for (std::size_t k = 0; k < n; ++k) {
    double value = 0, low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t i = 0; i < kNeighbours; ++i) {
      const auto sample = double(log_values_[near[i].sample * n + k]);
      value += weight[i] * sample;
      low = std::min(low, sample);
      high = std::max(high, sample);
    }
    const double f = std::max(std::exp(std::clamp(value, low, high)) - kEpsilon, 0.0);
    value_cos[k] = static_cast<float>(f * double(wi.z));
  }
  return near[0].distance_squared <= near_radius_ * near_radius_;
}

}  // namespace spectrace
