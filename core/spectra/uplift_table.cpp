// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/uplift_table.h"

#include <algorithm>
#include <cmath>

namespace spectrace {
namespace {

// The layer of nodes at largest = 0 is solved here instead: c · sqrt(largest) has reached its limit to 1e-2
// of itself, and 0.01 of a colour this dark is 1e-6.
constexpr double kDarkest = 1e-4;

/// Node positions on each axis: 0 and 1 are nodes, spacing shrinks towards both.
double node(int i) {
  const double x = double(i) / (UpliftTable::kSize - 1);
  return x * x * (3 - 2 * x);
}

struct Position {
  int cell = 0;
  double fraction = 0;
};
Position locate(double value) {
  // The inverse of x² (3 - 2x): a root of a cubic, by the trigonometric formula.
  const double x = 0.5 - std::sin(std::asin(std::clamp(1 - 2 * value, -1.0, 1.0)) / 3);
  const int guess = static_cast<int>(x * (UpliftTable::kSize - 1));
  const int cell = std::clamp(guess, 0, UpliftTable::kSize - 2);
  const double below = node(cell);
  return {cell, std::clamp((value - below) / (node(cell + 1) - below), 0.0, 1.0)};
}

std::size_t index(std::size_t largest, int value, int second, int first) {
  constexpr auto kN = std::size_t(UpliftTable::kSize);
  return (((largest * kN + std::size_t(value)) * kN + std::size_t(second)) * kN + std::size_t(first)) * 3;
}

/// Is the node a corner of a cell with a colour of largest + smallest <= 1?
bool is_used(int value, int second, int first) {
  const auto below = [](int i) { return node(std::max(i - 1, 0)); };
  return below(value) * (1 + std::min(below(second), below(first))) <= 1;
}

}  // namespace

std::vector<float> UpliftTable::build() {
  const SigmoidFitter fitter(1);
  std::vector<float> table(kFloats);
  for (std::size_t largest = 0; largest < 3; ++largest) {
    for (int value = 0; value < kSize; ++value) {
      const double v = std::max(node(value), kDarkest);
      for (int second = 0; second < kSize; ++second) {
        SigmoidFitter::Fit fit;
        for (int first = 0; first < kSize; ++first) {
          if (!is_used(value, second, first)) break;
          Rgb rgb{};
          rgb[largest] = v;
          rgb[(largest + 1) % 3] = v * node(first);
          rgb[(largest + 2) % 3] = v * node(second);
          if (first > 0) fit = fitter.fit(rgb, fit.c);  // the neighbour's solution is near: four times faster
          // 1e-3: where the short way ends in a wrong valley, from grey it does not.
          if (first == 0 || fit.delta_e > 1e-3) fit = fitter.fit(rgb);
          for (std::size_t k = 0; k < 3; ++k) {
            table[index(largest, value, second, first) + k] = static_cast<float>(fit.c[k] * std::sqrt(v));
          }
        }
      }
    }
  }
  return table;
}

SigmoidCoefficients UpliftTable::lookup(const Rgb& rgb) const {
  const auto [low, high] = std::minmax_element(rgb.begin(), rgb.end());
  if (*low == *high) {  // a grey: exact, and 1 must be 1
    const double grey = std::clamp(*high, kGreyMargin, 1 - kGreyMargin);
    return {0, 0, inverse_sigmoid(grey)};
  }
  const bool complement = *low + *high > 1;
  Rgb c = rgb;
  if (complement) c = {1 - rgb[0], 1 - rgb[1], 1 - rgb[2]};
  const auto largest = static_cast<std::size_t>(std::max_element(c.begin(), c.end()) - c.begin());
  const double value = c[largest];
  const Position p = locate(value);
  const Position p1 = locate(c[(largest + 1) % 3] / value), p2 = locate(c[(largest + 2) % 3] / value);

  SigmoidCoefficients sum{};
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
    const double weight = (i ? p1.fraction : 1 - p1.fraction) * (j ? p2.fraction : 1 - p2.fraction) *
                          (k ? p.fraction : 1 - p.fraction);
    const std::size_t at = index(largest, p.cell + k, p2.cell + j, p1.cell + i);
    for (std::size_t n = 0; n < 3; ++n) sum[n] += weight * double(c_[at + n]);
  }
  // 1e-12: below, black to any eye, coefficients would overflow a float.
  const double scale = (complement ? -1 : 1) / std::sqrt(std::max(value, 1e-12));
  for (double& x : sum) x *= scale;
  return sum;
}

}  // namespace spectrace
