// SPDX-License-Identifier: Apache-2.0
// An anisotropic measurement lies on a surface as its tangent says: x of the measurement along u, whatever
// the shape and however it is turned.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "core/math/math.h"
#include "materials/measured_brdf.h"
#include "tests/support/render_scenes.h"
#include "tests/support/synthetic_measured.h"

namespace spectrace::test {
namespace {

/// Without any symmetry, and grey: the same value at every wavelength, so that Y is that value.
const MeasuredTables& tables() {
  static const MeasuredTables made = [] {
    MeasuredTables t = make_measured({.isotropic = false, .symmetry = 1});
    const std::size_t slice = std::size_t(t.table_size) * std::size_t(t.table_size), channels = t.axis.size();
    for (std::size_t i = 0; i < t.spectra.size(); ++i) {
      const std::size_t within = i % (slice * channels);
      t.spectra[i] = t.spectra[i - within + within % slice];
    }
    return t;
  }();
  return made;
}

MaterialDesc measured_desc() {
  const auto file = std::filesystem::path(testing::TempDir()) / "measured_orientation.bsdf";
  measured_to_tensors(tables()).write(file);
  return {.name = "m", .where = "", .kind = MeasuredDesc{file}};
}

const Vec3 kToLight = normalize({Float(0.5), Float(-0.3), Float(0.9)});
const Vec3 kToCamera = normalize({Float(0.2), Float(0.6), Float(0.7)});
constexpr Float kIrradiance = 3;

/// f · cosθ of the measurement with its x along `s` and its z along `n`, from the tables themselves.
double value(Vec3 s, Vec3 n) {
  const Frame frame{s, cross(n, s), n};
  const SampledWavelengths lambda = WavelengthDistribution::uniform({}).sample(Float(0.5));
  return double(MeasuredBrdf(tables())
                    .evaluate(frame.to_local(kToCamera), frame.to_local(kToLight), {.lambda = lambda})
                    .value_cos[0]);
}

/// Radiance of the shapes at the origin, seen and lit from above, or from below by the same directions.
double radiance(std::vector<ShapeDesc> shapes, std::vector<GroupDesc> groups = {}) {
  SceneDesc scene = empty_scene();
  scene.materials = {measured_desc()};
  scene.shapes = std::move(shapes);
  scene.groups = std::move(groups);
  scene.lights = {DirectionalLightDesc{-kToLight, Spectrum::constant(kIrradiance)}};
  scene.integrator.max_depth = 1;
  look_at_point(scene, kToCamera * 4, {0, 0, 0});
  return estimate_y(render_scene(scene, 256).image).mean / kIrradiance;
}

constexpr std::array<Float, 5> kTurns{0, 30, 90, 200, 315};
// Wavelengths drawn by chance: the same 16384 of them in each picture, whose mean luminance is off by a
// little.
constexpr double kRounding = 5e-4;

Vec3 turned_x(Float degrees) { return rotation_z(degrees).vector({1, 0, 0}); }

TEST(MeasuredOrientation, TheMeasurementTellsDirectionsApart) {
  // What the tests below could not see were it otherwise: turns, and mirroring by y.
  std::vector<double> values;
  for (const Float turn : kTurns) values.push_back(value(turned_x(turn), {0, 0, 1}));
  std::sort(values.begin(), values.end());
  for (std::size_t i = 1; i < values.size(); ++i) EXPECT_GT(values[i] / values[i - 1], 1 + 4 * kRounding);
  const Frame mirrored{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  const SampledWavelengths lambda = WavelengthDistribution::uniform({}).sample(Float(0.5));
  const double other =
      double(MeasuredBrdf(tables())
                 .evaluate(mirrored.to_local(kToCamera), mirrored.to_local(kToLight), {.lambda = lambda})
                 .value_cos[0]);
  EXPECT_GT(std::abs(other / value({1, 0, 0}, {0, 0, 1}) - 1), 4 * kRounding);
}

TEST(MeasuredOrientation, FollowsTheEdgesOfAQuad) {
  for (const Float turn : kTurns) {
    const ShapeDesc plane = quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, "m");
    EXPECT_NEAR(radiance({moved(plane, rotation_z(turn))}) / value(turned_x(turn), {0, 0, 1}), 1, kRounding)
        << turn;
  }
}

TEST(MeasuredOrientation, FollowsTheTrianglesOfAMesh) {
  for (const Float turn : kTurns) {
    MeshDesc mesh;  // without texture coordinates: along the first edge
    mesh.positions = {{-2, -1, 0}, {2, -1, 0}, {0, 3, 0}};
    mesh.triangles = {{0, 1, 2}};
    const ShapeDesc shape{.where = "", .kind = mesh, .material = "m", .to_world = rotation_z(turn)};
    EXPECT_NEAR(radiance({shape}) / value(turned_x(turn), {0, 0, 1}), 1, kRounding) << turn;
  }
}

TEST(MeasuredOrientation, FollowsInstances) {
  for (const Float turn : kTurns) {
    const GroupDesc group{"g", {quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, "m")}};
    const ShapeDesc instance{.where = "", .kind = InstanceDesc{"g"}, .to_world = rotation_z(turn)};
    EXPECT_NEAR(radiance({instance}, {group}) / value(turned_x(turn), {0, 0, 1}), 1, kRounding) << turn;
  }
}

TEST(MeasuredOrientation, FollowsTheCirclesOfLatitudeOfASphere) {
  // The origin is a point of the sphere whose normal is n; u grows eastwards, along z x n.
  for (const Vec3 n : {normalize({Float(0.4), 0, 1}), normalize({Float(-0.2), Float(0.5), 1})}) {
    const Vec3 east = normalize(cross({0, 0, 1}, n));
    EXPECT_NEAR(radiance({sphere(n * -2, 2, "m")}) / value(east, n), 1, kRounding);
  }
}

TEST(MeasuredOrientation, ABackIsTurnedAboutItsTangent) {
  for (const Float turn : kTurns) {
    // edge_u x edge_v looks down.
    const ShapeDesc plane = quad({-1, 1, 0}, {2, 0, 0}, {0, -2, 0}, "m");
    EXPECT_NEAR(radiance({moved(plane, rotation_z(turn))}) / value(turned_x(turn), {0, 0, 1}), 1, kRounding)
        << turn;
  }
}

}  // namespace
}  // namespace spectrace::test
