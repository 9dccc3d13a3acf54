// SPDX-License-Identifier: Apache-2.0
#include "materials/plain_table_brdf.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/math/math.h"
#include "materials/lambert.h"

namespace spectrace {
namespace {

/// The two nodes around a coordinate and their weights.
struct Pair {
  std::array<int, 2> node{};
  std::array<Float, 2> weight{};
};

/// `wraps`: the node after the last is the first.
Pair around(double coordinate, int nodes, bool wraps) {
  const int lower = std::min(static_cast<int>(coordinate), nodes - 1);
  const int upper = lower + 1 < nodes ? lower + 1 : (wraps ? 0 : lower);
  const auto fraction = static_cast<Float>(coordinate - lower);
  return {{lower, upper}, {1 - fraction, fraction}};
}

}  // namespace

PlainTableBrdf::PlainTableBrdf(std::shared_ptr<const HalfDifferenceTable> table) : table_(std::move(table)) {
  SPECTRACE_CHECK(table_ != nullptr && table_->q.size() == table_->grid.size() * table_->axis.size());
}

BsdfValue PlainTableBrdf::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (!(wo.z > 0 && wi.z > 0)) return {};
  const HalfDifferenceGrid& grid = table_->grid;
  const HalfDifference angles = to_half_difference(wo, wi);
  const Pair h = around(grid.coordinate_h(angles.theta_h), grid.n_theta_h, false);
  const Pair d = around(grid.coordinate_d(angles.theta_d), grid.n_theta_d, false);
  const Pair p = around(grid.coordinate_p(angles.phi_d), grid.n_phi_d, true);
  const SpectralAxis::Lookup lookup = table_->axis.lookup(at.lambda);
  SampledSpectrum sum{};
  Float weights = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const unsigned i = corner >> 2, j = (corner >> 1) & 1, k = corner & 1;
    const float* const spectrum =
        &table_->q[grid.index(h.node[i], d.node[j], p.node[k]) * table_->axis.size()];
    if (std::isnan(*spectrum)) continue;
    const Float weight = h.weight[i] * d.weight[j] * p.weight[k];
    sum += lookup.apply(spectrum) * weight;
    weights += weight;
  }
  BsdfValue result{.value_cos = {}, .pdf = wi.z * kInvPi};
  if (weights > 0) result.value_cos = sum * (wi.z / weights);
  return result;
}

LobeValues PlainTableBrdf::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  return {.diffuse = {}, .fresnel = evaluate(wo, wi, at).value_cos, .diffraction = {}};
}

std::optional<BsdfSample> PlainTableBrdf::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  return sample_by_cosine(*this, wo, u, at);
}

}  // namespace spectrace
