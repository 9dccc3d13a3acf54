// SPDX-License-Identifier: Apache-2.0
// What a scene says of its images: size, part, wavelengths, AOVs.
#include <fmt/format.h>

#include "renderer/scene_desc.h"
#include "renderer/scene_parser.h"

namespace spectrace {
namespace {

constexpr std::int64_t kMaxSide = 65536;
// What read_image() accepts by default: a larger image could be written but not compared.
constexpr std::int64_t kMaxPixels = std::int64_t(1) << 28;
constexpr std::int64_t kMaxBins = 1000;  // OpenImageIO's limit of channels, R, G and B beside them, is 1024

/// [x, y, width, height] in pixels of the image.
std::optional<CropWindow> parse_crop(const JsonValue& json, const FilmDesc& film) {
  const std::vector<JsonValue> parts = json.elements();
  if (parts.size() != 4) {
    json.error("expected [x, y, width, height] in pixels of the image");
    return std::nullopt;
  }
  const auto part = [&](std::size_t i, std::int64_t fallback, std::int64_t min, std::int64_t max) {
    return static_cast<int>(parts[i].integer(fallback, min, max));
  };
  CropWindow crop{.x = part(0, 0, 0, film.width - 1), .y = part(1, 0, 0, film.height - 1)};
  crop.width = part(2, 1, 1, film.width - crop.x);
  crop.height = part(3, 1, 1, film.height - crop.y);
  return crop;
}

}  // namespace

void parse_film(const JsonValue& json, FilmDesc& film) {
  const std::int64_t width = json.get("width").integer(film.width, 1, kMaxSide);
  const std::int64_t height = json.get("height").integer(film.height, 1, kMaxSide);
  film.width = static_cast<int>(width);
  film.height = static_cast<int>(height);
  if (const JsonValue crop = json.get("crop"); crop.exists()) film.crop = parse_crop(crop, film);
  // Read once the range of wavelengths is known: parse_spectral_film().
  if (json.get("spectral").exists()) film.spectral = SpectralFilmDesc{};
  json.reject_unknown_keys();
  if (width * height > kMaxPixels) {
    json.error(fmt::format("{} x {} pixels: more than {}", width, height, kMaxPixels));
  }
}

/// Bins of the scene's range, or of a part of it.
void parse_spectral_film(const JsonValue& json, SceneDesc& scene) {
  if (!json.exists()) return;
  SpectralFilmDesc& film = *scene.film.spectral;
  film.bins.range = scene.range;
  if (const JsonValue range = json.get("range_nm"); range.exists()) {
    const std::vector<double> ends = range.numbers(2, 2, kWavelengths);
    if (ends.size() == 2) {
      film.bins.range = {static_cast<Float>(ends[0]), static_cast<Float>(ends[1])};
      if (!(ends[1] > ends[0]) || film.bins.range.min_nm < scene.range.min_nm ||
          film.bins.range.max_nm > scene.range.max_nm) {
        range.error(fmt::format("expected [min, max] within the scene's range, [{}, {}] nm (\"spectrum\")",
                                scene.range.min_nm, scene.range.max_nm));
      }
    }
  }
  film.bins.count = static_cast<std::size_t>(json.require("bins").integer(1, 1, kMaxBins));
  film.lobes = json.get("lobes").boolean(film.lobes);
  film.bins.at_centers = json.get("measure").choice("mean", {"mean", "centers"}) == "centers";
  if (film.bins.at_centers && !(film.bins.range == scene.range)) {
    json.get("measure").error(
        "centres of bins are sampled over the whole range of the scene: leave out range_nm");
  }
  json.reject_unknown_keys();
}

/// A name, or a list of names.
void parse_aovs(const JsonValue& json, SceneDesc& scene) {
  if (!json.exists()) return;
  scene.aovs = kNoAovs;
  const auto add = [&](const JsonValue& name) {
    if (!name.is_string()) {
      name.error("expected the name of an AOV or of a group of them");
    } else if (const auto problem = add_aov(name.string(), scene.aovs)) {
      name.error(*problem);
    }
  };
  if (json.is_array()) {
    for (const JsonValue& name : json.elements()) add(name);
  } else {
    add(json);
  }
}

}  // namespace spectrace
