// SPDX-License-Identifier: Apache-2.0
#include "tests/support/measured_reference.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/spectra/rgb_uplift.h"

namespace spectrace::test {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPhiSlack = 1e-5;  // the ends of phi_i are single precision

/// Bracket `x` by walking along the axis: lower index and fraction; the ends hold outside.
template <typename T>
std::pair<std::size_t, double> walk(const std::vector<T>& axis, double x) {
  if (axis.size() == 1 || x <= axis[0]) return {0, 0.0};
  std::size_t i = 0;
  while (i + 1 < axis.size() && x >= axis[i + 1]) ++i;
  if (i + 1 == axis.size()) return {axis.size() - 2, 1.0};
  return {i, (x - axis[i]) / (double(axis[i + 1]) - axis[i])};
}

/// Mean over the unit square of the bilinear surface: the average of all cells' corner averages.
double mean_of(const std::vector<double>& grid, int width, int height) {
  double sum = 0;
  for (int y = 0; y + 1 < height; ++y) {
    for (int x = 0; x + 1 < width; ++x) {
      sum += (grid[y * width + x] + grid[y * width + x + 1] + grid[(y + 1) * width + x] +
              grid[(y + 1) * width + x + 1]) /
             4;
    }
  }
  return sum / ((width - 1.0) * (height - 1.0));
}

std::vector<std::vector<double>> split(const std::vector<float>& values, std::size_t size) {
  std::vector<std::vector<double>> out;
  for (std::size_t i = 0; i < values.size(); i += size) {
    out.emplace_back(values.begin() + std::ptrdiff_t(i), values.begin() + std::ptrdiff_t(i + size));
  }
  return out;
}

void normalize(std::vector<std::vector<double>>& slices, int width, int height) {
  for (auto& slice : slices) {
    const double mean = mean_of(slice, width, height);
    for (double& x : slice) x = mean > 0 ? x / mean : 1.0;
  }
}

/// Trapezoid area from 0 to x (in node units) under values at 0, 1, 2, ...
template <typename Values>
double area_up_to(const Values& value, double x) {
  double area = 0;
  int k = 0;
  for (; k + 1 <= x; ++k) area += (value(k) + value(k + 1)) / 2;
  const double t = x - k;
  if (t > 0) area += t * value(k) + t * t / 2 * (value(k + 1) - value(k));
  return area;
}

}  // namespace

MeasuredReference::MeasuredReference(const MeasuredTables& tables) : tables_(tables) {
  const std::size_t ndf_size = std::size_t(tables.ndf_width) * tables.ndf_height;
  ndf_ = {tables.ndf_width, tables.ndf_height, split(tables.ndf, ndf_size)};
  sigma_ = {tables.ndf_width, tables.ndf_height, split(tables.sigma, ndf_size)};
  const int n = tables.warp_size, m = tables.table_size;
  vndf_ = {n, n, split(tables.vndf, std::size_t(n) * n)};
  normalize(vndf_.slices, n, n);
  for (const auto& slice : vndf_.slices) {
    auto& mass = vndf_row_mass_.emplace_back();
    for (int y = 0; y < n; ++y) mass.push_back(area_up_to([&](int x) { return slice[y * n + x]; }, n - 1));
  }

  // The density cells are drawn with: the luminance, at least an eighth of the mean over the last axis.
  const std::size_t cells = std::size_t(m) * m, axis = tables.axis.size();
  sampling_ = {m, m, split(tables.luminance, cells)};
  for (std::size_t s = 0; s < tables.slices(); ++s) {
    for (std::size_t i = 0; i < cells; ++i) {
      double sum = 0;
      for (std::size_t k = 0; k < axis; ++k) sum += tables.spectra[(s * axis + k) * cells + i];
      sampling_.slices[s][i] = std::max(sampling_.slices[s][i], sum / double(axis) / 8);
    }
  }
  normalize(sampling_.slices, m, m);
}

double MeasuredReference::Grid::at(const Slices& which, double x, double y) const {
  const double gx = x * (width - 1), gy = y * (height - 1);
  const int ix = std::min(int(gx), width - 2), iy = std::min(int(gy), height - 2);
  double sum = 0;
  for (std::size_t k = 0; k < which.index.size(); ++k) {
    const auto& s = slices[which.index[k]];
    const double low = s[iy * width + ix] + (gx - ix) * (s[iy * width + ix + 1] - s[iy * width + ix]);
    const double high =
        s[(iy + 1) * width + ix] + (gx - ix) * (s[(iy + 1) * width + ix + 1] - s[(iy + 1) * width + ix]);
    sum += which.weight[k] * (low + (gy - iy) * (high - low));
  }
  return sum;
}

MeasuredReference::Angles MeasuredReference::angles(Vec3 wo, Vec3 wi) const {
  const double first = tables_.phi_i.front(), last = tables_.phi_i.back();
  const auto turned_into_range = [&](double phi) {
    while (phi < first - kPhiSlack) phi += 2 * kPi;
    while (phi > last + kPhiSlack && phi - 2 * kPi >= first - kPhiSlack) phi -= 2 * kPi;
    return phi;
  };
  const auto of = [&](double sx, double sy) {
    const double ox = sx * wo.x, oy = sy * wo.y, oz = wo.z;
    const double mx = ox + sx * wi.x, my = oy + sy * wi.y, mz = oz + wi.z;
    return Angles{std::atan2(std::hypot(ox, oy), oz), turned_into_range(std::atan2(oy, ox)),
                  std::atan2(std::hypot(mx, my), mz), std::atan2(my, mx)};
  };
  const auto in_range = [&](const Angles& a) { return a.phi_i <= last + kPhiSlack; };
  const Angles as_given = of(1, 1);
  if (tables_.is_isotropic() || in_range(as_given)) return as_given;
  if (tables_.phi_i.back() - tables_.phi_i.front() > 3) return of(-1, -1);  // half a turn is stored
  for (const auto& candidate : {of(-1, 1), of(1, -1), of(-1, -1)}) {
    if (in_range(candidate)) return candidate;
  }
  return as_given;
}

MeasuredReference::Slices MeasuredReference::slices(double phi_i, double theta_i) const {
  const auto [p, tp] = walk(tables_.phi_i, phi_i);
  const auto [t, tt] = walk(tables_.theta_i, theta_i);
  const std::size_t thetas = tables_.theta_i.size();
  Slices out;
  for (const int dp : {0, 1}) {
    for (const int dt : {0, 1}) {
      const double weight = (dp == 1 ? tp : 1 - tp) * (dt == 1 ? tt : 1 - tt);
      if (weight == 0) continue;
      out.index.push_back((p + dp) * thetas + t + dt);
      out.weight.push_back(weight);
    }
  }
  return out;
}

std::array<double, 2> MeasuredReference::inverse(const Slices& which, double x, double y) const {
  const int n = vndf_.width;
  const double gx = x * (n - 1), gy = y * (n - 1);
  const auto row_mass = [&](int row) {
    double sum = 0;
    for (std::size_t k = 0; k < which.index.size(); ++k) {
      sum += which.weight[k] * vndf_row_mass_[which.index[k]][row];
    }
    return sum;
  };
  const double all_rows = area_up_to(row_mass, n - 1);
  const int iy = std::min(int(gy), n - 2);
  const auto along_row = [&](int column) {
    double sum = 0;
    for (std::size_t k = 0; k < which.index.size(); ++k) {
      const auto& s = vndf_.slices[which.index[k]];
      sum += which.weight[k] * ((1 - (gy - iy)) * s[iy * n + column] + (gy - iy) * s[(iy + 1) * n + column]);
    }
    return sum;
  };
  const double whole_row = area_up_to(along_row, n - 1);
  return {whole_row > 0 ? area_up_to(along_row, gx) / whole_row : x, area_up_to(row_mass, gy) / all_rows};
}

double MeasuredReference::channel(const Slices& which, std::size_t k, double x, double y) const {
  const int m = tables_.table_size;
  const double gx = x * (m - 1), gy = y * (m - 1);
  const int ix = std::min(int(gx), m - 2), iy = std::min(int(gy), m - 2);
  const std::size_t axis = tables_.axis.size(), cells = std::size_t(m) * m;
  double sum = 0;
  for (std::size_t j = 0; j < which.index.size(); ++j) {
    const float* const grid = tables_.spectra.data() + (which.index[j] * axis + k) * cells;
    const double low = (1 - (gx - ix)) * grid[iy * m + ix] + (gx - ix) * grid[iy * m + ix + 1];
    const double high = (1 - (gx - ix)) * grid[(iy + 1) * m + ix] + (gx - ix) * grid[(iy + 1) * m + ix + 1];
    sum += which.weight[j] * ((1 - (gy - iy)) * low + (gy - iy) * high);
  }
  return sum;
}

double MeasuredReference::colour(const Slices& which, double lambda_nm, double x, double y) const {
  if (tables_.axis.is_rgb()) {
    const auto basis = rgb_basis(Float(lambda_nm));
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += basis[k] * channel(which, k, x, y);
    return sum;
  }
  const std::vector<float> lambda(tables_.axis.lambda_nm().begin(), tables_.axis.lambda_nm().end());
  const auto [i, t] = walk(lambda, lambda_nm);
  return (1 - t) * channel(which, i, x, y) + (t > 0 ? t * channel(which, i + 1, x, y) : 0);
}

MeasuredReference::Value MeasuredReference::evaluate(Vec3 wo, Vec3 wi,
                                                     std::span<const double> lambda_nm) const {
  const Angles a = angles(wo, wi);
  const auto u_of = [](double theta) { return std::sqrt(2 * theta / kPi); };
  const auto v_of = [](double phi) {
    const double v = (phi + kPi) / (2 * kPi);
    return v - std::floor(v);
  };
  const double ux = u_of(a.theta_m), uy = v_of(tables_.is_isotropic() ? a.phi_m - a.phi_i : a.phi_m);
  const Slices which = slices(a.phi_i, a.theta_i), only{{0}, {1.0}};
  const auto [sx, sy] = inverse(which, ux, uy);

  double scale = 1;
  if (tables_.jacobian) {
    scale = ndf_.at(only, ux, uy) / (4 * sigma_.at(only, u_of(a.theta_i), v_of(a.phi_i)));
  }
  Value out;
  for (const double lambda : lambda_nm) out.value_cos.push_back(colour(which, lambda, sx, sy) * scale);

  const double half_x = double(wo.x) + wi.x, half_y = double(wo.y) + wi.y, half_z = double(wo.z) + wi.z;
  const double norm = std::hypot(half_x, half_y, half_z);
  const double wo_dot_wm = (wo.x * half_x + wo.y * half_y + wo.z * half_z) / norm;
  out.pdf = sampling_.at(which, sx, sy) * vndf_.at(which, ux, uy) /
            (2 * kPi * kPi * ux * std::sin(a.theta_m) * 4 * wo_dot_wm);
  return out;
}

}  // namespace spectrace::test
