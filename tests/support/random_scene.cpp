// SPDX-License-Identifier: Apache-2.0
#include "tests/support/random_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/chi_square.h"
#include "tests/support/render_scenes.h"

namespace spectrace::test {

namespace {

using Kind = decltype(MaterialDesc::kind);

class Generator {
 public:
  explicit Generator(std::uint64_t seed) : random_(seed) {}

  SceneDesc scene() {
    SceneDesc scene = empty_scene();
    scene.film = {12, 10};
    scene.camera.origin = point(5);
    scene.camera.target = point(1);
    scene.camera.up = unit();
    scene.camera.fov_deg = between(10, 150);
    scene.integrator = {
        .max_depth = int(below(12)), .roulette_depth = int(below(6)), .next_event = !one_in(8)};
    const std::size_t materials = 1 + below(5);
    for (std::size_t i = 0; i < materials; ++i) {
      scene.materials.push_back({.name = std::to_string(i), .where = "", .kind = material(0)});
    }
    for (std::size_t i = 0, n = 1 + below(12); i < n; ++i) {
      ShapeDesc shape = any_shape(std::to_string(below(materials)));
      if (one_in(4)) shape = emitting(std::move(shape), power());
      scene.shapes.push_back(std::move(shape));
    }
    if (!one_in(3)) scene.lights.emplace_back(sky(power()));
    if (one_in(3)) scene.lights.emplace_back(PointLightDesc{point(5), Spectrum::constant(power())});
    if (one_in(3)) scene.lights.emplace_back(DirectionalLightDesc{unit(), Spectrum::constant(power())});
    if (one_in(3)) {
      const Float cone = between(5, 90);
      scene.lights.emplace_back(SpotLightDesc{point(5), unit(), Spectrum::constant(power()), cone, cone / 2});
    }
    return scene;
  }

 private:
  std::size_t below(std::size_t bound) {
    return std::min(std::size_t(double(random_.uniform()) * double(bound)), bound - 1);
  }
  bool one_in(std::size_t n) { return below(n) == 0; }
  Float between(double low, double high) { return Float(low + (high - low) * double(random_.uniform())); }
  Float power() { return Float(std::pow(10.0, double(between(-5, 5)))); }
  Float roughness() { return Float(std::pow(10.0, double(between(-3, 0)))); }
  Ggx ggx() {
    const Float alpha = roughness();
    return {alpha, one_in(3) ? roughness() : alpha};
  }
  Vec3 point(double range) {
    return {between(-range, range), between(-range, range), between(-range, range)};
  }
  Vec3 unit() {
    const double z = double(between(-1, 1)), phi = double(between(0, 6.28)), r = std::sqrt(1 - z * z);
    return {Float(r * std::cos(phi)), Float(r * std::sin(phi)), Float(z)};
  }
  Spectrum reflectance() {
    return TabulatedSpectrum({400, 550, 700}, {between(0, 1), between(0, 1), between(0, 1)});
  }
  Spectrum index() {
    const Float a = between(1.1, 2.2);
    return one_in(2) ? Spectrum::constant(a) : Spectrum(TabulatedSpectrum({400, 700}, {a + Float(0.1), a}));
  }
  ConductorFresnel metal() {
    return {.eta = reflectance(), .k = Spectrum::constant(between(0.5, 6)), .film = {}};
  }

  Kind material(int depth) {
    switch (below(depth < 2 ? 10 : 7)) {
      case 0:
        return Lambert{Texture(reflectance())};
      case 1:
        return SmoothConductor{metal()};
      case 2:
        return RoughConductor{metal(), ggx()};
      case 3:
        return Dielectric{index()};
      case 4:
        return RoughDielectric(index(), ggx());
      case 5:
        return PlasticDesc{reflectance(), index(), one_in(2) ? Float(0) : roughness()};
      case 6:
        return Glossy{.reflectance = Texture(reflectance()),
                      .fresnel = metal(),
                      .ggx = ggx(),
                      .diffuse_scale = Float(0.5),
                      .specular_scale = Float(0.5)};
      case 7:
        return TwoSidedDesc{.parts = {part(depth), part(depth)}};
      case 8:
        return MixDesc{.parts = {part(depth), part(depth)}, .weight = between(0, 1)};
      default:
        return MaskedDesc{.parts = {part(depth)}, .opacity = between(0, 1)};
    }
  }
  MaterialDesc part(int depth) { return {.name = "", .where = "", .kind = material(depth + 1)}; }

  ShapeDesc any_shape(const std::string& material) {
    const Transform turn = translation(point(3)).compose(rotation_z(between(0, 360)));
    const Float size = Float(std::pow(10.0, double(between(-3, 0.5))));
    switch (below(4)) {
      case 0:
        return moved(sphere({0, 0, 0}, size, material), turn);
      case 1:
        return moved(disk({0, 0, 0}, unit(), size, material), turn);
      case 2:
        return moved(quad({0, 0, 0}, unit() * size, unit() * (size * between(0.01, 2)), material), turn);
      default: {
        ShapeDesc mesh{.where = "",
                       .kind = polyhedral_sphere(4 + int(below(8)), 5 + int(below(8))),
                       .material = material};
        return moved(std::move(mesh), turn.compose(scaling({size, size * between(0.01, 1), size})));
      }
    }
  }

  TestRandom random_;
};

}  // namespace

SceneDesc random_scene(std::uint64_t seed) { return Generator(seed).scene(); }

}  // namespace spectrace::test
