// SPDX-License-Identifier: Apache-2.0
// A scene ready to be rendered: everything loaded, placed, checked; immutable.
#pragma once

#include <string>
#include <vector>

#include "core/base/progress.h"
#include "materials/material.h"
#include "renderer/accel_embree.h"
#include "renderer/camera.h"
#include "renderer/geometry.h"
#include "renderer/lights.h"
#include "renderer/matte.h"
#include "renderer/scene_desc.h"

namespace spectrace {

/// Never changed after build_scene(); shared between threads.
struct Scene {
  std::string file_name;
  std::string sha256;  ///< of the JSON text
  std::vector<std::string>
      material_sha256s;  ///< "name: digest" of each material file read, and the model it is read for
  std::vector<std::string> file_sha256s;  ///< "file name: digest" of all files that were read, sorted
  WavelengthDistribution wavelengths;
  Camera camera;
  FilmDesc film;
  IntegratorDesc integrator;
  int spp = 64;            ///< what the file asks for
  std::uint64_t seed = 0;  ///< likewise
  SamplerKind sampler = SamplerKind::kOwenSobol;
  QualityDesc quality;                      ///< likewise
  AovSet aovs;                              ///< likewise
  std::vector<std::string> approximations;  ///< what was left out of it, and how (renderer/approximations.h)
  std::vector<Material> materials;
  std::vector<std::string> material_names;
  /// By material: seen from below this cosine a measured BRDF was not measured but extrapolated (hard case
  /// H1); 0 for others, which are never seen from there.
  std::vector<Float> last_measured_cosine;
  std::vector<std::optional<Lobe>> only_lobe;  ///< by material
  bool has_images = false;                     ///< some texture is an image: paths keep their footprints
  bool has_holes = false;                      ///< some material is masked: shadow rays ask what they meet
  MatteNames matte_names;
  Geometry geometry;
  Lights lights;
  Accel accel;

  /// Of sample `sample` of a pixel.
  [[nodiscard]] RayCone cone(const Ray& camera_ray, std::uint32_t sample) const {
    return has_images ? camera.cone(camera_ray) * share_of_pixel(sample) : RayCone{};
  }
};

/// Loads meshes, images and measured files, drops what cannot be hit (noted by name) and builds the
/// acceleration structure. Throws InputError naming the JSON place.
[[nodiscard]] Scene build_scene(const SceneDesc& description, Progress& progress);

}  // namespace spectrace
