// SPDX-License-Identifier: Apache-2.0
#include "separation/fill_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace spectrace {
namespace {

/// Below the horizon: the nearest node in phi_d, which is never far, because at phi_d = 90 degrees both
/// directions of a pair stand at cosθh cosθd > 0.
void fill_below_horizon(const HalfDifferenceGrid& grid, float wrap_sign, std::vector<float>& table) {
  const int n = grid.n_phi_d;
  for (std::size_t group = 0; group < grid.angular_size(); ++group) {
    float* row = &table[group * n];
    std::vector<float> filled(row, row + n);
    for (int p = 0; p < n; ++p) {
      for (int step = 1; std::isnan(filled[p]) && step <= n / 2; ++step) {
        const float before = row[(p + n - step) % n] * (p < step ? wrap_sign : 1);
        const float after = row[(p + step) % n] * (p + step >= n ? wrap_sign : 1);
        if (std::isnan(before) || std::isnan(after)) {
          filled[p] = std::isnan(before) ? after : before;
        } else {
          filled[p] = (before + after) / 2;
        }
      }
    }
    std::copy(filled.begin(), filled.end(), row);
  }
}

/// Rows still without any value take the nearest theta_h that has one, of two as near the lower.
void fill_empty_rows(const HalfDifferenceGrid& grid, std::vector<float>& table) {
  const int n = grid.n_theta_h;
  for (int d = 0; d < grid.n_theta_d; ++d) {
    for (int p = 0; p < grid.n_phi_d; ++p) {
      const auto value = [&](int h) -> float& { return table[grid.index(h, d, p)]; };
      int below = -1;  // the last node that had a value by itself
      for (int h = 0; h < n; ++h) {
        if (!std::isnan(value(h))) {
          below = h;
          continue;
        }
        int above = h + 1;
        while (above < n && std::isnan(value(above))) ++above;
        const bool has_above = above < n, has_below = below >= 0;
        const bool takes_above = has_above && (!has_below || above - h < h - below);
        value(h) = takes_above ? value(above) : has_below ? value(below) : 0;
      }
    }
  }
}

/// phi_d means nothing at theta_h = 0 and at theta_d = 0: one value there, so that lookups are continuous and
/// independent of azimuth (hard case H5).
void average_poles(const HalfDifferenceGrid& grid, std::vector<float>& table) {
  const auto average = [&](std::size_t group) {
    float* row = &table[group * grid.n_phi_d];
    double sum = 0;
    for (int p = 0; p < grid.n_phi_d; ++p) sum += double(row[p]);
    std::fill(row, row + grid.n_phi_d, static_cast<float>(sum / grid.n_phi_d));
  };
  for (int d = 0; d < grid.n_theta_d; ++d) average(std::size_t(d));
  for (int h = 1; h < grid.n_theta_h; ++h) average(std::size_t(h) * grid.n_theta_d);
}

}  // namespace

void fill_unmeasured(const HalfDifferenceGrid& grid, std::vector<float>& table) {
  fill_below_horizon(grid, 1, table);
  fill_empty_rows(grid, table);
  average_poles(grid, table);
}

void fill_unmeasured_odd(const HalfDifferenceGrid& grid, std::vector<float>& table) {
  fill_below_horizon(grid, -1, table);
  fill_empty_rows(grid, table);
  for (int h = 0; h < grid.n_theta_h; ++h) {
    for (int d = 0; d < (h == 0 ? grid.n_theta_d : 1); ++d) {
      std::fill_n(table.begin() + std::ptrdiff_t(grid.index(h, d, 0)), grid.n_phi_d, 0.0F);
    }
  }
}

}  // namespace spectrace
