// SPDX-License-Identifier: Apache-2.0
#include "materials/backscatter_ndf.h"

#include <algorithm>
#include <cmath>

#include "core/math/math.h"
#include "materials/normal_square.h"

namespace spectrace {

namespace {

// The largest eigenvalue stands well apart: changes fall below single precision in about ten steps.
constexpr int kMaxIterations = 50;
constexpr double kConverged = 1e-7;

/// ∫ over the azimuth of max(0, ω·ωm), in closed form.
double clamped_cosine_over_azimuth(double theta, double theta_m) {
  const double a = std::cos(theta) * std::cos(theta_m), b = std::sin(theta) * std::sin(theta_m);
  if (a >= b) return 2 * kPi64 * a;
  const double phi = std::acos(-a / b);
  return 2 * (a * phi + b * std::sin(phi));
}

/// The operator D -> σ over the grid's nodes, by trapezoids in the square's coordinates. One row stands for
/// all azimuths; several are periodic, the node at +π being that at -π.
class ProjectedArea {
 public:
  ProjectedArea(int width, int rows) : width_(static_cast<std::size_t>(width)), is_isotropic_(rows == 1) {
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < width; ++x) {
        const double u = double(x) / (width - 1), theta = u * u * kPi64 / 2;
        const double end = x == 0 || x == width - 1 ? 0.5 : 1;
        const double azimuth_step = is_isotropic_ ? 1 : 2 * kPi64 / rows;
        theta_.push_back(theta);
        direction_.push_back(
            square_to_normal({Float(u), is_isotropic_ ? Float(0.5) : Float(y) / Float(rows)}));
        // dω = sinθ dθ dφ with dθ = π u du
        solid_angle_.push_back(end / (width - 1) * kPi64 * u * std::sin(theta) * azimuth_step);
      }
    }
  }

  [[nodiscard]] std::size_t nodes() const { return theta_.size(); }
  [[nodiscard]] Vec3 direction(std::size_t i) const { return direction_[i]; }
  [[nodiscard]] bool at_horizon(std::size_t i) const { return i % width_ == width_ - 1; }

  [[nodiscard]] double at(const std::vector<double>& d, std::size_t i) const {
    double sum = 0;
    for (std::size_t j = 0; j < nodes(); ++j) {
      sum += d[j] * solid_angle_[j] *
             (is_isotropic_ ? clamped_cosine_over_azimuth(theta_[i], theta_[j])
                            : double(std::max(dot(direction_[i], direction_[j]), Float(0))));
    }
    return sum;
  }
  [[nodiscard]] std::vector<double> apply(const std::vector<double>& d) const {
    std::vector<double> sigma(nodes());
    for (std::size_t i = 0; i < nodes(); ++i) sigma[i] = at(d, i);
    return sigma;
  }
  /// Scales D so that ∫ D cosθ dω = 1.
  void normalize(std::vector<double>& d) const {
    const double projected = at(d, 0);
    for (double& x : d) x /= projected;
  }

 private:
  std::size_t width_;
  bool is_isotropic_;
  std::vector<double> theta_, solid_angle_;
  std::vector<Vec3> direction_;
};

std::vector<double> solve(const ProjectedArea& project, const std::vector<double>& retro) {
  std::vector<double> d = retro;
  if (*std::max_element(d.begin(), d.end()) <= 0) return d;
  project.normalize(d);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    std::vector<double> next = project.apply(d);
    for (std::size_t i = 0; i < next.size(); ++i) next[i] *= retro[i];
    project.normalize(next);
    double change = 0;
    for (std::size_t i = 0; i < next.size(); ++i) change = std::max(change, std::abs(next[i] - d[i]));
    d = std::move(next);
    if (change <= kConverged * *std::max_element(d.begin(), d.end())) break;
  }
  return d;
}

}  // namespace

NormalDistribution ndf_from_backscatter(const Backscatter& backscatter, int width, int height) {
  const int rows = height == 2 ? 1 : height - 1;
  const ProjectedArea project(width, rows);
  std::vector<double> retro(project.nodes());
  for (std::size_t i = 0; i < retro.size(); ++i) {
    retro[i] = project.at_horizon(i) ? 0 : std::max(backscatter(project.direction(i)), 0.0);
  }
  const std::vector<double> d = solve(project, retro), sigma = project.apply(d);

  NormalDistribution result{.width = width, .height = height, .ndf = {}, .sigma = {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto i = static_cast<std::size_t>((y % rows) * width + x);
      result.ndf.push_back(static_cast<float>(d[i]));
      result.sigma.push_back(static_cast<float>(sigma[i]));
    }
  }
  return result;
}

}  // namespace spectrace
