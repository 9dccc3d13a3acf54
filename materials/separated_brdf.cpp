// SPDX-License-Identifier: Apache-2.0
#include "materials/separated_brdf.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>
#include <vector>

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

bool above_horizon(Vec3 wo, Vec3 wi) { return wo.z > 0 && wi.z > 0; }

}  // namespace

struct SeparatedBrdf::Data {
  Data(SeparatedSource tables, SeparationModel chosen)
      : source(std::move(tables)), model(chosen), sampler(source, model) {
    std::visit(
        [&](const auto& t) {
          SPECTRACE_CHECK(t != nullptr);
          axis = t->axis;
          albedo_d = t->c_d;
        },
        source);
    for (float c : albedo_d) mean_albedo_d += Float(c) / Float(albedo_d.size());
  }

  SeparatedSource source;
  SeparationModel model;
  SeparatedSampler sampler;
  SpectralAxis axis;
  std::vector<float> albedo_d;  // c_d
  Float mean_albedo_d = 0;

  /// Both lobes at a pair of directions, before their colours, times (cosθi + cosθo): bounded however low
  /// either direction (hard case H3).
  struct Shape {
    Float diffuse = 0, specular = 0;
    Float to_value_cos = 0;  ///< cosθi / (cosθi + cosθo), at most 1
  };
  template <typename Tables>
  [[nodiscard]] Shape shape(const Tables& tables, Vec3 wo, Vec3 wi, const GridPoint& point) const {
    Shape shape{.diffuse = (wi.z + wo.z) * kInvPi, .to_value_cos = wi.z / (wi.z + wo.z)};
    shape.diffuse *= diffuse_shape_at(tables, point);
    if (!sampler.is_empty()) shape.specular = specular_at(tables, point);
    return shape;
  }
  /// All of ρ (cosθi + cosθo). What the residual takes away it takes from the rest: never below 0.
  template <typename Tables>
  [[nodiscard]] SampledSpectrum total(const Tables& tables, const GridPoint& point, const Shape& shape,
                                      const SampledSpectrum& albedo,
                                      const SpectralAxis::Lookup& lookup) const {
    SampledSpectrum sum = albedo * shape.diffuse;
    if (shape.specular > 0) sum += spectral_factor(tables, model, point, lookup) * shape.specular;
    if (model == SeparationModel::kResidual && !tables.residual.is_empty()) {
      sum += tables.residual.at(point, 1 - shape.to_value_cos, lookup) *
             (mean_albedo_d * shape.diffuse + shape.specular);
      sum = sum.clamped_at_zero();
    }
    return sum;
  }
  /// What depends on wo and the wavelengths alone.
  struct Outgoing {
    SampledSpectrum c_d;
    SeparatedSampler::Elevation elevation;
    /// Probability of the specular lobe, by its share of the light that leaves; of an empty lobe 0, and 1
    /// where there is no other.
    Float specular_share = 0;
    [[nodiscard]] bool is_black() const { return specular_share == 0 && c_d.is_zero(); }
  };
  [[nodiscard]] Outgoing outgoing(double theta_o, const SpectralAxis::Lookup& lookup) const {
    Outgoing out{.c_d = lookup.apply(albedo_d.data()), .elevation = SeparatedSampler::elevation(theta_o)};
    if (sampler.is_empty()) return out;
    out.specular_share = 1;
    if (out.c_d.is_zero()) return out;
    const Float diffuse = out.c_d.average(), specular = sampler.albedo(out.elevation, lookup).average();
    out.specular_share = std::clamp(specular / (specular + diffuse), kMinLobeShare, 1 - kMinLobeShare);
    return out;
  }
  [[nodiscard]] Float pdf(Vec3 wi, const PairGeometry& pair, const Outgoing& from) const {
    const Float cosine = wi.z * kInvPi;
    if (from.specular_share == 0) return cosine;
    const Float cosine_share = 1 - from.specular_share * (1 - kCosineShare);
    return cosine_share * cosine + (1 - cosine_share) * sampler.pdf(pair, from.elevation);
  }
  /// Where the pair falls in the grid. The tables are larger than the caches: what they hold there is asked
  /// for at once, and used last.
  [[nodiscard]] GridPoint locate(const HalfDifference& angles) const {
    return std::visit(
        [&](const auto& tables) {
          const GridPoint point = tables->grid.locate(angles);
          prefetch(*tables, point);
          return point;
        },
        source);
  }
  [[nodiscard]] BsdfValue value(Vec3 wo, Vec3 wi, const PairGeometry& pair, const GridPoint& point,
                                const Outgoing& from, const SpectralAxis::Lookup& lookup) const {
    const Float density = pdf(wi, pair, from);
    return std::visit(
        [&](const auto& tables) {
          const Shape at = shape(*tables, wo, wi, point);
          return BsdfValue{total(*tables, point, at, from.c_d, lookup) * at.to_value_cos, density};
        },
        source);
  }
};

SeparatedBrdf::SeparatedBrdf(SeparatedSource source, SeparationModel model)
    : data_(std::make_shared<const Data>(std::move(source), model)) {}

SeparationModel SeparatedBrdf::model() const { return data_->model; }

BsdfValue SeparatedBrdf::evaluate(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (!above_horizon(wo, wi)) return {};
  const PairGeometry pair = geometry_of(wo, wi);
  const GridPoint point = data_->locate(pair.angles);
  const SpectralAxis::Lookup lookup = data_->axis.lookup(at.lambda);
  const Data::Outgoing from = data_->outgoing(pair.theta_o, lookup);
  return from.is_black() ? BsdfValue{} : data_->value(wo, wi, pair, point, from, lookup);
}

LobeValues SeparatedBrdf::evaluate_lobes(Vec3 wo, Vec3 wi, const ShadingPoint& at) const {
  if (!above_horizon(wo, wi)) return {};
  const GridPoint point = data_->locate(to_half_difference(wo, wi));
  const SpectralAxis::Lookup lookup = data_->axis.lookup(at.lambda);
  const SampledSpectrum c_d = lookup.apply(data_->albedo_d.data());
  return std::visit(
      [&](const auto& tables) {
        const SeparationModel model = data_->model;
        const Data::Shape shape = data_->shape(*tables, wo, wi, point);
        const Float specular_cos = shape.specular * shape.to_value_cos;
        LobeValues lobes;
        lobes.diffuse = c_d * (shape.diffuse * shape.to_value_cos);
        if (model == SeparationModel::kSun || model == SeparationModel::kFresnel) {
          if (specular_cos > 0) {
            lobes.fresnel = spectral_factor(*tables, model, point, lookup) * specular_cos;
          }
          return lobes;
        }
        if (specular_cos > 0) {
          const auto factor = [&](SeparationModel m) { return spectral_factor(*tables, m, point, lookup); };
          const SampledSpectrum fresnel = factor(SeparationModel::kFresnel);
          lobes.fresnel = fresnel * specular_cos;
          // eq. 21
          lobes.diffraction = (factor(SeparationModel::kDiffraction) - fresnel) * specular_cos;
        }
        if (model == SeparationModel::kResidual) {
          lobes.residual =
              data_->total(*tables, point, shape, c_d, lookup) * shape.to_value_cos - lobes.total();
        }
        return lobes;
      },
      data_->source);
}

std::optional<BsdfSample> SeparatedBrdf::sample(Vec3 wo, const BsdfRandom& u, const ShadingPoint& at) const {
  if (!(wo.z > 0)) return std::nullopt;
  const SpectralAxis::Lookup lookup = data_->axis.lookup(at.lambda);
  const Data::Outgoing from = data_->outgoing(theta_of(wo), lookup);
  if (from.is_black()) return std::nullopt;

  // [0, share): specular, its first 1 - kCosineShare by the table.
  const Float share = from.specular_share;
  const bool specular = u.lobe < share || share == 1;
  const bool by_table = u.lobe < share * (1 - kCosineShare);
  const std::optional<Vec3> wi = by_table ? data_->sampler.sample(wo, from.elevation, u.direction)
                                          : sample_cosine_hemisphere(u.direction);
  if (!wi || !(wi->z > 0)) return std::nullopt;

  const PairGeometry pair = geometry_of(wo, *wi);
  const BsdfValue value = data_->value(wo, *wi, pair, data_->locate(pair.angles), from, lookup);
  if (!std::isnormal(value.pdf)) return std::nullopt;  // 1 / pdf overflows below the normal numbers
  return BsdfSample{.wi = *wi,
                    .weight = value.value_cos / value.pdf,
                    .pdf = value.pdf,
                    .lobe = specular ? Lobe::kSpecular : Lobe::kDiffuse};
}

}  // namespace spectrace
