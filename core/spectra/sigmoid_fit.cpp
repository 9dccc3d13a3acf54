// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/sigmoid_fit.h"

#include <algorithm>
#include <cstddef>
#include <optional>

#include "core/base/error.h"
#include "core/spectra/cie_tables.h"
#include "core/spectra/color.h"

namespace spectrace {
namespace {

using Matrix3 = std::array<std::array<double, 3>, 3>;

// A fit this good in CIELAB is off by less than 1e-9 in RGB: far under the 1e-6 promised, and reached in two
// or three more steps of quadratic convergence.
constexpr double kConverged = 1e-8;
// Steps needed are 4 to 15; colours that no sigmoid reaches end by the damping growing past its limit.
constexpr int kMaxSteps = 200;
constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-12, kMostDamping = 1e9;

/// Cramer's rule: well enough for the damped, scaled 3 x 3 systems here.
std::optional<std::array<double, 3>> solve(const Matrix3& a, const std::array<double, 3>& b) {
  const auto det = [](const Matrix3& m) {
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  const double d = det(a);
  if (!std::isfinite(d) || d == 0) return std::nullopt;
  std::array<double, 3> x{};
  for (std::size_t k = 0; k < 3; ++k) {
    Matrix3 m = a;
    for (std::size_t i = 0; i < 3; ++i) m[i][k] = b[i];
    x[k] = det(m) / d;
  }
  return x;
}

// The CIELAB curve with its linear toe: CIE 15:2004, sec. 8.2.1.

}  // namespace

double inverse_sigmoid(double y) { return (2 * y - 1) / (2 * std::sqrt(y * (1 - y))); }

struct SigmoidFitter::Residual {
  std::array<double, 3> r{};
  Matrix3 jacobian{};  // [residual][coefficient]
  [[nodiscard]] double squared() const { return r[0] * r[0] + r[1] * r[1] + r[2] * r[2]; }
};

SigmoidFitter::SigmoidFitter(int step_nm) {
  SPECTRACE_CHECK(step_nm > 0 && 5 % step_nm == 0);
  const auto count = static_cast<std::size_t>((kCieMaxNm - kCieMinNm) / step_nm) + 1;
  nodes_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double nm = kCieMinNm + double(i) * step_nm;
    nodes_[i].t = (nm - double(SigmoidSpectrum::kCenterNm)) / double(SigmoidSpectrum::kHalfWidthNm);
  }
  for (int nm = kCieMinNm; nm <= kCieMaxNm; ++nm) {
    const Xyz bar = cie_xyz_bar(nm);
    const double end = nm == kCieMinNm || nm == kCieMaxNm ? 0.5 : 1;
    const double position = double(nm - kCieMinNm) / step_nm;
    const auto i = std::min(static_cast<std::size_t>(position), count - 2);
    const double share = position - double(i);  // of the node above, as linear interpolation gives it
    for (std::size_t c = 0; c < 3; ++c) {
      const double w = end * illuminant_d65(nm) * bar[c] / (d65_luminance() * cie_y_integral());
      nodes_[i].weight[c] += (1 - share) * w;
      nodes_[i + 1].weight[c] += share * w;
      white_[c] += w;
    }
  }
}

SigmoidFitter::Residual SigmoidFitter::residual(const SigmoidCoefficients& c, const Xyz& target_lab) const {
  Xyz xyz{};
  Matrix3 slope{};  // d xyz / d c
  for (const Node& node : nodes_) {
    const double t = node.t, x = (c[0] * t + c[1]) * t + c[2];
    const double s = sigmoid(x);
    const double r = std::sqrt(1 + x * x), ds = 0.5 / (r * r * r);
    for (std::size_t k = 0; k < 3; ++k) {
      xyz[k] += node.weight[k] * s;
      const double w = node.weight[k] * ds;
      slope[k][0] += w * t * t;
      slope[k][1] += w * t;
      slope[k][2] += w;
    }
  }
  Residual out;
  const Xyz here = xyz_to_lab(xyz, white_);
  for (std::size_t k = 0; k < 3; ++k) out.r[k] = here[k] - target_lab[k];
  std::array<double, 3> f{};
  for (std::size_t k = 0; k < 3; ++k) f[k] = lab_slope(xyz[k] / white_[k]) / white_[k];
  for (std::size_t j = 0; j < 3; ++j) {
    out.jacobian[0][j] = 116 * f[1] * slope[1][j];
    out.jacobian[1][j] = 500 * (f[0] * slope[0][j] - f[1] * slope[1][j]);
    out.jacobian[2][j] = 200 * (f[1] * slope[1][j] - f[2] * slope[2][j]);
  }
  return out;
}

SigmoidFitter::Fit SigmoidFitter::fit(const Rgb& rgb, const SigmoidCoefficients& start) const {
  const Xyz target = xyz_to_lab(rgb_to_xyz(rgb), white_);
  SigmoidCoefficients c = start;
  Residual now = residual(c, target);
  double damping = kFirstDamping;
  for (int step = 0; step < kMaxSteps && now.squared() > kConverged * kConverged && damping < kMostDamping;
       ++step) {
    Matrix3 normal{};
    std::array<double, 3> descent{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        for (std::size_t k = 0; k < 3; ++k) normal[i][j] += now.jacobian[k][i] * now.jacobian[k][j];
      }
      for (std::size_t k = 0; k < 3; ++k) descent[i] -= now.jacobian[k][i] * now.r[k];
    }
    for (std::size_t i = 0; i < 3; ++i) normal[i][i] *= 1 + damping;  // Marquardt's scaling
    const auto move = solve(normal, descent);
    if (move) {
      const SigmoidCoefficients next{c[0] + (*move)[0], c[1] + (*move)[1], c[2] + (*move)[2]};
      const Residual there = residual(next, target);
      if (there.squared() < now.squared()) {
        c = next;
        now = there;
        damping = std::max(damping / 10, kLeastDamping);
        continue;
      }
    }
    damping *= 10;
  }
  return {c, std::sqrt(now.squared())};
}

SigmoidFitter::Fit SigmoidFitter::fit(const Rgb& rgb) const {
  const double luminance = std::clamp(rgb_to_xyz(rgb)[1], kGreyMargin, 1 - kGreyMargin);
  const SigmoidCoefficients grey{0, 0, inverse_sigmoid(luminance)};
  if (rgb[0] == rgb[1] && rgb[1] == rgb[2]) return {grey, 0};
  Fit best = fit(rgb, grey);
  for (int parts = 4; parts <= 64 && best.delta_e > kConverged; parts *= 4) {
    Fit stepped{grey, 0};
    for (int i = 1; i <= parts; ++i) {
      const double s = double(i) / parts;
      Rgb between{};
      for (std::size_t k = 0; k < 3; ++k) between[k] = (1 - s) * luminance + s * rgb[k];
      stepped = fit(between, stepped.c);
    }
    if (stepped.delta_e < best.delta_e) best = stepped;
  }
  return best;
}

Rgb SigmoidFitter::color_of(const SigmoidCoefficients& c) const {
  Xyz xyz{};
  for (const Node& node : nodes_) {
    const double s = sigmoid((c[0] * node.t + c[1]) * node.t + c[2]);
    for (std::size_t k = 0; k < 3; ++k) xyz[k] += node.weight[k] * s;
  }
  return xyz_to_rgb(xyz);
}

}  // namespace spectrace
