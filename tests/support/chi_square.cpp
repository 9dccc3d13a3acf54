// SPDX-License-Identifier: Apache-2.0
#include "tests/support/chi_square.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <vector>

#include "core/math/math.h"
#include "tests/support/pearson.h"

namespace spectrace::test {

namespace {

/// A direction as (s, φ): s = sqrt(1 - cosθ) in [0, 1], exact for lobes around the normal where cosθ has lost
/// all digits; dω = 2 s ds dφ.
struct CellPoint {
  double s = 0, phi = 0;
};

class Chart {
 public:
  explicit Chart(Vec3 zero)
      : offset_(std::atan2(double(zero.y), double(zero.x))),
        cos_(std::cos(offset_)),
        sin_(std::sin(offset_)) {}

  [[nodiscard]] CellPoint to_cell(Vec3 w) const {
    const double r2 = double(w.x) * w.x + double(w.y) * w.y;
    const double t = w.z < 0.5 ? 1 - double(w.z) : r2 / (1 + double(w.z));
    // Turned first: a difference of angles would need its remainder by 2π.
    const double x = double(w.x) * cos_ + double(w.y) * sin_, y = double(w.y) * cos_ - double(w.x) * sin_;
    return {std::sqrt(std::clamp(t, 0.0, 1.0)), std::atan2(y, x)};
  }
  [[nodiscard]] Vec3 to_direction(CellPoint p) const {
    const double sin_theta = p.s * std::sqrt(2 - p.s * p.s), phi = p.phi + offset_;
    return {static_cast<Float>(sin_theta * std::cos(phi)), static_cast<Float>(sin_theta * std::sin(phi)),
            static_cast<Float>(1 - p.s * p.s)};
  }

 private:
  double offset_, cos_, sin_;
};

struct Cell {
  double s0 = 0, s1 = 1, phi0 = -kPi64, phi1 = kPi64;
};

/// Bins of one size over the hemisphere: where a place lies, and where a cell is to be cut so that every part
/// lies in one of them.
class BinGrid {
 public:
  BinGrid(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns) {}
  [[nodiscard]] std::size_t size() const { return rows_ * columns_; }
  [[nodiscard]] std::size_t find(CellPoint p) const {
    const double turn = (p.phi + kPi64) / (2 * kPi64);
    return index(p.s * p.s, rows_) * columns_ + index(turn, columns_);
  }
  void cut_rows(std::vector<double>& s) const {
    cut(s, rows_, [&](std::size_t i) { return std::sqrt(double(i) / double(rows_)); });
  }
  void cut_columns(std::vector<double>& phi) const {
    cut(phi, columns_, [&](std::size_t i) { return (2 * double(i) / double(columns_) - 1) * kPi64; });
  }

 private:
  static std::size_t index(double x, std::size_t n) {
    return std::min(static_cast<std::size_t>(std::max(x, 0.0) * double(n)), n - 1);
  }
  static void cut(std::vector<double>& points, std::size_t n, const auto& edge) {
    const double low = points.front(), high = points.back();
    for (std::size_t i = 1; i < n; ++i) {
      if (const double x = edge(i); x > low && x < high) points.push_back(x);
    }
    std::sort(points.begin(), points.end());
  }

  std::size_t rows_, columns_;
};

/// A few pilots, the box around them where most of the leaf's mass lies, and the cell it belongs to.
struct Leaf {
  Cell extent, box;
  std::size_t cell = 0;
};

/// So few pilots that a density peaked on a corner of a cell still fills its leaves.
constexpr std::size_t kPilotsPerLeaf = 16;

/// Cuts the hemisphere at medians of pilot samples: into cells, whose counts are compared, and those into
/// leaves, over which the density is integrated.
class CellTree {
 public:
  CellTree(std::vector<CellPoint> pilots, std::size_t pilots_per_cell) : pilots_per_cell_(pilots_per_cell) {
    build(pilots.begin(), pilots.end(), Cell{}, std::nullopt);
  }
  [[nodiscard]] const std::vector<Leaf>& leaves() const { return leaves_; }
  [[nodiscard]] std::size_t cells() const { return cells_; }
  [[nodiscard]] std::size_t find(CellPoint p) const {
    std::size_t node = 0;
    while (!nodes_[node].cell) {
      const double x = nodes_[node].along_s ? p.s : p.phi;
      node = x < nodes_[node].split ? node + 1 : nodes_[node].upper;
    }
    return *nodes_[node].cell;
  }

 private:
  using Iterator = std::vector<CellPoint>::iterator;
  struct Node {
    bool along_s = true;
    double split = 0;
    std::size_t upper = 0;            // the lower child follows its parent
    std::optional<std::size_t> cell;  // of this node and all below
  };

  void build(Iterator begin, Iterator end, const Cell& extent, std::optional<std::size_t> cell) {
    const auto count = static_cast<std::size_t>(end - begin);
    if (!cell && count <= pilots_per_cell_) cell = cells_++;
    const std::size_t index = nodes_.size();
    nodes_.push_back({.cell = cell});
    if (count > kPilotsPerLeaf) {
      const bool along_s = longer_along_s(begin, end);
      const auto coordinate = [along_s](CellPoint p) { return along_s ? p.s : p.phi; };
      const Iterator middle = begin + static_cast<std::ptrdiff_t>(count / 2);
      std::nth_element(begin, middle, end,
                       [&](CellPoint a, CellPoint b) { return coordinate(a) < coordinate(b); });
      const double split = coordinate(*middle);
      const Iterator bound = std::partition(begin, end, [&](CellPoint p) { return coordinate(p) < split; });
      if (bound != begin) {
        Cell lower = extent, upper = extent;
        (along_s ? lower.s1 : lower.phi1) = split;
        (along_s ? upper.s0 : upper.phi0) = split;
        nodes_[index].along_s = along_s;
        nodes_[index].split = split;
        build(begin, bound, lower, cell);
        nodes_[index].upper = nodes_.size();
        build(bound, end, upper, cell);
        return;
      }
      // All pilots alike: a lobe of no width.
    }
    if (!cell) nodes_[index].cell = cell = cells_++;
    leaves_.push_back({extent, begin == end ? extent : box_of(begin, end), *cell});
  }

  static Cell box_of(Iterator begin, Iterator end) {
    Cell box{begin->s, begin->s, begin->phi, begin->phi};
    for (Iterator p = begin; p != end; ++p) {
      box.s0 = std::min(box.s0, p->s), box.s1 = std::max(box.s1, p->s);
      box.phi0 = std::min(box.phi0, p->phi), box.phi1 = std::max(box.phi1, p->phi);
    }
    return box;
  }

  static bool longer_along_s(Iterator begin, Iterator end) {
    const Cell box = box_of(begin, end);
    const double s = (box.s0 + box.s1) / 2;  // dθ = 2 ds / sqrt(2 - s²), sinθ = s sqrt(2 - s²)
    return 2 * (box.s1 - box.s0) > s * (2 - s * s) * (box.phi1 - box.phi0);
  }

  std::size_t pilots_per_cell_, cells_ = 0;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
};

/// Gauss-Legendre with 3 x 3 points a leaf, compared with four quarters of it, and so on.
class Quadrature {
 public:
  Quadrature(const DirectionDensity& density, const Chart& chart, double relative, double absolute,
             const BinGrid& bins)
      : density_(density), chart_(chart), relative_(relative), absolute_(absolute), bins_(bins) {
    in_bins_.resize(bins.size());
  }

  /// A leaf at the skirt of a lobe is far wider than its mass, and a rule that looks for it by halving may
  /// see nothing at all. So the box of the pilots comes first, then strips that double in width away from it.
  double integrate(const Leaf& leaf) {
    const Cell &c = leaf.extent, &box = leaf.box;
    double sum = 0;
    const std::vector<double> s = breakpoints(c.s0, box.s0, box.s1, c.s1);
    const std::vector<double> phi = breakpoints(c.phi0, box.phi0, box.phi1, c.phi1);
    for (std::size_t i = 0; i + 1 < s.size(); ++i) {
      for (std::size_t j = 0; j + 1 < phi.size(); ++j) {
        sum += integrate_part({s[i], s[i + 1], phi[j], phi[j + 1]});
      }
    }
    return sum;
  }
  [[nodiscard]] const std::vector<double>& in_bins() const { return in_bins_; }
  double error() const { return error_; }
  std::size_t evaluations() const { return evaluations_; }

 private:
  // 4^7 quarters resolve a peak of 1/128 of the leaf's side; leaves already follow the pilots.
  static constexpr int kMaxDepth = 7;

  /// So little mass is no sample in a hundred of those drawn: it goes to one bin whole.
  static constexpr double kNegligible = 1e-9;

  double integrate_part(const Cell& part) {
    const double error = error_, whole = refine(part, gauss(part), 0);
    if (bins_.size() == 0) return whole;
    std::vector<double> s{part.s0, part.s1}, phi{part.phi0, part.phi1};
    bins_.cut_rows(s), bins_.cut_columns(phi);
    const auto middle = [](double a, double b) { return (a + b) / 2; };
    if (whole < kNegligible || (s.size() == 2 && phi.size() == 2)) {
      in_bins_[bins_.find({middle(part.s0, part.s1), middle(part.phi0, part.phi1)})] += whole;
      return whole;
    }
    error_ = error;
    double sum = 0;
    for (std::size_t i = 0; i + 1 < s.size(); ++i) {
      for (std::size_t j = 0; j + 1 < phi.size(); ++j) {
        const Cell piece{s[i], s[i + 1], phi[j], phi[j + 1]};
        const double mass = refine(piece, gauss(piece), 2);  // 2: a piece is some 16th of its leaf
        in_bins_[bins_.find({middle(piece.s0, piece.s1), middle(piece.phi0, piece.phi1)})] += mass;
        sum += mass;
      }
    }
    return sum;
  }

  static std::vector<double> breakpoints(double low, double box_low, double box_high, double high) {
    const double width = std::max(box_high - box_low, 1e-7 * (high - low));
    std::vector<double> points;
    for (double step = width, x = box_low - step / 4; x > low; x -= step, step *= 2) points.push_back(x);
    points.push_back(low);
    std::reverse(points.begin(), points.end());
    for (double step = width, x = box_high + step / 4; x < high; x += step, step *= 2) points.push_back(x);
    points.push_back(high);
    return points;
  }

  double refine(const Cell& c, double coarse, int depth) {
    const double s = (c.s0 + c.s1) / 2, phi = (c.phi0 + c.phi1) / 2;
    const std::array<Cell, 4> quarters{
        {{c.s0, s, c.phi0, phi}, {s, c.s1, c.phi0, phi}, {c.s0, s, phi, c.phi1}, {s, c.s1, phi, c.phi1}}};
    std::array<double, 4> parts{};
    double fine = 0;
    for (int i = 0; i < 4; ++i) fine += parts[i] = gauss(quarters[i]);
    const double difference = std::abs(fine - coarse);
    if (difference <= relative_ * fine + std::ldexp(absolute_, -depth) || depth == kMaxDepth) {
      error_ += difference;
      return fine;
    }
    double sum = 0;
    for (int i = 0; i < 4; ++i) sum += refine(quarters[i], parts[i], depth + 1);
    return sum;
  }

  double gauss(const Cell& c) {
    static constexpr std::array<double, 3> kNodes{-0.7745966692414834, 0, 0.7745966692414834};
    static constexpr std::array<double, 3> kWeights{5.0 / 9, 8.0 / 9, 5.0 / 9};
    const double hs = (c.s1 - c.s0) / 2, hp = (c.phi1 - c.phi0) / 2;
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const double s = c.s0 + hs * (1 + kNodes[i]);
      for (int j = 0; j < 3; ++j) {
        const double phi = c.phi0 + hp * (1 + kNodes[j]);
        sum += kWeights[i] * kWeights[j] * 2 * s * density_(chart_.to_direction({s, phi}));
      }
    }
    evaluations_ += 9;
    return sum * hs * hp;
  }

  const DirectionDensity& density_;
  const Chart& chart_;
  double relative_, absolute_;
  const BinGrid& bins_;
  std::vector<double> in_bins_;
  double error_ = 0;
  std::size_t evaluations_ = 0;
};

}  // namespace

std::uint64_t TestRandom::next() {
  state_ += 0x9e3779b97f4a7c15U;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

Float TestRandom::uniform() { return static_cast<Float>(next() >> 40) * Float(0x1p-24); }

std::string SamplingTestResult::text() const {
  std::ostringstream out;
  out << "chi2 " << statistic << " over " << degrees_of_freedom << " degrees of freedom, p = " << p_value
      << "; kept " << kept << ", integral " << integral << " +- " << integral_error
      << ", p = " << p_value_kept << "; " << below_horizon << " below the horizon; " << cells << " cells, "
      << evaluations << " density evaluations";
  return out.str();
}

SamplingTestResult test_sampling(const DrawDirection& draw, const DirectionDensity& density,
                                 const SamplingTestOptions& options) {
  const Chart chart(options.azimuth_zero);
  TestRandom random(options.seed);
  std::vector<CellPoint> pilots;
  for (std::size_t i = 0; i < options.pilots; ++i) {
    if (const std::optional<Vec3> w = draw(random)) pilots.push_back(chart.to_cell(*w));
  }
  const CellTree tree(std::move(pilots), options.pilots_per_cell);

  SamplingTestResult result;
  result.cells = tree.cells();
  const BinGrid bins(options.bin_rows, options.bin_columns);
  std::vector<CellCount> counts(result.cells), bin_counts(bins.size());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < options.samples; ++i) {
    const std::optional<Vec3> w = draw(random);
    if (!w) continue;
    ++kept;
    if (!(w->z > 0)) ++result.below_horizon;
    const CellPoint at = chart.to_cell(*w);
    ++counts[tree.find(at)].observed;
    if (!bin_counts.empty()) ++bin_counts[bins.find(at)].observed;
  }
  Quadrature quadrature(density, chart, options.quadrature_tolerance,
                        options.quadrature_tolerance / static_cast<double>(tree.leaves().size()), bins);
  for (const Leaf& leaf : tree.leaves()) {
    const double mass = quadrature.integrate(leaf);
    counts[leaf.cell].expected += mass;
    result.integral += mass;
  }
  result.integral_error = quadrature.error();
  result.evaluations = quadrature.evaluations();

  const auto n = static_cast<double>(options.samples);
  result.kept = static_cast<double>(kept) / n;
  const double variance = std::max(result.kept * (1 - result.kept), 1 / n) / n;
  const double excess = std::max(std::abs(result.kept - result.integral) - result.integral_error, 0.0);
  result.p_value_kept = std::erfc(excess / std::sqrt(2 * variance));

  if (!(result.integral > 0)) return result;  // nothing to draw: told apart by p_value_kept
  const PearsonTest shape = test_shape(std::move(counts), static_cast<double>(kept), result.integral);
  result.statistic = shape.statistic;
  result.degrees_of_freedom = shape.degrees_of_freedom;
  result.p_value = shape.p_value;
  if (!bin_counts.empty()) {
    for (std::size_t i = 0; i < bin_counts.size(); ++i) bin_counts[i].expected = quadrature.in_bins()[i];
    result.p_value_bins =
        test_shape(std::move(bin_counts), static_cast<double>(kept), result.integral).p_value;
  }
  return result;
}

}  // namespace spectrace::test
