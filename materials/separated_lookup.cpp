// SPDX-License-Identifier: Apache-2.0
#include "materials/separated_lookup.h"

#include <algorithm>
#include <array>

namespace spectrace {
namespace {

template <typename Values>
bool any_set(const Values& values) {
  return std::any_of(values.begin(), values.end(), [](auto x) { return x != 0; });
}

void add_row(const std::vector<float>& table, std::size_t at, float weight, std::vector<double>& row) {
  for (std::size_t k = 0; k < row.size(); ++k) row[k] += double(weight) * double(table[at * row.size() + k]);
}

/// Σ over the terms of their weight, blended between nodes of `table` [node][rank], times their basis.
template <std::size_t N>
SampledSpectrum product_at(const CompactTables& tables, const std::vector<float>& table,
                           const std::array<std::uint32_t, N>& nodes, const std::array<float, N>& weights,
                           const SpectralAxis::Lookup& lookup) {
  const std::size_t rank = tables.rank, n = tables.axis.size();
  std::array<const float*, N> terms;
  for (std::size_t i = 0; i < N; ++i) terms[i] = &table[nodes[i] * rank];
  const float* basis = tables.basis.data();
  SampledSpectrum s;
  std::array<float, 3> rgb{};  // linear: three channels added up first are cheaper than kLanes
  for (std::size_t k = 0; k < rank; ++k, basis += n) {
    float weight = 0;
    for (std::size_t i = 0; i < N; ++i) weight += weights[i] * terms[i][k];
    if (lookup.is_rgb) {
      for (std::size_t c = 0; c < 3; ++c) rgb[c] += weight * basis[c];
    } else {
      s += lookup.apply(basis) * Float(weight);
    }
  }
  return lookup.is_rgb ? lookup.apply(rgb.data()) : s;
}

using Weights = std::array<float, kMaxSpectralRank>;

/// Weights of the basis at a point, for s_F or s_D.
Weights weights_at(const CompactTables& tables, SeparationModel model, const GridPoint& point) {
  Weights sum{};
  const auto add = [&](const std::vector<float>& table, std::size_t at, float weight) {
    const float* const terms = &table[at * tables.rank];
    for (std::size_t k = 0; k < tables.rank; ++k) sum[k] += weight * terms[k];
  };
  if (model == SeparationModel::kFresnel) {
    for (std::size_t i = 0; i < 2; ++i) add(tables.s_fresnel, point.theta_d[i], point.theta_d_weight[i]);
  } else {
    for (std::size_t i = 0; i < 4; ++i) add(tables.s_diffraction, point.angular[i], point.angular_weight[i]);
  }
  return sum;
}

}  // namespace

SeparatedSource read_separated_source(const std::filesystem::path& file) {
  return separated_source(TensorFile::read(file));
}

SeparatedSource separated_source(const TensorFile& tensors) {
  if (is_compact(tensors)) return std::make_shared<const CompactTables>(compact_from_tensors(tensors));
  return std::make_shared<const SeparatedTables>(separated_from_tensors(tensors));
}

SeparationModel richest_model(const SeparatedSource& source) {
  return std::visit(
      [](const auto& tables) {
        if (!tables->residual.is_empty()) return SeparationModel::kResidual;
        if (!tables->s_diffraction.empty()) return SeparationModel::kDiffraction;
        return tables->s_fresnel.empty() ? SeparationModel::kSun : SeparationModel::kFresnel;
      },
      source);
}

bool has_specular(const SeparatedTables& tables, SeparationModel model) {
  return any_set(tables.rho_s) && any_set(model == SeparationModel::kSun       ? tables.s_sun
                                          : model == SeparationModel::kFresnel ? tables.s_fresnel
                                                                               : tables.s_diffraction);
}
bool has_specular(const CompactTables& tables, SeparationModel model) {
  return any_set(tables.rho_s.code) && any_set(model == SeparationModel::kSun       ? tables.s_sun
                                               : model == SeparationModel::kFresnel ? tables.s_fresnel
                                                                                    : tables.s_diffraction);
}

SampledSpectrum spectral_factor(const SeparatedTables& tables, SeparationModel model, const GridPoint& point,
                                const SpectralAxis::Lookup& lookup) {
  const std::size_t n = tables.axis.size();
  if (model == SeparationModel::kSun) return lookup.apply(tables.s_sun.data());
  SampledSpectrum s;
  if (model == SeparationModel::kFresnel) {
    for (std::size_t i = 0; i < 2; ++i) {
      s += lookup.apply(&tables.s_fresnel[point.theta_d[i] * n]) * Float(point.theta_d_weight[i]);
    }
    return s;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    s += lookup.apply(&tables.s_diffraction[point.angular[i] * n]) * Float(point.angular_weight[i]);
  }
  return s;
}

SampledSpectrum spectral_factor(const CompactTables& tables, SeparationModel model, const GridPoint& point,
                                const SpectralAxis::Lookup& lookup) {
  if (model == SeparationModel::kSun) return lookup.apply(tables.s_sun.data());
  const SampledSpectrum s =
      model == SeparationModel::kFresnel
          ? product_at(tables, tables.s_fresnel, point.theta_d, point.theta_d_weight, lookup)
          : product_at(tables, tables.s_diffraction, point.angular, point.angular_weight, lookup);
  return s.clamped_at_zero();
}

void spectral_row(const SeparatedTables& tables, SeparationModel model, const GridPoint& point,
                  std::vector<double>& row) {
  std::fill(row.begin(), row.end(), 0.0);
  if (model == SeparationModel::kSun) {
    add_row(tables.s_sun, 0, 1, row);
  } else if (model == SeparationModel::kFresnel) {
    for (std::size_t i = 0; i < 2; ++i)
      add_row(tables.s_fresnel, point.theta_d[i], point.theta_d_weight[i], row);
  } else {
    for (std::size_t i = 0; i < 4; ++i)
      add_row(tables.s_diffraction, point.angular[i], point.angular_weight[i], row);
  }
}

void spectral_row(const CompactTables& tables, SeparationModel model, const GridPoint& point,
                  std::vector<double>& row) {
  std::fill(row.begin(), row.end(), 0.0);
  if (model == SeparationModel::kSun) return add_row(tables.s_sun, 0, 1, row);
  const Weights weights = weights_at(tables, model, point);
  for (std::size_t k = 0; k < tables.rank; ++k) add_row(tables.basis, k, weights[k], row);
  for (double& s : row) s = std::max(s, 0.0);
}

}  // namespace spectrace
