// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/overloaded.h"
#include "materials/measured_albedo.h"
#include "renderer/features.h"
#include "renderer/scene_shapes.h"

namespace spectrace {

namespace {

void check_camera(const SceneDesc& scene) {
  const CameraDesc& c = scene.camera;
  const auto fail = [&](const char* key, const char* problem) {
    throw InputError(scene.file_name, fmt::format("/camera/{}", key), problem);
  };
  const Vec3 view = c.target - c.origin;
  if (!(length_squared(view) > 0) || !is_finite(view)) {
    fail("target", "must differ from the camera's origin");
  }
  if (!(length_squared(cross(normalize(view), c.up)) > 0) || !is_finite(c.up)) {
    fail("up", "must not be zero or lie along the view");
  }
  if (!(c.fov_deg > 0 && c.fov_deg < 180)) {
    fail("fov", "must lie in (0, 180) degrees");
  }
  if (!(c.view_size > 0) || !(c.lens_radius >= 0) || !(c.focus_distance >= 0)) {
    fail("lens_radius", "a lens and its distances must not be negative");
  }
  if (scene.film.width < 1 || scene.film.height < 1) {
    throw InputError(scene.file_name, "/film", "needs at least one pixel");
  }
  const CropWindow w = scene.film.window();
  if (w.x < 0 || w.y < 0 || w.width < 1 || w.height < 1 || w.width > scene.film.width - w.x ||
      w.height > scene.film.height - w.y) {
    throw InputError(scene.file_name, "/film/crop", "does not lie within the image");
  }
}

/// Of the files a scene is read from, each read once for it.
class FileDigests {
 public:
  const std::string& of(const std::filesystem::path& file) {
    const auto [at, is_new] = digests_.try_emplace(file.lexically_normal());
    if (is_new) at->second = sha256_hex(read_file(file));
    return at->second;
  }
  /// By name alone: the same wherever the scene lies.
  [[nodiscard]] std::vector<std::string> list() const {
    std::vector<std::string> lines;
    for (const auto& [file, digest] : digests_) {
      lines.push_back(fmt::format("{}: {}", file.filename().string(), digest));
    }
    std::sort(lines.begin(), lines.end());
    return lines;
  }

 private:
  std::map<std::filesystem::path, std::string> digests_;
};

/// The model too, which the command line may choose.
std::string model_text(const SeparatedDesc& separated) {
  if (separated.analytic) return " (analytic)";
  return separated.model ? fmt::format(" ({})", name_of(*separated.model)) : "";
}

void add_digest(const MaterialDesc& material, const std::string& name, FileDigests& files,
                std::vector<std::string>& digests) {
  std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.file; }) {
          std::string line = fmt::format("{}: {}", name, files.of(kind.file));
          if constexpr (std::is_same_v<std::decay_t<decltype(kind)>, SeparatedDesc>) line += model_text(kind);
          if (!kind.directions.empty()) line += " with the directions of " + files.of(kind.directions);
          digests.push_back(line);
        }
      },
      material.kind);
}

/// Null where it is no measurement.
const MeasuredBrdf* measured_of(const Material& material) {
  const auto* paired = std::get_if<PairedBrdf>(&material);
  return paired != nullptr ? paired->measured() : std::get_if<MeasuredBrdf>(&material);
}

/// Of a material made of several measurements the highest.
Float last_measured_cosine(const Material& material) {
  Float last = 0;
  for_each_part(material, [&](const Material& part) {
    const MeasuredBrdf* const measured = measured_of(part);
    if (measured != nullptr) last = std::max(last, std::cos(Float(measured->last_measured_theta_i())));
  });
  return last;
}

/// Hard case H10: what was measured is kept, and said.
void note_albedo(const std::string& name, const Material& material, Progress& progress) {
  for_each_part(material, [&](const Material& part) {
    const MeasuredBrdf* const measured = measured_of(part);
    if (measured == nullptr) return;
    if (const auto warning = albedo_warning(largest_albedo(*measured), measured->axis())) {
      progress.note(fmt::format("{}: {}", name, *warning));
    }
  });
}

Environment build_environment(const EnvironmentDesc& light, Progress& progress) {
  const Spectrum radiance = light.radiance.scaled(light.scale);
  if (light.file.empty()) return Environment(radiance);
  const Image image = read_image(light.file);
  if (has_spectral_channels(image, SpectralKind::kRadiance)) {
    if (const auto remark = check_emissive_units(read_metadata(light.file), light.file.string())) {
      progress.note(*remark);
    }
  }
  return {image, light.file, radiance, light.to_world};
}

/// 1 - cosine, in double: exact for narrow cones.
Float cosine_drop(Float angle_deg) { return Float(2 * sqr(std::sin(double(angle_deg) * kPi64 / 360))); }

template <typename Fail>
SpotLight build_spot(const SpotLightDesc& spot, const Fail& fail) {
  if (!(length_squared(spot.direction) > 0)) {
    fail("the direction of a spot light must not be zero");
  }
  if (!(spot.cone_deg > 0 && spot.cone_deg <= 180 && spot.falloff_deg >= 0 &&
        spot.falloff_deg <= spot.cone_deg)) {
    fail("a spot light's cone must lie in (0, 180] degrees, its falloff within the cone");
  }
  return {spot.position, normalize(spot.direction), spot.intensity, cosine_drop(spot.falloff_deg),
          cosine_drop(spot.cone_deg)};
}

struct DistantLights {
  std::vector<DeltaLight> delta;
  std::optional<Environment> environment;
};

DistantLights build_lights(const SceneDesc& scene, Progress& progress) {
  DistantLights result;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const auto fail = [&](const char* problem) {
      throw InputError(scene.file_name, fmt::format("/lights/{}", i), problem);
    };
    std::visit(
        Overloaded{[&](const PointLightDesc& point) {
                     result.delta.emplace_back(PointLight{point.position, point.intensity});
                   },
                   [&](const SpotLightDesc& spot) { result.delta.emplace_back(build_spot(spot, fail)); },
                   [&](const DirectionalLightDesc& sun) {
                     if (!(length_squared(sun.direction) > 0)) {
                       fail("the direction of a directional light must not be zero");
                     }
                     result.delta.emplace_back(DirectionalLight{-normalize(sun.direction), sun.irradiance});
                   },
                   [&](const EnvironmentDesc& environment) {
                     if (result.environment) fail("a scene has at most one environment");
                     result.environment = build_environment(environment, progress);
                   }},
        scene.lights[i]);
  }
  return result;
}

/// Every wavelength of a spectral image is worth as much as any other.
WavelengthDistribution evenly(const SceneDesc& scene) {
  const std::optional<SpectralFilmDesc>& spectral = scene.film.spectral;
  if (!spectral || !spectral->bins.at_centers) return WavelengthDistribution::uniform(scene.range);
  return WavelengthDistribution::at_centers(scene.range, spectral->bins.count);
}

/// A shape without a name is called by its place in the file.
MatteNames name_mattes(const SceneDesc& scene, const Geometry& geometry,
                       const std::vector<std::string>& materials) {
  MatteNames mattes;
  auto& objects = mattes.names[std::size_t(Matte::kObject)];
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const std::string& name = scene.shapes[i].name;
    objects.push_back(name.empty() ? fmt::format("shapes/{}", i) : name);
  }
  mattes.names[std::size_t(Matte::kMaterial)] = materials;
  std::vector<std::uint32_t> ids;
  for (const std::string& name : objects) ids.push_back(matte_id(name));
  for (const Shape& shape : geometry.shapes) {
    mattes.id_of_shape.push_back(shape.object < ids.size() ? ids[shape.object] : 0);
  }
  for (const Instance& instance : geometry.instances) mattes.id_of_instance.push_back(ids[instance.object]);
  for (const std::string& name : materials) mattes.id_of_material.push_back(matte_id(name));
  return mattes;
}

}  // namespace

Scene build_scene(const SceneDesc& description, Progress& progress) {
  check_camera(description);
  std::vector<Material> materials;
  std::vector<std::string> material_names;
  std::vector<Float> measured_cosines;
  std::vector<std::optional<Lobe>> only_lobes;
  FileDigests files;
  std::vector<std::string> digests;
  bool holes = false;
  const auto add_material = [&](const MaterialDesc& material) {
    materials.push_back(build_material(material));
    material_names.push_back(material.name);
    note_albedo(material.name, materials.back(), progress);
    measured_cosines.push_back(last_measured_cosine(materials.back()));
    only_lobes.push_back(only_lobe(materials.back()));
    holes |= has_holes(materials.back());
    for_each_desc(material,
                  [&](const MaterialDesc& part) { add_digest(part, material.name, files, digests); });
  };
  for (const MaterialDesc& material : description.materials) {
    add_material(material);
  }
  ShapeBuilder shapes(description, progress);
  shapes.build();
  for (const MaterialDesc& material : shapes.libraries.materials) add_material(material);
  for (const std::filesystem::path& file : description.files) files.of(file);
  for (const std::filesystem::path& file : shapes.libraries.files()) files.of(file);
  material_names.insert(material_names.end(), shapes.libraries.short_names.begin(),
                        shapes.libraries.short_names.end());
  for (Shape& shape : shapes.geometry.shapes) shape.needs_uv = is_textured(materials[shape.material]);
  const bool images =
      std::any_of(materials.begin(), materials.end(), [](const Material& m) { return has_images(m); });
  DistantLights distant = build_lights(description, progress);
  Accel accel(shapes.geometry);
  MatteNames matte_names = name_mattes(description, shapes.geometry, material_names);
  const bool visible = description.visible_sampling && !description.film.spectral;
  const auto observer = visible ? WavelengthDistribution::visible(description.range)
                                : WavelengthDistribution::uniform(description.range);
  Lights lights(std::move(shapes.area_lights), shapes.light_groups, std::move(shapes.emissions),
                std::move(distant.delta), std::move(distant.environment), observer,
                bounds(shapes.geometry).radius());
  const auto power = [&](double lambda_nm) { return lights.power(lambda_nm); };
  return Scene{.file_name = description.file_name,
               .sha256 = description.sha256,
               .material_sha256s = std::move(digests),
               .file_sha256s = files.list(),
               .wavelengths =
                   (visible ? WavelengthDistribution::visible(description.range, power) : evenly(description))
                       .carrying(description.lanes),
               .camera = Camera(description.camera, description.film),
               .film = description.film,
               .integrator = description.integrator,
               .spp = description.spp,
               .seed = description.seed,
               .sampler = description.sampler,
               .quality = description.quality,
               .aovs = description.aovs,
               .approximations = description.approximations,
               .materials = std::move(materials),
               .material_names = std::move(material_names),
               .last_measured_cosine = std::move(measured_cosines),
               .only_lobe = std::move(only_lobes),
               .has_images = images,
               .has_holes = holes,
               .matte_names = std::move(matte_names),
               .geometry = std::move(shapes.geometry),
               .lights = std::move(lights),
               .accel = std::move(accel)};
}

}  // namespace spectrace
