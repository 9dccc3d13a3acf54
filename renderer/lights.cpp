// SPDX-License-Identifier: Apache-2.0
#include "renderer/lights.h"

#include <algorithm>
#include <functional>
#include <numeric>

#include "core/base/error.h"
#include "core/base/overloaded.h"
#include "core/math/math.h"

namespace spectrace {

namespace {

/// What the table keeps: 1 / the number of lights, as far as this. The fewer there are the less an estimate
/// can gain, and it knows nothing of shadows (ADR 0011).
constexpr Float kLeastTableShare = Float(0.125);

/// Mean over wavelengths as paths draw them.
double mean_over(const WavelengthDistribution& wavelengths, const std::function<double(Float)>& at) {
  constexpr int kSteps = 64;  // by quantiles: ample for a choice that need not be exact
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    sum += at(wavelengths.sample((Float(i) + Float(0.5)) / kSteps).lambda_nm(0));
  }
  return sum / kSteps;
}

double mean_of(const WavelengthDistribution& wavelengths, const Spectrum& spectrum) {
  return mean_over(wavelengths, [&](Float nm) { return double(spectrum.at(nm)); });
}

std::optional<LightSample> sample_point(Vec3 position, const Spectrum& intensity, Vec3 from,
                                        const SampledWavelengths& lambda) {
  const Vec3 way = position - from;
  const Float distance_squared = length_squared(way);
  if (!(distance_squared > 0)) {
    return std::nullopt;
  }
  return LightSample{way / std::sqrt(distance_squared), position, intensity.sample(lambda) / distance_squared,
                     1};
}

std::optional<LightSample> sample_one(const PointLight& point, Vec3 from, const SampledWavelengths& lambda) {
  return sample_point(point.position, point.intensity, from, lambda);
}

std::optional<LightSample> sample_one(const SpotLight& spot, Vec3 from, const SampledWavelengths& lambda) {
  std::optional<LightSample> sample = sample_point(spot.position, spot.intensity, from, lambda);
  if (sample) {
    sample->radiance *= spot.share_towards(-sample->wi);
  }
  return sample;
}

std::optional<LightSample> sample_one(const DirectionalLight& sun, Vec3, const SampledWavelengths& lambda) {
  return LightSample{sun.to_light, std::nullopt, sun.irradiance.sample(lambda), 1};
}

Box box_at(Vec3 position) {
  Box box;
  box.add(position);
  return box;
}
LightBounds bounds_of(const PointLight& light, double intensity) {
  return bounds_around(box_at(light.position), 0, intensity);
}
/// Estimates of what faces a way end at a right angle to it: wider spots count as points.
LightBounds bounds_of(const SpotLight& light, double intensity) {
  const Box box = box_at(light.position);
  return light.no_drop < 1 ? bounds_facing(box, light.axis, intensity) : bounds_around(box, 0, intensity);
}

/// One thing that lights: some consecutive lights and their powers.
struct Emitter {
  std::vector<double> powers;
  [[nodiscard]] double total() const { return std::accumulate(powers.begin(), powers.end(), 0.0); }
};

/// Probability of each light, see Lights::choose().
std::vector<double> choice_probabilities(const std::vector<Emitter>& emitters) {
  const auto lights = [](const Emitter& e) { return e.total() > 0; };
  const double count = double(std::count_if(emitters.begin(), emitters.end(), lights));
  double all = 0, largest = 0;
  for (const Emitter& e : emitters) {
    largest = std::max(largest, e.total());
  }
  for (const Emitter& e : emitters) {
    all += largest > 0 ? e.total() / largest : 0;  // relative, so that powers of 1e300 cannot overflow
  }
  std::vector<double> result;
  for (const Emitter& e : emitters) {
    const double total = e.total();
    const double chosen = total > 0 ? 0.5 / count + 0.5 * (total / largest) / all : 0;
    for (double power : e.powers) {
      result.push_back(total > 0 ? chosen * (power / total) : 0);
    }
  }
  return result;
}

}  // namespace

Lights::Lights(std::vector<AreaLight> area, const std::vector<std::uint32_t>& groups,
               std::vector<Spectrum> emissions, std::vector<DeltaLight> delta,
               std::optional<Environment> environment, const WavelengthDistribution& observer,
               Float scene_radius)
    : area_(std::move(area)),
      emissions_(std::move(emissions)),
      delta_(std::move(delta)),
      environment_(std::move(environment)),
      emission_area_(emissions_.size()),
      // 1e-30: an empty scene has no disk.
      scene_disk_(std::max(kPi64 * sqr(double(scene_radius)), 1e-30)) {
  std::vector<Emitter> emitters;
  std::size_t next = 0;
  for (std::uint32_t size : groups) {
    Emitter emitter;
    const double radiance = size > 0 ? mean_of(observer, emissions_[area_[next].emission]) : 0;
    for (std::uint32_t i = 0; i < size; ++i, ++next) {
      const double light = light_area(area_[next].shape);
      emitter.powers.push_back(kPi64 * light * radiance);
      emission_area_[area_[next].emission] += light;
    }
    emitters.push_back(std::move(emitter));
  }
  SPECTRACE_CHECK(next == area_.size());
  for (const DeltaLight& light : delta_) {
    emitters.push_back({{mean_over(observer, [&](Float nm) { return power_of(light, double(nm)); })}});
  }
  if (environment_) {
    const double power = mean_over(observer, [&](Float nm) { return power_of_environment(double(nm)); });
    emitters.push_back({{power * environment_->sampled_share()}});
  }
  double sum = 0;
  for (double p : choice_probabilities(emitters)) {
    probability_.push_back(Float(p));
    cumulative_.push_back(sum += p);
  }
  if (!(sum > 0)) {
    cumulative_.clear();
  }
  const auto count = std::count_if(probability_.begin(), probability_.end(), [](Float p) { return p > 0; });
  table_share_ = std::max(kLeastTableShare, count > 0 ? 1 / Float(count) : 1);
  if (table_share_ < 1) {
    build_tree(observer);
    add_distant(observer);
  }
}

void Lights::build_tree(const WavelengthDistribution& observer) {
  std::vector<double> radiances;
  for (const Spectrum& emission : emissions_) radiances.push_back(mean_of(observer, emission));
  std::vector<LightTree::Leaf> leaves;
  const auto add = [&](std::size_t light, const LightBounds& bounds) {
    if (bounds.intensity() > 0) leaves.push_back({std::uint32_t(light), bounds});
  };
  for (std::size_t i = 0; i < area_.size(); ++i) {
    add(i, light_bounds(area_[i].shape, radiances[area_[i].emission]));
  }
  for (std::size_t i = 0; i < delta_.size(); ++i) {
    std::visit(Overloaded{[&](const DirectionalLight&) {},
                          [&](const auto& light) {
                            add(area_.size() + i, bounds_of(light, mean_of(observer, light.intensity)));
                          }},
               delta_[i]);
  }
  tree_ = LightTree(std::move(leaves), std::uint32_t(probability_.size()));
}

void Lights::add_distant(const WavelengthDistribution& observer) {
  std::vector<double> irradiances;
  for (std::size_t i = 0; i < delta_.size(); ++i) {
    if (const auto* sun = std::get_if<DirectionalLight>(&delta_[i])) {
      distant_.push_back({std::uint32_t(area_.size() + i), sun->to_light});
      irradiances.push_back(mean_of(observer, sun->irradiance));
    }
  }
  if (environment_ && environment_->sampled_share() > 0) {
    distant_.push_back({environment_index(), {}});
    const double radiance =
        mean_over(observer, [&](Float nm) { return double(environment_->mean_radiance(nm)); });
    irradiances.push_back(kPi64 * radiance * environment_->sampled_share());
  }
  if (distant_.empty()) return;
  const double unit =
      tree_.empty() ? *std::max_element(irradiances.begin(), irradiances.end()) : tree_.unit();
  for (std::size_t i = 0; i < distant_.size(); ++i) {
    constexpr double kLargest = 1e30;  // a sum of many is finite
    distant_[i].irradiance = irradiances[i] > 0 ? float(std::min(irradiances[i] / unit, kLargest)) : 0;
  }
}

double Lights::power_of(const DeltaLight& light, double lambda_nm) const {
  return std::visit(Overloaded{[&](const PointLight& point) {
                                 return 4 * kPi64 * double(point.intensity.at(Float(lambda_nm)));
                               },
                               [&](const SpotLight& spot) {
                                 // Smoothstep is 1/2 on average: ∫ over the sphere of share_towards().
                                 const double drop = (double(spot.full_drop) + double(spot.no_drop)) / 2;
                                 return 2 * kPi64 * drop * double(spot.intensity.at(Float(lambda_nm)));
                               },
                               [&](const DirectionalLight& sun) {
                                 return scene_disk_ * double(sun.irradiance.at(Float(lambda_nm)));
                               }},
                    light);
}

double Lights::power_of_environment(double lambda_nm) const {
  return 4 * kPi64 * scene_disk_ * double(environment_->mean_radiance(Float(lambda_nm)));
}

double Lights::power(double lambda_nm) const {
  double sum = environment_ ? power_of_environment(lambda_nm) : 0;
  for (const DeltaLight& light : delta_) sum += power_of(light, lambda_nm);
  for (std::size_t i = 0; i < emissions_.size(); ++i) {
    sum += kPi64 * emission_area_[i] * double(emissions_[i].at(Float(lambda_nm)));
  }
  return sum;
}

std::optional<LightSample> Lights::sample_delta(std::uint32_t light, Vec3 from,
                                                const SampledWavelengths& lambda) const {
  return std::visit([&](const auto& delta) { return sample_one(delta, from, lambda); },
                    delta_[light - area_.size()]);
}

std::optional<LightSample> Lights::sample_environment(Vec2 u, const SampledWavelengths& lambda) const {
  const std::optional<Environment::Sample> s = environment_->sample(u);
  if (!s) {
    return std::nullopt;
  }
  return LightSample{s->wi, std::nullopt, environment_->radiance(s->wi, lambda), s->pdf};
}

}  // namespace spectrace
