// SPDX-License-Identifier: Apache-2.0
// A scene as its JSON file says it, before anything is loaded: plain data.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/math/sampler.h"
#include "core/math/vec.h"
#include "core/spectra/spectrum.h"
#include "materials/material.h"
#include "renderer/aovs.h"
#include "renderer/spectral_bins.h"

namespace spectrace {

enum class Projection : std::uint8_t { kPerspective, kOrthographic };

struct CameraDesc {
  Vec3 origin{0, 0, 0}, target{0, 0, -1}, up{0, 1, 0};
  Float fov_deg = 45;  ///< perspective: of the shorter image side, in (0, 180)
  Projection projection = Projection::kPerspective;
  Float view_size = 2;       ///< orthographic: across the shorter image side, > 0
  Float lens_radius = 0;     ///< of a thin lens; 0: all is sharp
  Float focus_distance = 0;  ///< along the view, of what a lens shows sharp; 0: as far as the target
};

/// Pixels [x, x + width) x [y, y + height) of the image.
struct CropWindow {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Spectral images beside the RGB one.
struct SpectralFilmDesc {
  SpectralBins bins;
  bool lobes = true;  ///< of the diffuse and the specular lobe too
};

struct FilmDesc {
  int width = 512, height = 512;
  std::optional<SpectralFilmDesc> spectral{};
  std::optional<CropWindow> crop{};  ///< within the image: what is rendered of it

  [[nodiscard]] CropWindow window() const { return crop.value_or(CropWindow{0, 0, width, height}); }
};

struct IntegratorDesc {
  int max_depth = 8;       ///< path segments after the camera's; 1 = direct light only
  int roulette_depth = 4;  ///< Russian roulette from this vertex on
  bool next_event = true;  ///< sample lights; false leaves it to BSDF sampling alone (tests)
};

struct SphereDesc {
  Vec3 center{};
  Float radius = 1;
};
struct QuadDesc {  ///< corner + [0,1] edge_u + [0,1] edge_v; normal = edge_u x edge_v; uv along the edges
  Vec3 corner{}, edge_u{1, 0, 0}, edge_v{0, 1, 0};
};
struct DiskDesc {
  Vec3 center{}, normal{0, 0, 1};  ///< any length but zero
  Float radius = 1;
};
struct MeshDesc {  ///< triangles of an OBJ or PLY file, or given in place
  std::filesystem::path file{};
  std::vector<Vec3> positions{};
  std::vector<std::array<std::uint32_t, 3>> triangles{};
  bool smooth_normals = true;  ///< use the file's normals where it has them
  /// Of an OBJ file: split it by its materials; those named here are the scene's ("usemtl" name, scene's
  /// name), the others are made from the file's material library. Nothing: one material for all.
  std::optional<std::map<std::string, std::string>> materials{};
};
struct InstanceDesc {  ///< a group under one more transform
  std::string group;
};

struct ShapeDesc {
  std::string where;  ///< JSON place, for messages at build time
  std::variant<SphereDesc, QuadDesc, DiskDesc, MeshDesc, InstanceDesc> kind;
  std::string material{};  ///< name; ignored for instances
  Transform to_world{};
  std::optional<Spectrum> emission{};  ///< radiance [W·m⁻²·sr⁻¹·nm⁻¹], front side; not inside groups
  std::string name{};                  ///< for mattes; empty: after its place in the scene
};

struct GroupDesc {
  std::string name;
  std::vector<ShapeDesc> shapes;  ///< no instances among them
};

struct PointLightDesc {
  Vec3 position{};
  Spectrum intensity;  ///< [W·sr⁻¹·nm⁻¹]
};
struct SpotLightDesc {
  Vec3 position{};
  Vec3 direction{0, 0, -1};   ///< of the cone's axis, away from the light; unit
  Spectrum intensity;         ///< along the axis [W·sr⁻¹·nm⁻¹]
  Float cone_deg = 30;        ///< from the axis to where it is dark, in (0, 180]
  Float falloff_deg = 22.5F;  ///< from the axis to where it begins to fade, in [0, cone_deg]
};
struct DirectionalLightDesc {
  Vec3 direction{0, 0, -1};  ///< the way the light travels; unit
  Spectrum irradiance;       ///< [W·m⁻²·nm⁻¹] on a surface facing it
};
struct EnvironmentDesc {         ///< constant radiance, or a latitude-longitude image times it
  std::filesystem::path file{};  ///< empty: constant
  Spectrum radiance = Spectrum::constant(1);
  Float scale = 1;
  Transform to_world{};  ///< rotation; the image's up is +z
};
using LightDesc = std::variant<PointLightDesc, SpotLightDesc, DirectionalLightDesc, EnvironmentDesc>;

/// What a render is to reach, in place of a number of samples. At most one of the two is above 0.
struct QualityDesc {
  double relative_error = 0;  ///< of the image (Film::relative_error)
  double seconds = 0;         ///< of rendering
  std::filesystem::path
      measurement{};  ///< cost.json of `spectrace cost`, which says by what setting; may be empty

  [[nodiscard]] bool is_asked() const { return relative_error > 0 || seconds > 0; }
};

struct SceneDesc {
  std::string file_name;
  std::string sha256;                          ///< of the JSON text
  std::vector<std::filesystem::path> files{};  ///< that it names
  WavelengthRange range;
  int lanes = kLanes;            ///< different wavelengths of a path: 1, 2, 4 ... kLanes
  bool visible_sampling = true;  ///< draw wavelengths by what a pixel sees of the lights; false: uniformly
  CameraDesc camera;
  FilmDesc film;
  IntegratorDesc integrator;
  int spp = 64;
  std::uint64_t seed = 0;
  SamplerKind sampler = SamplerKind::kOwenSobol;
  QualityDesc quality{};
  AovSet aovs = kLobeAovs;
  std::vector<MaterialDesc> materials;
  std::vector<GroupDesc> groups;
  std::vector<ShapeDesc> shapes;
  std::vector<LightDesc> lights;
  std::vector<std::string> approximations{};  ///< by approximate(): what was left out, and how
};

/// Reads and validates; throws InputError with every mistake of the file. Form: docs/scene-format.md,
/// schema: scenes/scene.schema.json.
SceneDesc load_scene(const std::filesystem::path& file);
SceneDesc parse_scene(const std::string& text, const std::filesystem::path& file_name);

}  // namespace spectrace
