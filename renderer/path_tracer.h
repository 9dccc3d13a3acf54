// SPDX-License-Identifier: Apache-2.0
// One path from the camera, vertex by vertex, so that many can go in step: next-event estimation and BSDF
// sampling joined by multiple importance sampling (Veach 1997, ch. 9-10), Russian roulette, hero wavelengths
// (Wilkie et al. 2014). What a scene does not need is compiled away by `if constexpr`; what remains computes
// the same bits (ADR 0006).
#pragma once

#include "core/math/math.h"
#include "core/math/sampler.h"
#include "renderer/lobe_shares.h"
#include "renderer/path_light.h"
#include "renderer/path_value.h"
#include "renderer/path_vertex.h"
#include "renderer/render_job.h"
#include "renderer/scene.h"
#include "renderer/surface.h"
#include "renderer/uv_footprint.h"

namespace spectrace {

/// Roulette: survival lies in [1/20, 19/20]. Below, weights of survivors would grow without bound (hard case
/// H10 above: measured albedos over 1 must still end).
inline constexpr Float kMinSurvival = Float(0.05), kMaxSurvival = Float(0.95);
template <Features kFeatures>
class PathTracer {
 public:
  PathTracer(const RenderJob& job, const Sampler& sampler, Float wavelength, const Ray& camera_ray)
      : scene_(job.scene),
        albedos_(job.albedos),
        sampler_(sampler),
        lambda_(sample_wavelengths(job, sampler, wavelength)),
        ray_(camera_ray) {
    if constexpr (kFeatures.textures) cone_ = job.scene.cone(camera_ray, sampler.sample());
  }

  /// The ray whose hit advance() wants.
  [[nodiscard]] const Ray& ray() const { return ray_; }

  /// Gathers what comes along ray() and turns it to go on. False: the path ends.
  [[nodiscard]] bool advance(const std::optional<Intersection>& hit) {
    if constexpr (kFeatures.dispersion) {
      if (terminate_next_) terminate_secondary();
    }
    shadow_ray_.reset();
    if (!hit) {
      add_background(ray_.direction);
      return false;
    }
    const SurfacePoint point = surface_point<kQuery>(scene_.geometry, ray_, *hit);
    if constexpr (kFeatures.more_aovs) {
      if (wants_first_hit()) {
        value_.first_hit.come_to(double(hit->t), {false, hit->shape, hit->instance, point.material});
      }
    }
    add_emission(point, ray_.direction);
    if constexpr (kFeatures.textures) {
      if (scene_.has_images) {
        cone_ = cone_.at(length(point.position - ray_.origin));
        footprint_ = uv_footprint<kQuery>(scene_.geometry, *hit, point, ray_.direction, cone_);
      }
    }
    const bool goes_on = depth_ >= max_depth() ? pass(point) : scatter(point);
    ++vertex_;
    return goes_on;
  }

  /// Towards the light that advance() has chosen, if it may shine; receive_light() where nothing is in
  /// between.
  [[nodiscard]] const std::optional<Ray>& shadow_ray() const { return shadow_ray_; }
  void receive_light() { light_.receive_awaited(); }

  [[nodiscard]] const PathValue<kFeatures>& finish() {
    light_.move_to(lambda_, value_);
    return value_;
  }

 private:
  static constexpr SurfaceQuery kQuery{.instances = kFeatures.instances, .uv = kFeatures.textures};

  static constexpr bool kParts = kFeatures.specular_parts;

  static SampledWavelengths sample_wavelengths(const RenderJob& job, [[maybe_unused]] const Sampler& sampler,
                                               Float u) {
    if constexpr (kFeatures.spectral_film) {
      if (job.layout.bins) return job.scene.wavelengths.sample(u, sampler.lane_shifts());
    }
    return job.scene.wavelengths.sample(u);
  }

  [[nodiscard]] int max_depth() const {
    if constexpr (kFeatures.indirect) return scene_.integrator.max_depth;
    return std::min(scene_.integrator.max_depth, 1);
  }

  // ---- What arrives -------------------------------------------------------------------------------------

  /// Weight of light met by BSDF sampling, that light sampling finds with `light_pdf` [1/sr].
  [[nodiscard]] Float bsdf_mis_weight(Float light_pdf) const {
    return last_was_delta_ || !scene_.integrator.next_event ? 1 : power_heuristic(last_pdf_, light_pdf);
  }

  void add_background([[maybe_unused]] Vec3 direction) {
    if constexpr (kFeatures.environment) {
      const std::optional<Environment>& environment = scene_.lights.environment();
      if (!environment) return;
      Float weight = 1;
      if (!last_was_delta_) {
        const Float choice = scene_.lights.probability(scene_.lights.environment_index(), last_receiver_);
        weight = bsdf_mis_weight(environment->pdf(direction) * choice);
      }
      light_.template add<Layer::kBackground>(beta_ * environment->radiance(direction, lambda_) * weight,
                                              depth_);
    }
  }

  void add_emission([[maybe_unused]] const SurfacePoint& point, [[maybe_unused]] Vec3 direction) {
    if constexpr (kFeatures.area_lights) {
      if (point.light == kNone || !(dot(direction, point.normal_g) < 0)) return;
      Float weight = 1;
      if (!last_was_delta_) {
        const Float pdf = light_pdf(scene_.lights.shape(point.light), last_receiver_.position, direction,
                                    point.position, point.normal_g);
        weight = bsdf_mis_weight(pdf * scene_.lights.probability(point.light, last_receiver_));
      }
      light_.template add<Layer::kEmission>(beta_ * emission(point.light) * weight, depth_);
    }
  }

  /// Radiance of an area light. Most paths meet the same one at each of their vertices.
  [[nodiscard]] const SampledSpectrum& emission(std::uint32_t area_light) {
    const Spectrum& spectrum = scene_.lights.emission(area_light);
    if (emission_of_ != &spectrum) {
      emission_of_ = &spectrum;
      emission_ = spectrum.sample(lambda_);
    }
    return emission_;
  }

  // ---- What goes on -------------------------------------------------------------------------------------

  using Vertex = PathVertex<kFeatures>;

  [[nodiscard]] Vertex make_vertex(const SurfacePoint& point) const {
    return {point, -ray_.direction, scene_.materials[point.material], shading_point(point, footprint_),
            sampler_.vertex(vertex_)};
  }

  /// Light that may come to a vertex from a source chosen for it.
  struct Incident {
    LightSample light;
    Vec3 wi;  // local
    Float pdf = 0;
    bool is_delta_light = false;
  };
  [[nodiscard]] std::optional<Incident> sample_lights(const Vertex& vertex) {
    const std::optional<Lights::Choice> choice =
        scene_.lights.choose(vertex.receiver(), vertex.numbers.light_choice);
    if (!choice) return std::nullopt;
    bool is_delta_light = true;
    const std::optional<LightSample> light = sample_light_source(vertex, choice->light, is_delta_light);
    if (!light || light->radiance.is_zero()) return std::nullopt;
    const Vec3 wi = vertex.frame.to_local(light->wi);
    if (!vertex.sides_agree(light->wi, wi)) return std::nullopt;
    const Float pdf = light->pdf * choice->probability;
    if (!(pdf > 0)) return std::nullopt;  // a density Float cannot hold: BSDF sampling carries it alone
    return Incident{*light, wi, pdf, is_delta_light};
  }

  void await_light(const Vertex& vertex, const Incident& incident, const BsdfValue& bsdf) {
    if (bsdf.value_cos.is_zero()) return;
    const LightSample& light = incident.light;
    const Float weight = incident.is_delta_light ? Float(1) : power_heuristic(incident.pdf, bsdf.pdf);
    light_.await(beta_ * bsdf.value_cos * light.radiance * (weight / incident.pdf));
    if constexpr (kFeatures.lobe_layers) {
      if (LobeShares* const share = light_.shares_of_awaited()) set_shares(vertex, incident.wi, *share);
    }
    const Ray ray = light.shadow_ray(ray_origin(vertex.point, light.wi));
    if constexpr (kFeatures.nested) {
      if (scene_.has_holes) {
        const Float visible = visibility_through_holes(ray, light);
        if (visible > 0) {
          light_.dim_awaited(visible);
          receive_light();
        }
        return;
      }
    }
    shadow_ray_ = ray;
  }

  void set_shares(const Vertex& vertex, Vec3 wi, LobeShares& share) const {
    share.only = scene_.only_lobe[vertex.point.material];
    if (share.only) return;  // the rest means nothing then
    share = lobe_shares<kParts>(evaluate_lobes(vertex.material, vertex.wo, wi, vertex.at));
  }

  [[nodiscard]] std::optional<LightSample> sample_light_source(const Vertex& vertex, std::uint32_t light,
                                                               bool& is_delta_light) {
    [[maybe_unused]] const Vec2 u = vertex.numbers.light;
    if constexpr (kFeatures.area_lights) {
      if (scene_.lights.is_area(light)) {
        is_delta_light = false;
        const std::optional<LightPoint> point = scene_.lights.sample_area(light, vertex.point.position, u);
        if (!point) return std::nullopt;
        return LightSample{point->wi, point->position, emission(light), point->pdf};
      }
    }
    if constexpr (kFeatures.environment) {
      if (scene_.lights.is_environment(light)) {
        is_delta_light = false;
        return scene_.lights.sample_environment(u, lambda_);
      }
    }
    if constexpr (kFeatures.delta_lights) {
      return scene_.lights.sample_delta(light, vertex.point.position, lambda_);
    }
    return std::nullopt;
  }

  [[nodiscard]] ShadingPoint shading_point(const SurfacePoint& point, const Footprint& footprint) const {
    return {.lambda = lambda_, .uv = point.uv, .footprint = footprint, .v_sign = point.v_sign};
  }

  /// Share of the light that arrives through what lies between.
  [[nodiscard]] Float visibility_through_holes(Ray ray, const LightSample& light) const {
    Float visible = 1;
    RayCone cone = cone_;
    while (const std::optional<Intersection> hit = scene_.accel.intersect(ray)) {
      const SurfacePoint point = surface_point<kQuery>(scene_.geometry, ray, *hit);
      cone = cone.at(length(point.position - ray.origin));
      const Footprint footprint = uv_footprint<kQuery>(scene_.geometry, *hit, point, light.wi, cone);
      visible *= pass_through(scene_.materials[point.material], dot(light.wi, point.normal_g) < 0,
                              shading_point(point, footprint));
      if (!(visible > 0)) return 0;
      ray = light.shadow_ray(ray_origin(point, light.wi));
      if (!(dot(ray.direction, light.wi) > 0)) break;  // the offset has carried it past the light
    }
    return visible;
  }

  [[nodiscard]] std::optional<BsdfSample> sample_vertex(const Vertex& vertex) const {
    return sample(vertex.material, vertex.wo, vertex.bsdf_numbers(), vertex.at);
  }

  bool go_straight_on(const Vertex& vertex, const BsdfSample& through) {
    beta_ *= through.weight;
    ray_ = {ray_origin(vertex.point, ray_.direction), ray_.direction};
    return true;
  }

  /// The last ray only fetches light, which may shine through holes. False: the path ends.
  bool pass([[maybe_unused]] const SurfacePoint& point) {
    const bool may_pass = kFeatures.nested && scene_.has_holes;
    if (!may_pass && !wants_first_hit()) return false;
    const Vertex vertex = make_vertex(point);
    if constexpr (kFeatures.nested) {
      if (const auto s = may_pass ? sample_vertex(vertex) : std::nullopt; s && s->passes) {
        return go_straight_on(vertex, *s);
      }
    }
    if (wants_first_hit()) look_at(vertex);
    return false;
  }

  // ---- What is seen at the first hit --------------------------------------------------------------------

  [[nodiscard]] bool wants_first_hit() const {
    if constexpr (kFeatures.more_aovs) return !value_.first_hit.is_known;
    return false;
  }
  void look_at([[maybe_unused]] const Vertex& vertex) {
    if constexpr (kFeatures.more_aovs) {
      value_.first_hit.surface.is_known = true;
      if (is_delta(vertex.material)) return;
      const LobeAlbedo albedo =
          albedos_ != nullptr ? albedos_->at(vertex.material, vertex.wo, vertex.at) : LobeAlbedo{};
      value_.first_hit.know(albedo, vertex.frame.n, vertex.point.position);
    }
  }

  /// Next-event estimation and the next ray. False: the path ends.
  bool scatter(const SurfacePoint& point) {
    const Vertex vertex = make_vertex(point);
    if (const Float last = scene_.last_measured_cosine[point.material]; last > 0) {
      ++value_.measured;
      value_.extrapolated += std::abs(vertex.wo.z) < last ? 1 : 0;
    }
    bool only_delta = false;
    if constexpr (kFeatures.delta_lobes) only_delta = is_delta(vertex.material);
    std::optional<Incident> incident;
    if (!only_delta && scene_.integrator.next_event) incident = sample_lights(vertex);
    const Scattering scattered =
        spectrace::scatter(vertex.material, vertex.wo, incident ? std::optional(incident->wi) : std::nullopt,
                           vertex.bsdf_numbers(), vertex.at);
    if (incident) await_light(vertex, *incident, scattered.towards_light);

    const std::optional<BsdfSample>& s = scattered.next;
    const bool passes = kFeatures.nested && s && s->passes;
    if (!passes && wants_first_hit()) look_at(vertex);
    if (!s || s->weight.is_zero()) return false;
    if (passes) return go_straight_on(vertex, *s);
    const Vec3 wi = vertex.frame.to_world(s->wi);
    if (!vertex.sides_agree(wi, s->wi)) return false;
    if constexpr (kFeatures.lobe_layers) {
      if (!light_.is_split() && !s->is_delta) set_shares(vertex, s->wi, light_.split_at(depth_));
    }
    beta_ *= s->weight;
    if constexpr (kFeatures.transmission) radiance_scale_ *= s->radiance_scale;
    if (!beta_.is_finite() || !is_finite(wi)) {
      value_.valid = false;
      return false;
    }
    if constexpr (kFeatures.dispersion) {
      if (s->is_dispersive && !lambda_.secondary_terminated()) {
        terminate_next_ = true;
        for (int lane = 1; lane < kLanes; ++lane) beta_[lane] = 0;
      }
    }
    last_was_delta_ = s->is_delta;
    last_pdf_ = s->pdf;
    last_receiver_ = vertex.receiver();
    ray_ = {ray_origin(vertex.point, wi), wi};
    ++depth_;
    return survives(vertex.numbers.roulette);
  }

  /// From here the path knows its hero only. What the other lanes have gathered before was theirs to gather:
  /// it is kept (throwing it away is unbiased as well, but coloured noise).
  void terminate_secondary() {
    terminate_next_ = false;
    light_.move_to(lambda_, value_);
    lambda_.terminate_secondary();
  }

  /// Unbiased: what survives is divided by its probability. The last ray only fetches light: not worth a
  /// game, and so a kernel without indirect light need not know of any.
  bool survives([[maybe_unused]] Float u) {
    if constexpr (kFeatures.indirect) {
      if (depth_ >= scene_.integrator.roulette_depth && depth_ < scene_.integrator.max_depth) {
        const Float survival = std::clamp(beta_.max() / radiance_scale_, kMinSurvival, kMaxSurvival);
        if (!(u < survival)) return false;
        beta_ *= 1 / survival;
      }
    }
    return true;
  }

  const Scene& scene_;
  const AlbedoTables* albedos_;
  Sampler sampler_;
  SampledWavelengths lambda_;
  Ray ray_;
  RayCone cone_;         // where ray_ begins; 0 unless some texture is an image
  Footprint footprint_;  // at the vertex at hand
  std::optional<Ray> shadow_ray_;
  const Spectrum* emission_of_ = nullptr;  // whose emission_ is, at these wavelengths
  SampledSpectrum emission_;
  bool terminate_next_ = false;  // once the light of this vertex has arrived
  std::uint32_t vertex_ = 0;     // surfaces met: what random numbers are named after
  int depth_ = 0;                // those of them that scattered the path: holes do not count
  SampledSpectrum beta_{1};
  Float radiance_scale_ = 1;  // what refraction has put into beta_, and takes back
  PathLight<kFeatures> light_;
  PathValue<kFeatures> value_;
  bool last_was_delta_ = true;  // the camera counts as one: no light sample competes
  Float last_pdf_ = 0;
  Receiver last_receiver_;
};

}  // namespace spectrace
