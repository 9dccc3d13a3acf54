// SPDX-License-Identifier: Apache-2.0
// Scenes whose radiance is known in closed form. Every pixel estimates the same number; seeds are fixed, so a
// failure is a defect, not bad luck. 4 standard errors: about 40 comparisons at alpha 0.01 (Šidák) ask
// for 3.7.
#include <gtest/gtest.h>

#include <cmath>

#include "core/math/math.h"
#include "tests/support/render_scenes.h"

namespace spectrace::test {
namespace {

constexpr double kSigmas = 4;
// Float geometry (camera of 1e-3 degrees, offsets) beside the statistical error: 10x the largest seen.
constexpr double kRounding = 1e-4;

void expect_y(const Image& image, double expected, const std::string& layer = "") {
  const Estimate y = estimate_y(image, layer);
  EXPECT_NEAR(y.mean, expected, kSigmas * y.standard_error + kRounding * expected) << "layer " << layer;
  // The test itself must be able to tell: 1 % at the least.
  EXPECT_LT(kSigmas * y.standard_error, 0.01 * std::abs(expected)) << "layer " << layer;
}

/// A large floor of albedo 1/2 seen at the origin.
SceneDesc floor_scene() {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("floor", Float(0.5)), lambert("black", 0)};
  scene.shapes = {quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}, "floor")};
  look_at_point(scene, {4, 0, 2}, {0, 0, 0});
  return scene;
}

TEST(KnownRadiance, FloorUnderSphereLight) {
  SceneDesc scene = floor_scene();
  scene.shapes.push_back(emitting(sphere({0, 0, 3}, 1, "black"), 7));
  // Irradiance of a sphere wholly above the horizon: π L sin²θmax cosθ; sin² = 1/9.
  const double expected = 0.5 / kPi64 * kPi64 * 7 / 9;
  const Image image = render_scene(scene, 256).image;
  expect_y(image, expected);
  expect_y(image, expected, "diffuse");
}

TEST(KnownRadiance, FloorUnderTiltedSphereLight) {
  SceneDesc scene = floor_scene();
  scene.shapes.push_back(emitting(sphere({0, 4, 3}, Float(0.25), "black"), 50));
  const double distance = 5, cosine = 3 / distance;
  expect_y(render_scene(scene, 256).image, 0.5 * 50 * std::pow(0.25 / distance, 2) * cosine);
}

/// Form factor of a small patch to a rectangle a x b at height h over it, one corner straight above
/// (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-3).
double corner_factor(double a, double b, double h) {
  const double A = a / h, B = b / h;
  const double ra = std::sqrt(1 + A * A), rb = std::sqrt(1 + B * B);
  return (A / ra * std::atan(B / ra) + B / rb * std::atan(A / rb)) / (2 * kPi64);
}

TEST(KnownRadiance, FloorUnderQuadLight) {
  SceneDesc scene = floor_scene();
  // The front (edge_u x edge_v) must look down.
  scene.shapes.push_back(emitting(quad({-1, -2, 2}, {0, 4, 0}, {2, 0, 0}, "black"), 3));
  expect_y(render_scene(scene, 1024).image, 0.5 * 3 * 4 * corner_factor(1, 2, 2));
}

TEST(KnownRadiance, QuadLightIsDarkBehind) {
  SceneDesc scene = floor_scene();
  scene.shapes.push_back(emitting(quad({-1, -2, 2}, {2, 0, 0}, {0, 4, 0}, "black"), 3));
  EXPECT_EQ(estimate_y(render_scene(scene, 16).image).mean, 0);
}

TEST(KnownRadiance, FloorUnderTriangleLight) {
  SceneDesc scene = floor_scene();
  MeshDesc mesh;
  mesh.positions = {{-1, -2, 2}, {-1, 2, 2}, {1, 2, 2}, {1, -2, 2}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.shapes.push_back(
      emitting({.where = "/shapes/1", .kind = mesh, .material = "black"}, Spectrum::constant(3)));
  expect_y(render_scene(scene, 1024).image, 0.5 * 3 * 4 * corner_factor(1, 2, 2));
}

TEST(KnownRadiance, FloorUnderADiskLight) {
  SceneDesc scene = floor_scene();
  // Over the disk's centre, parallel to it: π L r² / (r² + h²).
  scene.shapes.push_back(emitting(disk({0, 0, 2}, {0, 0, -3}, Float(1.5), "black"), 7));
  for (bool next_event : {true, false}) {
    scene.integrator.next_event = next_event;
    const Image image = render_scene(scene, next_event ? 256 : 4096).image;
    expect_y(image, 0.5 * 7 * 2.25 / (2.25 + 4));
    expect_y(image, 0.5 * 7 * 2.25 / (2.25 + 4), "diffuse");
  }
  // Its back is dark.
  scene.shapes.back() = emitting(disk({0, 0, 2}, {0, 0, 3}, Float(1.5), "black"), 7);
  EXPECT_EQ(estimate_y(render_scene(scene, 16).image).mean, 0);
}

/// Irradiance / π L under the middle of an ellipse with half axes a and b at height h, by quadrature:
/// ∫ cos⁴θ / h² dA.
double ellipse_factor(double a, double b, double h) {
  constexpr int kSteps = 1000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double r = (i + 0.5) / kSteps;
    for (int j = 0; j < kSteps; ++j) {
      const double phi = 2 * kPi64 * (j + 0.5) / kSteps;
      const double d2 = h * h + sqr(a * r * std::cos(phi)) + sqr(b * r * std::sin(phi));
      sum += r * h * h / (d2 * d2);
    }
  }
  return sum * a * b * 2 * kPi64 / kSteps / kSteps / kPi64;
}

TEST(KnownRadiance, FloorUnderAnEllipseLight) {
  EXPECT_NEAR(ellipse_factor(1.5, 1.5, 2), 2.25 / 6.25, 1e-6);
  SceneDesc scene = floor_scene();
  // The same through a map that stretches and mirrors it: fronts stay in front.
  const Transform map = translation({0, 0, 2}).compose(scaling({Float(-2), Float(0.5), 1}));
  scene.shapes.push_back(emitting(moved(disk({0, 0, 0}, {0, 0, -1}, 1, "black"), map), 7));
  expect_y(render_scene(scene, 1024).image, 0.5 * 7 * ellipse_factor(2, 0.5, 2));
}

TEST(KnownRadiance, FloorUnderPointLight) {
  SceneDesc scene = floor_scene();
  scene.lights = {PointLightDesc{{0, 4, 3}, Spectrum::constant(20)}};
  expect_y(render_scene(scene, 64).image, 0.5 / kPi64 * 20 * (3.0 / 5) / 25);
}

TEST(KnownRadiance, FloorUnderDirectionalLight) {
  SceneDesc scene = floor_scene();
  scene.lights = {DirectionalLightDesc{normalize({0, 4, -3}), Spectrum::constant(20)}};
  expect_y(render_scene(scene, 64).image, 0.5 / kPi64 * 20 * 3 / 5);
}

TEST(KnownRadiance, FloorUnderASpotLight) {
  SceneDesc scene = floor_scene();
  SpotLightDesc spot{.position = {0, 4, 3},
                     .direction = normalize({0, -4, -3}),
                     .intensity = Spectrum::constant(20),
                     .cone_deg = 10,
                     .falloff_deg = 5};
  const double full = 0.5 / kPi64 * 20 * (3.0 / 5) / 25;
  const auto rendered = [&] {
    scene.lights = {spot};
    return render_scene(scene, 64).image;
  };
  expect_y(rendered(), full);
  // Where the cosine lies midway between those of the two angles, half of it is left.
  const double middle = std::acos((std::cos(5 * kPi64 / 180) + std::cos(10 * kPi64 / 180)) / 2);
  const double turned = std::atan2(3.0, 4.0) + middle;
  spot.direction = {0, Float(-std::cos(turned)), Float(-std::sin(turned))};
  expect_y(rendered(), full / 2);
  spot.direction = normalize({0, -4, -1});  // 23 degrees off
  EXPECT_EQ(estimate_y(rendered()).mean, 0);
}

TEST(KnownRadiance, AFloorAboveTheLightsIsDark) {
  SceneDesc scene = floor_scene();
  scene.lights = {PointLightDesc{{0, 0, -3}, Spectrum::constant(20)},
                  DirectionalLightDesc{{0, 0, 1}, Spectrum::constant(20)}};
  EXPECT_EQ(estimate_y(render_scene(scene, 16).image).mean, 0);
}

TEST(KnownRadiance, FloorUnderSky) {
  SceneDesc scene = floor_scene();
  scene.lights = {sky(3)};
  expect_y(render_scene(scene, 256).image, 0.5 * 3);
}

TEST(KnownRadiance, ManyLightsAdd) {
  SceneDesc scene = floor_scene();
  scene.shapes.push_back(emitting(sphere({0, 0, 3}, 1, "black"), 7));
  scene.lights = {PointLightDesc{{0, 4, 3}, Spectrum::constant(20)},
                  DirectionalLightDesc{normalize({0, 4, -3}), Spectrum::constant(Float(0.5))}};
  const double expected = 0.5 * 7 / 9 + 0.5 / kPi64 * 20 * (3.0 / 5) / 25 + 0.5 / kPi64 * 0.5 * 3 / 5;
  expect_y(render_scene(scene, 4096).image, expected);
}

TEST(KnownRadiance, EmittersShowTheirRadianceFromTheFrontOnly) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("black", 0)};
  scene.shapes = {emitting(sphere({0, 0, 0}, 1, "black"), 5)};
  look_at_point(scene, {0, -5, 0}, {0, 0, 0});
  const Image outside = render_scene(scene, 64).image;
  expect_y(outside, 5);
  expect_y(outside, 5, "emission");
  look_at_point(scene, {0, 0, 0}, {0, 5, 0});
  EXPECT_EQ(estimate_y(render_scene(scene, 16).image).mean, 0);
}

TEST(KnownRadiance, WhiteFurnaceOfConvexBodies) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("white", 1)};
  scene.lights = {sky(1)};
  for (const ShapeDesc& shape :
       {sphere({0, 0, 0}, 1, "white"), quad({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}, "white"),
        disk({0, 0, 0}, {0, -1, 0}, 9, "white")}) {
    scene.shapes = {shape};
    scene.camera.fov_deg = 10;  // all of it on the body
    const Estimate y = estimate_y(render_scene(scene, 16384).image);
    EXPECT_NEAR(y.mean, 1, 3 * y.standard_error);
    EXPECT_NEAR(y.mean, 1, 1e-3);
  }
}

/// A closed box whose walls emit and reflect alike: Le (1 + a + a² + ...), as many terms as segments.
double closed_furnace(double albedo, int depth) {
  double sum = 0, power = 1;
  for (int i = 0; i <= depth; ++i, power *= albedo) sum += power;
  return sum;
}

TEST(KnownRadiance, ClosedFurnaceIsAGeometricSeries) {
  for (double albedo : {0.5, 0.9, 1.0}) {
    for (int depth : {0, 1, 2, 8}) {
      for (bool next_event : {false, true}) {
        SceneDesc scene = empty_scene();
        scene.materials = {lambert("wall", Float(albedo))};
        for (const ShapeDesc& wall : inward_box("wall")) scene.shapes.push_back(emitting(wall, 1));
        scene.camera.origin = {0, Float(-0.5), Float(0.1)};
        scene.integrator = {.max_depth = depth, .roulette_depth = 2, .next_event = next_event};
        const Estimate y = estimate_y(render_scene(scene, 512).image);
        const double expected = closed_furnace(albedo, depth);
        EXPECT_NEAR(y.mean, expected, kSigmas * y.standard_error + 1e-5 * expected)
            << "albedo " << albedo << " depth " << depth << " next event " << next_event;
        EXPECT_LT(y.standard_error, 0.01 * expected);
      }
    }
  }
}

TEST(KnownRadiance, RouletteKeepsTheMean) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("wall", Float(0.7))};
  for (const ShapeDesc& wall : inward_box("wall")) scene.shapes.push_back(emitting(wall, 1));
  scene.camera.origin = {0, Float(-0.5), Float(0.1)};
  for (int roulette_depth : {0, 1, 3, 1000}) {
    scene.integrator = {.max_depth = 30, .roulette_depth = roulette_depth};
    const Estimate y = estimate_y(render_scene(scene, 512).image);
    EXPECT_NEAR(y.mean, closed_furnace(0.7, 30), kSigmas * y.standard_error) << "roulette " << roulette_depth;
  }
}

TEST(KnownRadiance, RouletteDoesNotTakeRefractionForLoss) {
  // Through clear glass nothing is lost, but inside it radiance counts 1/η² as much. Of each path that
  // enters, one game is played: between its first and its second, last vertex.
  SceneDesc scene = empty_scene();
  scene.materials = {{.name = "glass", .where = "", .kind = Dielectric{Spectrum::constant(Float(1.5))}}};
  scene.shapes = {sphere({0, 0, 0}, 1, "glass")};
  scene.lights = {sky(1)};
  scene.sampler = SamplerKind::kIndependent;  // stratified, even a wrong game has hardly any noise
  look_at_point(scene, {0, -5, 0}, {0, 0, 0});
  constexpr int kSpp = 256;
  const auto spread = [&](int roulette_depth) {
    scene.integrator = {.max_depth = 2, .roulette_depth = roulette_depth};
    return estimate_y(render_scene(scene, kSpp).image).standard_error;
  };
  // A path of throughput 1 survives 19 times in 20, which adds 1/19 to a sample's variance. Taken for one of
  // throughput 1/2.25 it would add 1.25.
  const double samples = double(scene.film.width) * scene.film.height * kSpp;
  EXPECT_LT(sqr(spread(1)), sqr(spread(2)) + 3.0 / 19 / samples);
}

/// ∫ f cosθ dω of a grey rough metal by quadrature, independent of its sampling.
double directional_albedo(const RoughConductor& metal, double theta_o) {
  const WavelengthDistribution wavelengths = WavelengthDistribution::uniform({});
  const SampledWavelengths lambda = wavelengths.sample(Float(0.3));
  const ShadingPoint at{lambda, {}};
  const Vec3 wo{Float(std::sin(theta_o)), 0, Float(std::cos(theta_o))};
  constexpr int kSteps = 400;  // the lobe of alpha 0.3 is smooth on that grid
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps, r = std::sqrt(1 - mu * mu);
    for (int j = 0; j < 2 * kSteps; ++j) {
      const double phi = 2 * kPi64 * (j + 0.5) / (2 * kSteps);
      const Vec3 wi{Float(r * std::cos(phi)), Float(r * std::sin(phi)), Float(mu)};
      sum += metal.evaluate(wo, wi, at).value_cos[0];
    }
  }
  return sum * 2 * kPi64 / (double(kSteps) * 2 * kSteps);
}

TEST(KnownRadiance, GreyMetalInAFurnaceShowsItsAlbedo) {
  const RoughConductor metal{.fresnel = {.eta = Spectrum::constant(1), .k = Spectrum::constant(3)},
                             .ggx = {Float(0.3), Float(0.3)}};
  SceneDesc scene = empty_scene();
  scene.materials = {{.name = "metal", .where = "", .kind = metal}};
  scene.shapes = {quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}, "metal")};
  scene.lights = {sky(1)};
  for (double theta : {0.2, 0.8, 1.3}) {
    look_at_point(scene, {Float(5 * std::sin(theta)), 0, Float(5 * std::cos(theta))}, {0, 0, 0});
    scene.camera.up = {0, 1, 0};
    const Image image = render_scene(scene, 1024).image;
    const double albedo = directional_albedo(metal, theta);
    expect_y(image, albedo);
    expect_y(image, albedo, "specular");
    EXPECT_LT(albedo, 1);
  }
}

}  // namespace
}  // namespace spectrace::test
