// SPDX-License-Identifier: Apache-2.0
#include "cli/reproduce/reference_scene.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <system_error>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/image/image.h"
#include "core/math/math.h"

namespace spectrace::cli {
namespace {

namespace fs = std::filesystem;

/// The ball: a unit sphere with bumps, so that one picture holds many incidences, some in its own shade.
Vec3 ball_point(double theta, double phi) {
  constexpr double kBumpHeight = 0.07;
  const double s = std::sin(theta);
  const double radius = 1 + kBumpHeight * s * s * std::cos(7 * phi) * std::cos(6 * theta);
  return {static_cast<Float>(radius * s * std::cos(phi)), static_cast<Float>(radius * s * std::sin(phi)),
          static_cast<Float>(radius * std::cos(theta))};
}

Vec3 ball_normal(double theta, double phi) {
  constexpr double kStep = 1e-3;  // [rad] far below a bump, far above the rounding of single precision
  const double t = std::clamp(theta, 2 * kStep, kPi64 - 2 * kStep);
  const Vec3 along_theta = ball_point(t + kStep, phi) - ball_point(t - kStep, phi);
  const Vec3 along_phi = ball_point(t, phi + kStep) - ball_point(t, phi - kStep);
  return normalize(cross(along_theta, along_phi));
}

std::string ball_obj() {
  constexpr int kRows = 96, kColumns = 192;
  std::string text = "# A unit sphere with bumps. Made by spectrace.\n";
  for (int i = 0; i <= kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const double theta = kPi64 * i / kRows, phi = 2 * kPi64 * j / kColumns;
      const Vec3 p = ball_point(theta, phi), n = ball_normal(theta, phi);
      fmt::format_to(std::back_inserter(text), "v {:.6f} {:.6f} {:.6f}\nvn {:.5f} {:.5f} {:.5f}\n", p.x, p.y,
                     p.z, n.x, n.y, n.z);
    }
  }
  const auto index = [](int i, int j) { return i * kColumns + j % kColumns + 1; };
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < kColumns; ++j) {
      const int a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
      // The triangles at the poles that have no area are left out.
      if (i + 1 < kRows) fmt::format_to(std::back_inserter(text), "f {0}//{0} {1}//{1} {2}//{2}\n", a, b, c);
      if (i > 0) fmt::format_to(std::back_inserter(text), "f {0}//{0} {1}//{1} {2}//{2}\n", a, c, d);
    }
  }
  return text;
}

/// A lamp: radiance · exp(-(angle / width)²), in the colour of the sky's white.
struct Lamp {
  double azimuth_deg, elevation_deg, width_deg, radiance;
};
// Key, fill, two rims and one from above: broad and narrow highlights at many incidences.
constexpr std::array<Lamp, 5> kLamps{
    {{-130, 40, 14, 18}, {-40, 20, 22, 5}, {60, 35, 10, 20}, {150, 15, 18, 6}, {-90, 80, 12, 12}}};
constexpr double kSky = 0.35, kGround = 0.12;

/// Latitude-longitude, up is +z, column 0 at azimuth 180 degrees (docs/scene-format.md).
Image studio() {
  constexpr int kWidth = 512, kHeight = 256;
  Image image(kWidth, kHeight, {"R", "G", "B"});
  for (int y = 0; y < kHeight; ++y) {
    const double elevation = kPi64 / 2 - kPi64 * (y + 0.5) / kHeight;
    for (int x = 0; x < kWidth; ++x) {
      const double azimuth = 2 * kPi64 * (x + 0.5) / kWidth;
      double radiance = std::lerp(kGround, kSky, 0.5 + 0.5 * std::sin(elevation));
      for (const Lamp& lamp : kLamps) {
        const double e = lamp.elevation_deg * kPi64 / 180, a = lamp.azimuth_deg * kPi64 / 180;
        const double cosine =
            std::sin(e) * std::sin(elevation) + std::cos(e) * std::cos(elevation) * std::cos(a - azimuth);
        const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) / (lamp.width_deg * kPi64 / 180);
        radiance += lamp.radiance * std::exp(-angle * angle);
      }
      for (std::size_t c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(radiance);
    }
  }
  return image;
}

void write_point(JsonWriter& json, std::string_view name, std::array<double, 3> point) {
  json.key(name);
  json.begin_array();
  for (const double x : point) json.value(x);
  json.end_array();
}

std::string scene_text(const std::string& environment, int height) {
  JsonWriter json;
  json.begin_object();
  json.key("camera");
  json.begin_object();
  json.member("type", "pinhole");
  write_point(json, "origin", {0, -7.2, 1.8});
  write_point(json, "target", {0, 0, 0});
  write_point(json, "up", {0, 0, 1});
  json.member("fov_deg", 17.0);
  json.end_object();
  json.key("film");
  json.begin_object();
  json.member("width", 2 * height);
  json.member("height", height);
  json.end_object();
  json.key("integrator");  // the balls shade and light themselves and each other
  json.begin_object();
  json.member("max_depth", 3);
  json.member("roulette_depth", 3);
  json.end_object();
  json.key("materials");
  json.begin_array();
  json.begin_object();
  json.member("name", "material");
  json.member("type", "lambert");
  json.member("reflectance", 0.5);
  json.end_object();
  json.end_array();
  json.key("shapes");
  json.begin_array();
  json.begin_object();
  json.member("type", "sphere");
  json.member("material", "material");
  write_point(json, "center", {-1.06, 0, 0});
  json.end_object();
  json.begin_object();
  json.member("type", "mesh");
  json.member("file", "ball.obj");
  json.member("material", "material");
  json.key("transform");
  json.begin_object();
  write_point(json, "translate", {1.06, 0, 0});
  json.end_object();
  json.end_object();
  json.end_array();
  json.key("lights");
  json.begin_array();
  json.begin_object();
  json.member("type", "environment");
  json.member("file", environment);
  json.end_object();
  json.end_array();
  json.end_object();
  return json.text();
}

}  // namespace

SceneDesc write_reference_scene(const fs::path& folder, const ReferenceSceneOptions& options) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw InputError(folder.string(), "", "cannot make this folder: " + failed.message());
  write_file_atomically(folder / "ball.obj", std::string_view(ball_obj()));
  std::string environment = "studio.exr";
  if (options.environment.empty()) {
    write_exr(folder / environment, studio(), {});
  } else {
    environment = fs::absolute(options.environment).string();
  }
  write_file_atomically(folder / "scene.json", std::string_view(scene_text(environment, options.height)));
  return load_scene(folder / "scene.json");
}

}  // namespace spectrace::cli
