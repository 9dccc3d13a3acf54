// SPDX-License-Identifier: Apache-2.0
#include "materials/separated_brdf.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/math/math.h"
#include "materials/half_difference.h"
#include "materials/lambert.h"
#include "materials/separated_sampler.h"

namespace spectrace {
namespace {

// Share of the specular samples drawn by the cosine instead of the table, so that no direction the
// (interpolated) table misses is out of reach: a sample's weight is at most 1/5 % of the table's error there.
constexpr Float kCosineShare = Float(0.05);
// Neither of two lobes that hold energy is chosen less often: the albedo table is a coarse quadrature.
constexpr Float kMinLobeShare = Float(0.02);

Float interpolate(const std::vector<float>& table, const GridPoint& point) {
  Float sum = 0;
  for (std::size_t i = 0; i < point.cell.size(); ++i) sum += point.cell_weight[i] * table[point.cell[i]];
  return sum;
}

bool above_horizon(Vec3 wo, Vec3 wi) { return wo.z > 0 && wi.z > 0; }

}  // namespace

struct SeparatedBrdf::Data {
  Data(std::shared_ptr<const SeparatedTables> t, SeparationModel model)
      : tables(std::move(t)), sampler(*tables, model) {}

  std::shared_ptr<const SeparatedTables> tables;
  SeparatedSampler sampler;

  /// Both lobes at a pair of directions, before their colours.
  struct Shape {
    GridPoint point;
    Float diffuse_cos = 0;   ///< ρ_d cosθi for c_d = 1
    Float specular_cos = 0;  ///< ρ_s cosθi
  };
  [[nodiscard]] Shape shape(Vec3 wo, Vec3 wi) const {
    Shape result;
    result.diffuse_cos = wi.z * kInvPi;
    if (sampler.is_empty() && tables->diffuse_shape.empty()) return result;
    result.point = tables->grid.locate(to_half_difference(wo, wi));
    if (!tables->diffuse_shape.empty())
      result.diffuse_cos *= interpolate(tables->diffuse_shape, result.point);
    // The table holds q = ρ_s (cosθi + cosθo): the quotient is at most 1 however low either direction (hard
    // case H3).
    result.specular_cos = interpolate(tables->rho_s, result.point) * (wi.z / (wi.z + wo.z));
    return result;
  }
  [[nodiscard]] SampledSpectrum s_fresnel(const GridPoint& point, const SpectralAxis::Lookup& lookup) const {
    SampledSpectrum s;
    const std::size_t n = tables->axis.size();
    for (std::size_t i = 0; i < 2; ++i) {
      s += lookup.apply(&tables->s_fresnel[point.theta_d[i] * n]) * point.theta_d_weight[i];
    }
    return s;
  }
  [[nodiscard]] SampledSpectrum s_diffraction(const GridPoint& point,
                                              const SpectralAxis::Lookup& lookup) const {
    SampledSpectrum s;
    const std::size_t n = tables->axis.size();
    for (std::size_t i = 0; i < 4; ++i) {
      s += lookup.apply(&tables->s_diffraction[point.angular[i] * n]) * point.angular_weight[i];
    }
    return s;
  }
  [[nodiscard]] SampledSpectrum spectral_factor(SeparationModel model, const GridPoint& point,
                                                const SpectralAxis::Lookup& lookup) const {
    switch (model) {
      case SeparationModel::kSun:
        return lookup.apply(tables->s_sun.data());
      case SeparationModel::kFresnel:
        return s_fresnel(point, lookup);
      case SeparationModel::kDiffraction:
        return s_diffraction(point, lookup);
    }
    return {};
  }
  /// Probability of the specular lobe at wo, by its share of the light that leaves.
  [[nodiscard]] Float specular_share(Vec3 wo, const SampledSpectrum& c_d,
                                     const SpectralAxis::Lookup& lookup) const {
    if (sampler.is_empty()) return 0;
    if (c_d.is_zero()) return 1;
    const Float diffuse = c_d.average(), specular = sampler.albedo(wo.z, lookup).average();
    return std::clamp(specular / (specular + diffuse), kMinLobeShare, 1 - kMinLobeShare);
  }
  [[nodiscard]] Float pdf(Vec3 wo, Vec3 wi, Float specular_share) const {
    const Float cosine = wi.z * kInvPi;
    if (specular_share == 0) return cosine;
    const Float cosine_share = 1 - specular_share * (1 - kCosineShare);
    return cosine_share * cosine + (1 - cosine_share) * sampler.pdf(wo, wi);
  }
};

SeparatedBrdf::SeparatedBrdf(std::shared_ptr<const SeparatedTables> tables, SeparationModel model)
    : model_(model) {
  SPECTRACE_CHECK(tables != nullptr);
  data_ = std::make_shared<const Data>(std::move(tables), model);
}

const SeparatedTables& SeparatedBrdf::tables() const { return *data_->tables; }

BsdfValue SeparatedBrdf::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (!above_horizon(wo, wi)) return {};
  const SpectralAxis::Lookup lookup = tables().axis.lookup(at.lambda);
  const SampledSpectrum c_d = lookup.apply(tables().c_d.data());
  const Float share = data_->specular_share(wo, c_d, lookup);
  if (share == 0 && c_d.is_zero()) return {};

  const Data::Shape shape = data_->shape(wo, wi);
  BsdfValue result{c_d * shape.diffuse_cos, data_->pdf(wo, wi, share)};
  if (share > 0) result.value_cos += data_->spectral_factor(model_, shape.point, lookup) * shape.specular_cos;
  return result;
}

LobeValues SeparatedBrdf::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (!above_horizon(wo, wi)) return {};
  const SpectralAxis::Lookup lookup = tables().axis.lookup(at.lambda);
  const Data::Shape shape = data_->shape(wo, wi);
  LobeValues lobes;
  lobes.diffuse = lookup.apply(tables().c_d.data()) * shape.diffuse_cos;
  if (data_->sampler.is_empty()) return lobes;

  if (model_ == SeparationModel::kDiffraction) {
    const SampledSpectrum fresnel = data_->s_fresnel(shape.point, lookup);
    lobes.fresnel = fresnel * shape.specular_cos;
    // eq. 21
    lobes.diffraction = (data_->s_diffraction(shape.point, lookup) - fresnel) * shape.specular_cos;
  } else {
    lobes.fresnel = data_->spectral_factor(model_, shape.point, lookup) * shape.specular_cos;
  }
  return lobes;
}

std::optional<BsdfSample> SeparatedBrdf::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (!(wo.z > 0)) return std::nullopt;
  const SpectralAxis::Lookup lookup = tables().axis.lookup(at.lambda);
  const SampledSpectrum c_d = lookup.apply(tables().c_d.data());
  const Float share = data_->specular_share(wo, c_d, lookup);
  if (share == 0 && c_d.is_zero()) return std::nullopt;

  // [0, share): specular, its first 1 - kCosineShare by the table.
  const bool specular = u.lobe < share || share == 1;
  const bool by_table = u.lobe < share * (1 - kCosineShare);
  const std::optional<Vec3> wi =
      by_table ? data_->sampler.sample(wo, u.direction) : sample_cosine_hemisphere(u.direction);
  if (!wi || !(wi->z > 0)) return std::nullopt;

  const BsdfValue value = evaluate(wo, *wi, at);
  if (!std::isnormal(value.pdf)) return std::nullopt;  // 1 / pdf overflows below the normal numbers
  return BsdfSample{.wi = *wi,
                    .weight = value.value_cos / value.pdf,
                    .pdf = value.pdf,
                    .lobe = specular ? Lobe::kSpecular : Lobe::kDiffuse};
}

}  // namespace spectrace
