// SPDX-License-Identifier: Apache-2.0
// Scenes in a few lines, rendered and measured: what the tests of the renderer share.
#pragma once

#include <string>
#include <vector>

#include "core/spectra/color.h"
#include "renderer/render.h"

namespace spectrace::test {

inline MaterialDesc lambert(const std::string& name, Spectrum reflectance) {
  return {.name = name, .where = "/materials/" + name, .kind = Lambert{Texture(std::move(reflectance))}};
}
inline MaterialDesc lambert(const std::string& name, Float albedo) {
  return lambert(name, Spectrum::constant(albedo));
}

inline ShapeDesc sphere(Vec3 center, Float radius, const std::string& material) {
  return {.where = "/shapes/sphere", .kind = SphereDesc{center, radius}, .material = material};
}
inline ShapeDesc quad(Vec3 corner, Vec3 edge_u, Vec3 edge_v, const std::string& material) {
  return {.where = "/shapes/quad", .kind = QuadDesc{corner, edge_u, edge_v}, .material = material};
}
inline ShapeDesc disk(Vec3 center, Vec3 normal, Float radius, const std::string& material) {
  return {.where = "/shapes/disk", .kind = DiskDesc{center, normal, radius}, .material = material};
}
inline ShapeDesc emitting(ShapeDesc shape, Spectrum radiance) {
  shape.emission = std::move(radiance);
  return shape;
}
inline ShapeDesc emitting(ShapeDesc shape, Float radiance) {
  return emitting(std::move(shape), Spectrum::constant(radiance));
}
inline ShapeDesc moved(ShapeDesc shape, const Transform& to_world) {
  shape.to_world = to_world;
  return shape;
}
inline Transform translation(Vec3 t) {
  Transform m;
  m.m[0][3] = t.x;
  m.m[1][3] = t.y;
  m.m[2][3] = t.z;
  return m;
}
inline Transform scaling(Vec3 s) {
  Transform m;
  m.m[0][0] = s.x;
  m.m[1][1] = s.y;
  m.m[2][2] = s.z;
  return m;
}
inline Transform rotation_z(Float degrees) {
  const Float a = degrees_to_radians(degrees);
  Transform m;
  m.m[0] = {std::cos(a), -std::sin(a), 0, 0};
  m.m[1] = {std::sin(a), std::cos(a), 0, 0};
  return m;
}
inline EnvironmentDesc sky(Float radiance) { return {.radiance = Spectrum::constant(radiance)}; }

/// The six walls of [-1, 1]³ seen from inside: normals point inwards.
std::vector<ShapeDesc> inward_box(const std::string& material);
/// The same seen from outside.
std::vector<ShapeDesc> outward_box(const std::string& material);
/// A sphere of triangles with the true normals at its corners, as a mesh given in place has none: flat.
MeshDesc polyhedral_sphere(int rings, int segments);

/// Nothing in it; a camera at (0, -5, 0) that looks along +y with z up, 8 x 8 pixels.
inline SceneDesc empty_scene() {
  SceneDesc scene;
  scene.file_name = "test.json";
  scene.camera = {.origin = {0, -5, 0}, .target = {0, 0, 0}, .up = {0, 0, 1}, .fov_deg = 40};
  scene.film = {8, 8};
  return scene;
}
/// So narrow a view that all pixels see one point: 1e-3 degrees.
inline void look_at_point(SceneDesc& scene, Vec3 from, Vec3 at) {
  scene.camera.origin = from;
  scene.camera.target = at;
  scene.camera.fov_deg = Float(1e-3);
}

RenderResult render_scene(const SceneDesc& scene, RenderOptions options);
inline RenderResult render_scene(const SceneDesc& scene, int spp) {
  return render_scene(scene, {.spp = spp});
}

/// Mean over pixels that all estimate the same number, with its standard error from their spread.
struct Estimate {
  double mean = 0, standard_error = 0;
};
/// `component`: 0 X, 1 Y, 2 Z of the layer.
Estimate estimate_xyz(const Image& image, const std::string& layer, int component);
inline Estimate estimate_y(const Image& image, const std::string& layer = "") {
  return estimate_xyz(image, layer, 1);
}

/// XYZ of one pixel of one layer.
Xyz pixel_xyz(const Image& image, int x, int y, const std::string& layer = "");

}  // namespace spectrace::test
