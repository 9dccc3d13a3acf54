// SPDX-License-Identifier: Apache-2.0
// The scene as a whole: its sections, and the checks that need more than one of them.
#include "renderer/scene_parser.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "core/base/error.h"
#include "core/base/file.h"
#include "materials/tensor_file.h"
#include "renderer/scene_desc.h"

namespace spectrace {
namespace {

constexpr std::int64_t kMaxDepth = 65536;
constexpr std::int64_t kMaxSpp = std::numeric_limits<std::int32_t>::max();
constexpr double kVisibleMin_nm = 360, kVisibleMax_nm = 830;
// Below this sine of the angle between view and up, single precision leaves too few digits for a frame.
constexpr double kMinUpSine = 1e-4;

void parse_spectrum_section(const JsonValue& json, SceneDesc& scene) {
  const JsonValue range = json.get("range_nm");
  if (range.exists()) {
    const std::vector<double> ends = range.numbers(2, 2, kWavelengths);
    if (ends.size() == 2) {
      scene.range = {static_cast<Float>(ends[0]), static_cast<Float>(ends[1])};
      if (!(ends[1] - ends[0] >= 1)) {
        range.error("expected [min, max] at least 1 nm apart, min first");
      } else if (!scene.film.spectral && (ends[0] >= kVisibleMax_nm || ends[1] <= kVisibleMin_nm)) {
        range.error(fmt::format("nothing of [{}, {}] nm is visible (360 to 830 nm): the image would be black",
                                ends[0], ends[1]));
      }
    }
  }
  scene.visible_sampling = json.get("sampling").choice("visible", {"visible", "uniform"}) == "visible";
  const JsonValue lanes = json.get("lanes");
  scene.lanes = int(lanes.integer(kLanes, 1, kLanes));
  if (kLanes % scene.lanes != 0) lanes.error(fmt::format("expected a divisor of {}", kLanes));
  json.reject_unknown_keys();
}

void parse_camera(const JsonValue& json, CameraDesc& camera) {
  const std::string type = json.get("type").choice("pinhole", {"pinhole", "thin_lens", "orthographic"});
  camera.origin = json.require("origin").vec3(camera.origin);
  const JsonValue target = json.require("target");
  camera.target = target.vec3(camera.target);
  const JsonValue up = json.get("up");
  camera.up = parse_nonzero(up, camera.up);
  if (type == "orthographic") {
    camera.projection = Projection::kOrthographic;
    camera.view_size = static_cast<Float>(json.get("view_size").number(camera.view_size, kPositiveFloat));
  } else {
    camera.fov_deg = static_cast<Float>(json.get("fov_deg").number(
        camera.fov_deg, {.min = 0, .max = 180, .min_open = true, .max_open = true}));
  }
  if (type == "thin_lens") {
    camera.lens_radius = static_cast<Float>(json.require("lens_radius").number(0, kNonNegativeFloat));
    camera.focus_distance = static_cast<Float>(json.get("focus_distance").number(0, kPositiveFloat));
  }
  json.reject_unknown_keys();
  if (!json.is_object()) {
    return;
  }
  const Vec3 view = camera.target - camera.origin;
  if (view == Vec3{}) {
    target.error("is the same point as the origin: the camera has nowhere to look");
  } else if (length(cross(normalize(view), normalize(camera.up))) < kMinUpSine) {
    (up.exists() ? up : json).error("\"up\" is parallel to the direction from origin to target");
  }
}

SamplerKind parse_sampler_kind(const JsonValue& json) {
  constexpr std::string_view kDefault = sampler_name(SamplerKind::kOwenSobol),
                             kOther = sampler_name(SamplerKind::kIndependent);
  return json.choice(kDefault, {kDefault, kOther}) == kOther ? SamplerKind::kIndependent
                                                             : SamplerKind::kOwenSobol;
}

void parse_sampler(const JsonValue& json, SceneDesc& scene) {
  scene.spp = static_cast<int>(json.get("spp").integer(scene.spp, 1, kMaxSpp));
  scene.seed =
      static_cast<std::uint64_t>(json.get("seed").integer(0, 0, std::numeric_limits<std::int64_t>::max()));
  scene.sampler = parse_sampler_kind(json.get("type"));
  json.reject_unknown_keys();
}

void parse_quality(const JsonValue& json, QualityDesc& quality) {
  if (!json.exists()) return;
  const JsonValue relative_error = json.get("relative_error"), seconds = json.get("seconds");
  quality.relative_error = relative_error.number(0, kPositive);
  quality.seconds = seconds.number(0, kPositive);
  quality.measurement = parse_existing_file(json.get("measurement"));
  json.reject_unknown_keys();
  if (json.is_object() && relative_error.exists() == seconds.exists()) {
    json.error("expected one of \"relative_error\" and \"seconds\"");
  }
}

void parse_integrator(const JsonValue& json, IntegratorDesc& integrator) {
  integrator.max_depth = static_cast<int>(json.get("max_depth").integer(integrator.max_depth, 0, kMaxDepth));
  integrator.roulette_depth =
      static_cast<int>(json.get("roulette_depth").integer(integrator.roulette_depth, 1, kMaxDepth));
  integrator.next_event = json.get("next_event").boolean(integrator.next_event);
  json.reject_unknown_keys();
}

/// Records `json`'s "name" where an earlier one is the same, else adds it.
void add_name(const JsonValue& json, const std::string& name, std::vector<std::string>& names) {
  if (name.empty()) {
    return;  // recorded already: a name is required
  }
  if (std::find(names.begin(), names.end(), name) != names.end()) {
    json.get("name").error(fmt::format("\"{}\" is the name of an earlier one: names must differ", name));
    return;
  }
  names.push_back(name);
}

/// The files that a material and its parts name must be there.
void check_files(const JsonValue& json, const MaterialDesc& material) {
  std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.file; }) {
          parse_existing_file(json.get("file"));
        } else if constexpr (requires { kind.parts; }) {
          for (std::size_t i = 0; i < kind.parts.size(); ++i) {
            check_files(json.get(kind.kKeys[i]), kind.parts[i]);
          }
        }
      },
      material.kind);
}

void parse_materials(const JsonValue& json, SceneDesc& scene, SceneNames& names) {
  for (const JsonValue& element : json.elements()) {
    MaterialDesc material = parse_material(element);
    if (const JsonValue name = element.require("name"); name.is_string() && material.name.empty()) {
      name.error("expected a name, got an empty string");
    }
    check_files(element, material);
    add_name(element, material.name, names.materials);
    scene.materials.push_back(std::move(material));
  }
}

void parse_lights(const JsonValue& json, SceneDesc& scene) {
  bool has_environment = false;
  for (const JsonValue& element : json.elements()) {
    scene.lights.push_back(parse_light(element));
    if (std::holds_alternative<EnvironmentDesc>(scene.lights.back())) {
      if (has_environment) {
        element.error("a second environment: a scene has at most one");
      }
      has_environment = true;
    }
  }
}

}  // namespace

std::filesystem::path parse_existing_file(const JsonValue& json) {
  if (!json.is_string()) {
    return json.path();
  }
  if (json.string().empty()) {
    json.error("expected the name of a file, got an empty string");
    return {};
  }
  const std::filesystem::path file = json.path();
  std::error_code failed;
  if (!std::filesystem::is_regular_file(file, failed)) {
    const bool is_folder = std::filesystem::is_directory(file, failed);
    const std::string name = '"' + file.lexically_normal().string() + '"';
    json.error(is_folder ? name + " is a folder, not a file" : "there is no file " + name);
  }
  return file;
}

Vec3 parse_nonzero(const JsonValue& json, Vec3 fallback) {
  const Vec3 v = json.vec3(fallback);
  if (v == Vec3{}) {
    json.error("expected a vector that is not zero");
    return fallback;
  }
  return v;
}

SceneDesc parse_scene(const std::string& text, const std::filesystem::path& file_name) {
  JsonDocument document = JsonDocument::parse(text, file_name.string());
  SceneDesc scene;
  scene.file_name = file_name.string();
  scene.sha256 = sha256_hex(std::as_bytes(std::span(text)));

  const JsonValue root = document.root();
  SceneNames names;
  if (root.is_object()) {
    parse_film(root.get("film"), scene.film);
    parse_spectrum_section(root.get("spectrum"), scene);
    parse_spectral_film(root.get("film").get("spectral"), scene);
    parse_aovs(root.get("aovs"), scene);
    parse_camera(root.require("camera"), scene.camera);
    parse_sampler(root.get("sampler"), scene);
    parse_quality(root.get("quality"), scene.quality);
    parse_integrator(root.get("integrator"), scene.integrator);
    parse_materials(root.get("materials"), scene, names);
    for (const JsonValue& element : root.get("groups").elements()) {
      scene.groups.push_back(parse_group(element, names));
      add_name(element, scene.groups.back().name, names.groups);
    }
    for (const JsonValue& element : root.get("shapes").elements()) {
      scene.shapes.push_back(parse_shape(element, names, ShapePlace::kScene));
    }
    parse_lights(root.get("lights"), scene);
    root.reject_unknown_keys();
  } else {
    root.error("expected a scene: an object with \"camera\", \"shapes\", ...");
  }
  document.throw_if_wrong();
  scene.files = document.files();
  return scene;
}

SceneDesc load_scene(const std::filesystem::path& file) {
  // A scene is text written by people or scripts; beyond this it is some other file.
  constexpr std::size_t kMaxBytes = std::size_t(256) << 20;
  const std::vector<std::byte> bytes = read_file(file, kMaxBytes);
  if (TensorFile::has_magic(bytes)) {
    throw InputError(file.string(), "",
                     "a measurement or separated material, not a scene; a scene's material names it");
  }
  return parse_scene({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
}

}  // namespace spectrace
