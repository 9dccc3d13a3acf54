// SPDX-License-Identifier: Apache-2.0
#include "tests/support/readable_inputs.h"

#include <fmt/format.h>

#include <regex>
#include <stdexcept>

#include "core/image/image.h"
#include "materials/measured_tables.h"
#include "tests/support/run_program.h"
#include "tests/support/synthetic_measured.h"

namespace spectrace::test {

namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kQuick{"--spp", "1", "--threads", "1"};
const std::vector<std::string> kPictures{"out.exr", "out.png"};

std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<std::string> render(const std::string& scene) { return with({scene, "-o", "out.exr"}, kQuick); }

/// A command that must succeed.
void make(const fs::path& folder, const std::vector<std::string>& command) {
  const ProgramResult result = run_spectrace(command, folder);
  if (result.exit_code != 0) throw std::runtime_error(result.errors);
}

/// A ball under a sky, 12 x 8 pixels.
std::string ball_scene(const std::string& material, const std::string& sky = R"("radiance": 1)",
                       const std::string& shape = R"("type": "sphere")") {
  return fmt::format(R"({{"camera": {{"origin": [0, -4, 1], "target": [0, 0, 0], "up": [0, 0, 1]}},
"film": {{"width": 12, "height": 8}},
"materials": [{{"name": "m", {}}}],
"shapes": [{{"material": "m", {}}}],
"lights": [{{"type": "environment", {}}}]}})",
                     material, shape, sky);
}

void write_measured(const fs::path& file, const SyntheticMeasured& options = {}) {
  measured_to_tensors(make_measured(options)).write(file);
}

void write_picture(const fs::path& file, int width, int height) {
  Image image(width, height, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(i * 37 % 64) / 64;
  if (file.extension() == ".png") {
    write_png(file, image);
  } else {
    write_exr(file, image, {{"comment", std::string("made by a test")}});
  }
}

/// What the shipped scenes leave out.
constexpr const char* kEverything = R"({
  "spectrum": {"range_nm": [380, 720], "sampling": "uniform"},
  "camera": {"type": "thin_lens", "origin": [0, -5, 2], "target": [0, 0, 0.5], "up": [0, 0, 1], "lens_radius": 0.1,
             "focus_distance": 4.5},
  "film": {"width": 512, "height": 512, "spectral": {"bins": 5, "measure": "centers"}},
  "aovs": ["denoise", "diffuse_direct", "crypto_object"],
  "sampler": {"spp": 4, "seed": 7},
  "integrator": {"max_depth": 4, "roulette_depth": 2, "next_event": true},
  "materials": [
    {"name": "measured", "type": "measured", "file": "m.bsdf"},
    {"name": "separated", "type": "separated", "file": "m.sep", "model": "fresnel"},
    {"name": "flakes", "type": "diffractive", "metal": "Al", "roughness": [0.1, 0.2],
     "micro_roughness": {"rms_nm": 40, "correlation_nm": 2000, "exponent": 2.5}},
    {"name": "sides", "type": "two_sided", "front": {"type": "lambert", "reflectance": {"bitmap": "picture.png"}},
     "back": {"type": "normal_map", "normals": "picture.png", "material": {"type": "plastic", "reflectance": 0.5,
     "eta": {"cauchy": {"a": 1.5, "b_um2": 0.004}}, "roughness": 0.2}}},
    {"name": "leaf", "type": "mask", "opacity": {"bitmap": "picture.png"}, "material": {"type": "mix", "weight": 0.4,
     "first": {"type": "glossy", "reflectance": 0.5, "f0": 0.04, "roughness": 0.3},
     "second": {"type": "dielectric", "eta": 1.5, "roughness": 0.3}}}
  ],
  "groups": [{"name": "pair", "shapes": [{"type": "sphere", "material": "flakes", "radius": 0.2},
    {"type": "disk", "material": "leaf", "center": [0, 0, 0.3], "normal": [0, 1, 1], "radius": 0.3}]}],
  "shapes": [
    {"type": "sphere", "material": "measured", "center": [-1, 0, 0.5], "radius": 0.5, "name": "first ball"},
    {"type": "sphere", "material": "separated", "center": [0, 0, 0.5], "radius": 0.5},
    {"type": "mesh", "material": "sides", "file": "mesh.obj", "smooth_normals": false,
     "transform": [{"scale": [1, 1, 0.5]}, {"rotate": {"axis": [0, 0, 1], "angle_deg": 30}}, {"translate": [1, 0, 0.5]}]},
    {"type": "instance", "group": "pair", "transform": {"matrix": [1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1, 0.5]}},
    {"type": "disk", "material": "sides", "radius": 6, "emission": {"blackbody_K": 3000, "scale": 1e-9}}
  ],
  "lights": [
    {"type": "environment", "file": "picture.exr", "scale": 2, "transform": {"rotate": {"axis": [0, 0, 1], "angle_deg": 9}}},
    {"type": "point", "position": [0, 0, 3], "intensity": {"illuminant": "F2"}},
    {"type": "spot", "position": [2, 0, 3], "target": [0, 0, 0], "intensity": {"rgb": [1, 2, 3]}, "cone_deg": 40},
    {"type": "directional", "direction": [0, 1, -1], "irradiance": {"wavelengths_nm": [400, 700], "values": [0, 1]}}
  ]
}
)";

constexpr const char* kMesh = R"(# an open box
mtllib mesh.mtl
o box
v -1 -1 0
v 1 -1 0
v 1 1 0.25
v -1 1 0.25
v -1 -1 1e0
v 1 -1 1.0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vn 0 0 1
vn 0 -1 0
g floor
usemtl red
f 1/1/1 2/2/1 3/3/1 4/4/1
usemtl grey
s 1
f 1//2 5//2 6//2
f -6//-1 -1//-1 -5//-1
)";

constexpr const char* kLibrary = R"(newmtl red
Kd 0.6 0.1 0.1
newmtl grey
Kd 0.5
Ks 0.2 0.2 0.2
Ns 40
illum 2
)";

void write_mesh(const fs::path& folder) {
  write_text(folder / "mesh.obj", kMesh);
  write_text(folder / "mesh.mtl", kLibrary);
}

std::vector<Reading> scenes(const fs::path& folder) {
  static const std::regex kSize(R"("width": \d+, "height": \d+)");
  static const std::regex kMeasurement(R"(\.\./demo-out/pearlescent\.bsdf)");
  write_measured(folder / "m.bsdf");
  make(folder, {"separate", "m.bsdf", "-o", "m.sep", "--grid", "24x20x30"});
  write_picture(folder / "picture.png", 8, 6);
  write_picture(folder / "picture.exr", 8, 4);
  write_mesh(folder);
  fs::copy(fs::path(SPECTRACE_SOURCE_DIR) / "scenes/meshes", folder / "meshes");
  write_text(folder / "everything.json", kEverything);
  for (const auto& entry : fs::directory_iterator(fs::path(SPECTRACE_SOURCE_DIR) / "scenes")) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".json") && !name.ends_with("schema.json")) fs::copy(entry.path(), folder / name);
  }
  std::vector<std::string> spectral;
  for (const char* lobe : {"", ".diffuse", ".specular"}) {
    spectral.push_back(fmt::format("out{}.spectral.exr", lobe));
  }
  std::vector<Reading> readings;
  for (const auto& [name, text] : files_in(folder)) {
    if (!name.ends_with(".json")) continue;
    const std::string small = std::regex_replace(text, kSize, R"("width": 12, "height": 8)");
    write_text(folder / name, std::regex_replace(small, kMeasurement, "m.bsdf"));
    readings.push_back({.damaged = name,
                        .is_text = true,
                        .command = render(name),
                        .outputs = kPictures,
                        .files = {"m.bsdf", "m.sep", "picture.", "mesh", "meshes/"},
                        .lists_mistakes = true});
    if (name == "everything.json") {
      readings.back().outputs = with(kPictures, spectral);
      readings.insert(readings.end(), 4, readings.back());  // as often as most of the others together
    }
  }
  return readings;
}

std::vector<Reading> measurements(const fs::path& folder) {
  write_measured(folder / "m.bsdf");
  write_measured(folder / "turned.bsdf", {.isotropic = false});
  write_measured(folder / "rgb.bsdf", {.rgb = true});
  std::vector<Reading> readings;
  for (const std::string name : {"m.bsdf", "turned.bsdf", "rgb.bsdf"}) {
    const std::string scene = name + ".json";
    write_text(folder / scene, ball_scene(fmt::format(R"("type": "measured", "file": "{}")", name)));
    readings.push_back({.damaged = name, .command = {"inspect", name}});
    readings.push_back(
        {.damaged = name,
         .command = {"separate", name, "-o", "out.sep", "--grid", "24x20x30", "--threads", "1"},
         .outputs = {"out.sep"},
         .may_differ = true});
    readings.push_back({.damaged = name, .command = render(scene), .outputs = kPictures});
  }
  return readings;
}

std::vector<Reading> separated(const fs::path& folder) {
  write_measured(folder / "m.bsdf");
  const std::vector<std::string> separate{"separate", "m.bsdf",   "--grid",     "16x16x20",
                                          "--model",  "residual", "--analytic", "-o"};
  make(folder, with(separate, {"compact.sep"}));
  make(folder, with(separate, {"full.sep", "--full"}));
  std::vector<Reading> readings;
  for (const std::string name : {"compact.sep", "full.sep"}) {
    readings.push_back({.damaged = name, .command = {"inspect", name}});
    for (const std::string model : {"sun", "fresnel", "diffraction", "residual", "analytic"}) {
      const std::string scene = name + '.' + model + ".json";
      write_text(folder / scene,
                 ball_scene(fmt::format(R"("type": "separated", "file": "{}", "model": "{}")", name, model)));
      readings.push_back({.damaged = name, .command = render(scene), .outputs = kPictures});
    }
  }
  return readings;
}

std::vector<Reading> meshes(const fs::path& folder) {
  write_mesh(folder);
  const std::string grey = R"("type": "lambert", "reflectance": 0.5)", sky = R"("radiance": 1)";
  write_text(folder / "one.json", ball_scene(grey, sky, R"("type": "mesh", "file": "mesh.obj")"));
  write_text(folder / "library.json",
             ball_scene(grey, sky, R"("type": "mesh", "file": "mesh.obj", "materials": {})"));
  std::vector<Reading> readings;
  for (const char* scene : {"one.json", "library.json"}) {
    readings.push_back({.damaged = "mesh.obj",
                        .is_text = true,
                        .command = render(scene),
                        .outputs = kPictures,
                        .lists_mistakes = true});
  }
  return readings;
}

std::vector<Reading> images(const fs::path& folder) {
  write_picture(folder / "damaged.exr", 24, 12);
  write_picture(folder / "whole.exr", 24, 12);
  write_text(folder / "texture.json",
             ball_scene(R"("type": "lambert", "reflectance": {"bitmap": "damaged.exr"})"));
  write_text(folder / "sky.json",
             ball_scene(R"("type": "lambert", "reflectance": 0.5)", R"("file": "damaged.exr")"));
  return {{.damaged = "damaged.exr", .command = {"inspect", "damaged.exr"}},
          {.damaged = "damaged.exr", .command = {"compare", "whole.exr", "damaged.exr"}, .may_differ = true},
          {.damaged = "damaged.exr", .command = {"sheet", "out.png", "damaged.exr"}, .outputs = {"out.png"}},
          {.damaged = "damaged.exr", .command = render("texture.json"), .outputs = kPictures},
          {.damaged = "damaged.exr", .command = render("sky.json"), .outputs = kPictures}};
}

std::vector<Reading> checkpoints(const fs::path& folder) {
  write_text(folder / "ball.json", ball_scene(R"("type": "lambert", "reflectance": 0.5)"));
  make(folder, {"ball.json", "-o", "out.exr", "--samples", "0:8"});
  fs::copy(folder / "out.partial", folder / "part.partial");
  for (const std::string& picture : kPictures) fs::remove(folder / picture);
  return {{.damaged = "part.partial",
           .command = {"merge", "part.partial", "-o", "out.exr"},
           .outputs = kPictures,
           .lists_mistakes = true},
          {.damaged = "out.partial",
           .command = {"ball.json", "-o", "out.exr", "--spp", "16", "--resume", "--threads", "1"},
           .outputs = with(kPictures, {"out.partial"}),
           .lists_mistakes = true}};
}

}  // namespace

std::vector<Reading> write_readable_inputs(FileKind kind, const fs::path& folder) {
  switch (kind) {
    case FileKind::kScene:
      return scenes(folder);
    case FileKind::kMeasured:
      return measurements(folder);
    case FileKind::kSeparated:
      return separated(folder);
    case FileKind::kObj:
      return meshes(folder);
    case FileKind::kExr:
      return images(folder);
    case FileKind::kCheckpoint:
      return checkpoints(folder);
  }
  return {};
}

}  // namespace spectrace::test
