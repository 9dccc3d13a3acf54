// SPDX-License-Identifier: Apache-2.0
#include "core/math/warp2d.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/math/math.h"
#include "core/math/piecewise_linear.h"

namespace spectrace {
namespace {

constexpr double kBelowOne = 0x1.fffffffffffffp-1;  // the largest double below 1

bool is_axis(std::span<const Float> p) {
  if (p.empty() || !std::all_of(p.begin(), p.end(), [](Float x) { return std::isfinite(x); })) return false;
  return std::adjacent_find(p.begin(), p.end(), [](Float a, Float b) { return a >= b; }) == p.end();
}

/// The node at or below `x` and the weight of the next one; the end values hold outside.
std::pair<std::size_t, Float> bracket(const std::vector<Float>& nodes, Float x) {
  if (!(x > nodes.front())) return {0, 0};
  if (x >= nodes.back()) return {nodes.size() - 1, 0};
  const auto above = std::upper_bound(nodes.begin(), nodes.end(), x);
  const auto i = static_cast<std::size_t>(above - nodes.begin()) - 1;
  return {i, (x - nodes[i]) / (nodes[i + 1] - nodes[i])};
}

/// u · total kept below total: u = 1 must not fall into massless cells at the far end.
double target_mass(double u, double total) { return std::min(clamp_unit(u), kBelowOne) * total; }

/// Σ weight · table over the slices of `b`, each `slice_size` long, at `offset` within them.
template <typename T>
double blended(const std::vector<T>& table, const Warp2D::Blend& b, std::size_t slice_size,
               std::size_t offset) {
  double sum = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(b.count); ++k) {
    sum += double(b.weight[k]) * double(table[b.slice[k] * slice_size + offset]);
  }
  return sum;
}

}  // namespace

Warp2D::Warp2D(std::span<const Float> p0, std::span<const Float> p1, int width, int height,
               std::span<const Float> data, bool normalize)
    : p0_(p0.begin(), p0.end()),
      p1_(p1.begin(), p1.end()),
      width_(width),
      height_(height),
      data_(data.begin(), data.end()) {
  SPECTRACE_CHECK(is_axis(p0) && is_axis(p1));
  SPECTRACE_CHECK(width >= 2 && height >= 2);
  const std::size_t slices = p0.size() * p1.size();
  SPECTRACE_CHECK(data.size() == slices * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  SPECTRACE_CHECK(std::all_of(data.begin(), data.end(), [](Float x) { return std::isfinite(x) && x >= 0; }));
  if (!normalize) return;
  marginal_.resize(slices * static_cast<std::size_t>(height));
  conditional_.resize(data_.size());
  for (std::size_t i = 0; i < slices; ++i) normalize_slice(i);
}

void Warp2D::normalize_slice(std::size_t slice) {
  const auto w = static_cast<std::size_t>(width_), h = static_cast<std::size_t>(height_);
  Float* const data = data_.data() + slice * w * h;
  double* const conditional = conditional_.data() + slice * w * h;
  double* const marginal = marginal_.data() + slice * h;

  // Trapezoids are exact for piecewise linear values.
  const auto row_mass = [&](std::size_t y) {
    double sum = 0;
    for (std::size_t x = 0; x + 1 < w; ++x) {
      sum += 0.5 * (double(data[y * w + x]) + double(data[y * w + x + 1])) / double(w - 1);
      conditional[y * w + x + 1] = sum;
    }
    return sum;
  };
  const auto accumulate_rows = [&] {
    double sum = 0, below = row_mass(0);
    for (std::size_t y = 1; y < h; ++y) {
      const double above = row_mass(y);
      sum += 0.5 * (below + above) / double(h - 1);
      marginal[y] = sum;
      below = above;
    }
    return sum;
  };

  const double total = accumulate_rows();
  for (std::size_t i = 0; i < w * h; ++i)
    data[i] = total > 0 ? static_cast<Float>(double(data[i]) / total) : Float(1);
  // Once more, from the values as they were rounded: only so is invert() the inverse of sample() to a
  // double's digits.
  accumulate_rows();
}

Warp2D::Blend Warp2D::blend(WarpParams params) const {
  const auto [i0, t0] = bracket(p0_, params.p0);
  const auto [i1, t1] = bracket(p1_, params.p1);
  Blend b;
  const auto add = [&b](std::size_t slice, Float weight) {
    if (weight <= 0) return;  // also keeps the neighbour of the last node out
    b.slice[static_cast<std::size_t>(b.count)] = slice;
    b.weight[static_cast<std::size_t>(b.count)] = weight;
    ++b.count;
  };
  const std::size_t n1 = p1_.size();
  add(i0 * n1 + i1, (1 - t0) * (1 - t1));
  add(i0 * n1 + i1 + 1, (1 - t0) * t1);
  add((i0 + 1) * n1 + i1, t0 * (1 - t1));
  add((i0 + 1) * n1 + i1 + 1, t0 * t1);
  return b;
}

Warp2D::Cell Warp2D::cell_at(double coordinate, int nodes) {
  const double scaled = clamp_unit(coordinate) * (nodes - 1);
  const int index = std::min(static_cast<int>(scaled), nodes - 2);
  return {index, scaled - index};
}

double Warp2D::marginal(const Blend& b, int row) const {
  return blended(marginal_, b, static_cast<std::size_t>(height_), static_cast<std::size_t>(row));
}

double Warp2D::row_integral(const Blend& b, int row) const { return conditional(b, {row, 0}, width_ - 1); }

double Warp2D::conditional(const Blend& b, Cell row, int column) const {
  const auto size = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  const auto offset = static_cast<std::size_t>(row.index * width_ + column);
  const double below = blended(conditional_, b, size, offset);
  if (row.fraction == 0) return below;
  return lerp(below, blended(conditional_, b, size, offset + static_cast<std::size_t>(width_)), row.fraction);
}

double Warp2D::value(const Blend& b, Cell row, int column) const {
  const auto size = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  const auto offset = static_cast<std::size_t>(row.index * width_ + column);
  return lerp(blended(data_, b, size, offset),
              blended(data_, b, size, offset + static_cast<std::size_t>(width_)), row.fraction);
}

double Warp2D::value(const Blend& b, UnitPoint position) const {
  const Cell row = cell_at(position.y, height_);
  const Cell column = cell_at(position.x, width_);
  return lerp(value(b, row, column.index), value(b, row, column.index + 1), column.fraction);
}

Float Warp2D::eval(UnitPoint position, const Blend& b) const {
  return static_cast<Float>(value(b, position));
}

Warp2D::Sample Warp2D::sample(UnitPoint u, const Blend& b) const {
  SPECTRACE_DCHECK(!marginal_.empty());

  const double mass = target_mass(u.y, marginal(b, height_ - 1));
  Cell row{find_cell(height_ - 1, mass, [&](int y) { return marginal(b, y); }), 0};
  row.fraction = invert_linear(row_integral(b, row.index), row_integral(b, row.index + 1),
                               (mass - marginal(b, row.index)) * (height_ - 1));

  const double along = target_mass(u.x, conditional(b, row, width_ - 1));
  Cell column{find_cell(width_ - 1, along, [&](int x) { return conditional(b, row, x); }), 0};
  column.fraction = invert_linear(value(b, row, column.index), value(b, row, column.index + 1),
                                  (along - conditional(b, row, column.index)) * (width_ - 1));

  const UnitPoint position{(column.index + column.fraction) / (width_ - 1),
                           (row.index + row.fraction) / (height_ - 1)};
  // At the rounded position, not at the cell's fractions: the same bits as eval() and invert() give.
  return {position, static_cast<Float>(value(b, position))};
}

Warp2D::Sample Warp2D::invert(UnitPoint position, const Blend& b) const {
  SPECTRACE_DCHECK(!marginal_.empty());
  const Cell row = cell_at(position.y, height_);
  const Cell column = cell_at(position.x, width_);

  const double mass =
      marginal(b, row.index) +
      integrate_linear(row_integral(b, row.index), row_integral(b, row.index + 1), row.fraction) /
          (height_ - 1);
  const double left = value(b, row, column.index), right = value(b, row, column.index + 1);
  const double along =
      conditional(b, row, column.index) + integrate_linear(left, right, column.fraction) / (width_ - 1);
  const double row_total = conditional(b, row, width_ - 1);

  // A row without mass has no conditional; sample() never lands inside one, the identity is as good as any.
  const UnitPoint u{row_total > 0 ? clamp_unit(along / row_total) : clamp_unit(position.x),
                    clamp_unit(mass / marginal(b, height_ - 1))};
  return {u, static_cast<Float>(lerp(left, right, column.fraction))};
}

}  // namespace spectrace
