// SPDX-License-Identifier: Apache-2.0
#include "materials/tabulated_brdf.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/math/math.h"
#include "materials/lambert.h"

namespace spectrace {

TabulatedBrdf::TabulatedBrdf(std::shared_ptr<const HalfDifferenceTable> table) : table_(std::move(table)) {
  SPECTRACE_CHECK(table_ != nullptr && table_->q.size() == table_->grid.size() * table_->axis.size() &&
                  (table_->odd.empty() || table_->odd.size() == table_->q.size()));
}

BsdfValue TabulatedBrdf::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (!(wo.z > 0 && wi.z > 0)) return {};
  const SpectralAxis::Lookup lookup = table_->axis.lookup(at.lambda);
  const GridPoint point = table_->grid.locate(to_half_difference(wo, wi));
  BsdfValue result{.value_cos = {}, .pdf = wi.z * kInvPi};
  const auto at_cell = [&](const std::vector<float>& values, std::size_t i) {
    return lookup.apply(&values[point.cell[i] * table_->axis.size()]) * Float(point.cell_weight[i]);
  };
  for (std::size_t i = 0; i < point.cell.size(); ++i) result.value_cos += at_cell(table_->q, i);
  result.value_cos = result.value_cos * (wi.z / (wi.z + wo.z));
  if (!table_->odd.empty()) {
    for (std::size_t i = 0; i < point.cell.size(); ++i) {
      result.value_cos += at_cell(table_->odd, i) * Float(point.odd_sign[i % 2]);
    }
    for (int lane = 0; lane < kLanes; ++lane)
      result.value_cos[lane] = std::max(result.value_cos[lane], Float(0));
  }
  return result;
}

LobeValues TabulatedBrdf::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  return {.diffuse = {}, .fresnel = evaluate(wo, wi, at).value_cos, .diffraction = {}};
}

std::optional<BsdfSample> TabulatedBrdf::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  return sample_by_cosine(*this, wo, u, at);
}

}  // namespace spectrace
