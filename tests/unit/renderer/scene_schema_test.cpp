// SPDX-License-Identifier: Apache-2.0
// Holds scenes/scene.schema.json and the scene parser together: what comes along passes both, and of each of
// some thousand damaged scenes the schema refuses none that the parser takes, and the parser none that the
// schema takes save for the rules a schema cannot state.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>
#include <vector>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/image/image.h"
#include "renderer/scene_desc.h"

namespace spectrace {
namespace {

using Json = nlohmann::json;

const std::filesystem::path kScenes = std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes";

Json read_json(const std::filesystem::path& file) {
  const auto bytes = read_file(file);
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  return Json::parse(text, text + bytes.size(), nullptr, true, /*ignore_comments=*/true);
}

/// The schema, or one of its definitions.
class SchemaFile {
 public:
  explicit SchemaFile(const std::string& definition = "") {
    Json document = read_json(kScenes / "scene.schema.json");
    if (!definition.empty()) {
      document = {{"definitions", document["definitions"]}, {"$ref", "#/definitions/" + definition}};
    }
    valijson::SchemaParser(valijson::SchemaParser::kDraft7)
        .populateSchema(valijson::adapters::NlohmannJsonAdapter(document), schema_);
  }
  [[nodiscard]] bool accepts(const Json& document) const {
    valijson::Validator validator(valijson::Validator::kStrongTypes);
    return validator.validate(schema_, valijson::adapters::NlohmannJsonAdapter(document), nullptr);
  }

 private:
  valijson::Schema schema_;
};

/// Nothing where the parser takes the scene, else its diagnostics.
std::vector<Diagnostic> parser_problems(const std::string& text) {
  try {
    parse_scene(text, kScenes / "test.json");
    return {};
  } catch (const InputError& e) {
    return e.diagnostics();
  }
}

/// An image there is.
std::string bitmap() {
  static const std::string file = [] {
    const auto path = std::filesystem::path(::testing::TempDir()) / "scene_schema.png";
    write_png(path, Image(1, 1, {"R", "G", "B"}));
    return path.string();
  }();
  return file;
}

/// One scene with every kind of section, shape, light, transform, material and spectrum.
Json everything() {
  Json scene = Json::parse(R"json({
    "$schema": "scene.schema.json",
    "spectrum": {"range_nm": [380, 780], "sampling": "uniform"},
    "camera": {"type": "thin_lens", "origin": [0, -5, 2], "target": [0, 0, 1], "up": [0, 0, 1], "fov_deg": 30,
               "lens_radius": 0.1, "focus_distance": 4},
    "film": {"width": 64, "height": 48},
    "sampler": {"spp": 8, "seed": 3, "type": "independent"},
    "integrator": {"max_depth": 5, "roulette_depth": 3, "next_event": true},
    "materials": [
      {"name": "clay", "type": "lambert", "reflectance": 0.5},
      {"name": "paint", "type": "lambert", "reflectance": {"rgb": [0.5, 0.2, 0.1]}},
      {"name": "floor", "type": "lambert",
       "reflectance": {"checkerboard": {"even": 0.2, "odd": {"rgb": [0.5, 0.5, 0.5]}, "repeat": [8, 8]}}},
      {"name": "mirror", "type": "conductor", "eta": 0.2, "k": 3, "thin_film": {"eta": 1.5, "thickness_nm": 300}},
      {"name": "brushed", "type": "conductor", "roughness": [0.1, 0.3], "k": 3,
       "eta": {"wavelengths_nm": [400, 700], "values": [1.5, 0.2]}},
      {"name": "glass", "type": "dielectric", "eta": {"sellmeier": {"b": [1.7, 0.3, 1.9], "c_um2": [0.01, 0.06, 155]}}},
      {"name": "ground", "type": "dielectric", "eta": {"cauchy": {"a": 1.5, "b_um2": 0.004, "c_um4": 1e-5}},
       "roughness": 0.2, "thin_film": {"eta": 1.38, "thickness_nm": 100}},
      {"name": "coat", "type": "glossy", "reflectance": 0.3, "f0": 0.04, "roughness": 0.1, "specular_scale": 0.4,
       "diffuse_scale": 0.6},
      {"name": "mug", "type": "plastic", "reflectance": {"rgb": [0.7, 0.1, 0.1]}, "eta": 1.5, "roughness": 0.05},
      {"name": "flakes", "type": "diffractive", "reflectance": 0.3, "eta": 1.2, "k": 6, "roughness": 0.1,
       "micro_roughness": {"rms_nm": 60, "correlation_nm": 2000, "exponent": 2.5}, "specular_scale": 0.4,
       "diffuse_scale": 0.6},
      {"name": "foil", "type": "conductor", "metal": "Al", "roughness": 0.1},
      {"name": "card", "type": "two_sided", "front": {"type": "lambert", "reflectance": 0.8},
       "back": {"name": "inner", "type": "measured", "file": "furnace.json"}},
      {"name": "worn", "type": "mix", "first": {"type": "conductor", "metal": "Cu"}, "weight": 0.25,
       "second": {"type": "mix", "first": {"type": "lambert", "reflectance": 0.1},
                  "second": {"type": "lambert", "reflectance": 0.9},
                  "weight": {"checkerboard": {"even": 0.2, "odd": 1, "repeat": [4, 4]}}}},
      {"name": "leaf", "type": "mask", "material": {"type": "lambert", "reflectance": 0.3},
       "opacity": {"bitmap": "BITMAP"}},
      {"name": "brick", "type": "normal_map", "material": {"type": "lambert", "reflectance": 0.3}, "normals": "BITMAP"},
      {"name": "real", "type": "measured", "file": "furnace.json", "albedo": "clip"},
      {"name": "lobes", "type": "separated", "file": "furnace.json", "model": "fresnel"}],
    "groups": [{"name": "pair", "shapes": [
      {"type": "sphere", "material": "clay", "center": [0, 0, 1], "radius": 0.5},
      {"type": "disk", "material": "clay", "normal": [0, 1, 1]},
      {"type": "mesh", "material": "paint", "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]}]}],
    "shapes": [
      {"type": "quad", "material": "floor", "corner": [-9, -9, 0], "edge_u": [18, 0, 0], "edge_v": [0, 18, 0]},
      {"type": "disk", "material": "clay", "center": [0, 0, 4], "normal": [0, 0, -1], "radius": 0.5, "emission": 2},
      {"type": "sphere", "material": "glass", "transform": {"scale": [0.5, 0.5, 0.5]}},
      {"type": "sphere", "material": "clay", "emission": {"blackbody_K": 4000, "scale": 2}},
      {"type": "mesh", "material": "coat", "file": "meshes/torus.obj", "smooth_normals": false,
       "transform": [{"scale": 2}, {"rotate": {"axis": [0, 0, 1], "angle_deg": 30}}, {"translate": [1, 2, 3]},
                     {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]}]},
      {"type": "mesh", "file": "meshes/torus.obj", "materials": {"material": "clay"}},
      {"type": "instance", "group": "pair", "transform": {"translate": [3, 0, 0]}}],
    "lights": [
      {"type": "environment", "radiance": {"illuminant": "D65", "scale": 0.5}, "scale": 2,
       "transform": {"rotate": {"axis": [0, 0, 1], "angle_deg": 90}}},
      {"type": "point", "position": [1, 1, 1], "intensity": {"rgb": [1, 2, 3]}},
      {"type": "spot", "position": [1, 1, 3], "target": [0, 0, 0], "intensity": 3, "cone_deg": 20, "falloff_deg": 15},
      {"type": "spot", "position": [1, 1, 3], "direction": [0, 0, -1], "intensity": 3, "cone_deg": 20},
      {"type": "directional", "direction": [0, 0, -1], "irradiance": {"wavelengths_nm": [400, 500], "values": [0, 1]}}]
  })json");
  for (Json& material : scene["materials"]) {
    if (material["type"] == "mask") material["opacity"]["bitmap"] = bitmap();
    if (material["type"] == "normal_map") material["normals"] = bitmap();
  }
  return scene;
}

/// Rules between places of a file, or about the world outside it: the parser's alone.
bool is_beyond_schema(const std::string& problem) {
  constexpr std::array kBeyond{
      "there is no",  // file, material, group
      "is the name of an earlier one",
      "is parallel to",
      "is the same point as",
      "can be inverted",
      "can only be rotated",
      "a second environment",
      "must not exceed cone_deg",
      "nm apart, min first",
      "is visible",
      "pixels: more than",
      "wavelengths must increase",
      "one for each wavelength",
      "at every wavelength",  // minimum of a spectrum
      "at every visible wavelength",
      "must be at most 1",  // sum of two shares
      "a triangle without positions",
      "in [0, 2], got",  // indices of three positions
  };
  return std::any_of(kBeyond.begin(), kBeyond.end(),
                     [&](const char* rule) { return problem.find(rule) != std::string::npos; });
}

/// Every place of a document, as a pointer; the root too.
void collect_places(const Json& value, const Json::json_pointer& at,
                    std::vector<Json::json_pointer>& places) {
  places.push_back(at);
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) {
      collect_places(member, at / key, places);
    }
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      collect_places(value[i], at / i, places);
    }
  }
}

std::vector<Json::json_pointer> places_of(const Json& document) {
  std::vector<Json::json_pointer> places;
  collect_places(document, Json::json_pointer(), places);
  return places;
}

/// Both verdicts of one scene agree, as far as a schema can go. Returns whether the schema took it.
bool expect_agreement(const SchemaFile& schema, const Json& scene, const std::string& what) {
  const bool schema_accepts = schema.accepts(scene);
  const std::vector<Diagnostic> problems = parser_problems(scene.dump());
  if (!schema_accepts) {
    EXPECT_FALSE(problems.empty()) << what << ": the schema refuses it, the parser does not";
  } else {
    for (const Diagnostic& d : problems) {
      EXPECT_TRUE(is_beyond_schema(d.problem))
          << what << ": the schema takes it, the parser says " << d.text();
    }
  }
  return schema_accepts;
}

TEST(SceneSchema, AcceptsEveryScene) {
  const SchemaFile schema;
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() == ".json" && entry.path().filename() != "scene.schema.json") {
      EXPECT_TRUE(schema.accepts(read_json(entry.path()))) << entry.path();
      ++scenes;
    }
  }
  EXPECT_GE(scenes, 5);
}

TEST(SceneSchema, AcceptsEveryMaterialFile) {
  const SchemaFile schema("material");
  for (const auto& entry : std::filesystem::directory_iterator(kScenes / "materials")) {
    EXPECT_TRUE(schema.accepts(read_json(entry.path()))) << entry.path();
    EXPECT_NO_THROW(load_material(entry.path())) << entry.path();
  }
  EXPECT_FALSE(schema.accepts({{"name", "x"}, {"type", "lambertian"}}));
}

TEST(SceneSchema, ParserAcceptsEveryScene) {
  for (const auto& entry : std::filesystem::directory_iterator(kScenes)) {
    if (entry.path().extension() != ".json" || entry.path().filename() == "scene.schema.json") {
      continue;
    }
    Json scene = read_json(entry.path());
    for (Json& material : scene["materials"]) {
      if (material["type"] == "measured") {
        material["file"] =
            "furnace.json";  // made by the demo, and the parser asks no more than that it is there
      }
    }
    for (const Diagnostic& d : parser_problems(scene.dump())) {
      ADD_FAILURE() << entry.path() << ": " << d.text();
    }
  }
}

TEST(SceneSchema, TakesTheSceneWithEverythingAsTheParserDoes) {
  EXPECT_TRUE(SchemaFile().accepts(everything()));
  for (const Diagnostic& d : parser_problems(everything().dump())) {
    ADD_FAILURE() << d.text();
  }
}

TEST(SceneSchema, AgreesWithTheParserOnTheKeysOfEachCamera) {
  const SchemaFile schema;
  for (const char* type : {"pinhole", "thin_lens", "orthographic"}) {
    for (const char* key : {"fov_deg", "lens_radius", "focus_distance", "view_size"}) {
      Json scene = everything();
      scene["camera"] = {{"type", type}, {"origin", {0, -5, 2}}, {"target", {0, 0, 1}}, {"up", {0, 0, 1}}};
      if (type == std::string("thin_lens")) scene["camera"]["lens_radius"] = 0.5;
      scene["camera"][key] = 1;
      expect_agreement(schema, scene, std::string(type) + " with " + key);
    }
  }
}

TEST(SceneSchema, AgreesWithTheParserOnUnknownKeys) {
  const SchemaFile schema;
  for (const auto& place : places_of(everything())) {
    Json scene = everything();
    if (scene[place].is_object()) {
      scene[place]["surplus"] = 1;
      EXPECT_FALSE(expect_agreement(schema, scene, place.to_string() + " + surplus"));
    }
  }
}

TEST(SceneSchema, AgreesWithTheParserOnMissingKeys) {
  const SchemaFile schema;
  int refused = 0;
  for (const auto& place : places_of(everything())) {
    Json scene = everything();
    if (!place.empty() && scene[place.parent_pointer()].is_object()) {
      scene[place.parent_pointer()].erase(place.back());
      refused += expect_agreement(schema, scene, "without " + place.to_string()) ? 0 : 1;
    }
  }
  EXPECT_GE(refused, 40);  // required keys of the scene above
}

TEST(SceneSchema, AgreesWithTheParserOnTypesAndRanges) {
  const SchemaFile schema;
  const std::vector<Json> replacements{nullptr,
                                       true,
                                       "text",
                                       "",
                                       0,
                                       -1,
                                       2,
                                       0.5,
                                       123456.5,
                                       100000,
                                       1e60,
                                       200,
                                       Json::array(),
                                       {1, 2},
                                       {0, 0, 0},
                                       {1, 2, 3},
                                       {1, 2, 3, 4},
                                       Json::object(),
                                       {{"scale", 1}},
                                       {{"rgb", {1, 1, 1}}}};
  int refused = 0;
  for (const auto& place : places_of(everything())) {
    if (!place.empty() && place.back() == "$schema") {
      continue;  // ignored, whatever it is
    }
    for (const Json& replacement : replacements) {
      Json scene = everything();
      scene[place] = replacement;
      refused += expect_agreement(schema, scene, place.to_string() + " = " + replacement.dump()) ? 0 : 1;
    }
  }
  EXPECT_GE(refused, 3000);
}

TEST(SceneSchema, AgreesWithTheParserOnMisspeltWords) {
  const SchemaFile schema;
  for (const auto& place : places_of(everything())) {
    Json scene = everything();
    if (place.empty() || place.back() == "$schema" || place.back() == "name" || !scene[place].is_string()) {
      continue;
    }
    scene[place] = scene[place].get<std::string>() + "x";
    const bool is_free_text = place.back() == "material" || place.back() == "group" ||
                              place.back() == "file" || place.back() == "bitmap" || place.back() == "normals";
    EXPECT_EQ(expect_agreement(schema, scene, place.to_string()), is_free_text) << place.to_string();
    EXPECT_FALSE(parser_problems(scene.dump()).empty()) << place.to_string();
  }
}

}  // namespace
}  // namespace spectrace
