// SPDX-License-Identifier: Apache-2.0
#include "renderer/partial_render.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <iterator>
#include <limits>
#include <optional>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/version.h"
#include "materials/tensor_file.h"
#include "renderer/words_hash.h"

namespace spectrace {

namespace {

namespace fs = std::filesystem;

constexpr const char* kDescription = "spectrace partial render, format 3";
constexpr std::int64_t kMaxSide = 65536, kMaxSamples = std::int64_t(1) << 40;
constexpr std::int64_t kMaxBins = 1000;

template <typename T>
Tensor to_tensor(std::string name, TensorType type, std::vector<std::size_t> shape,
                 const std::vector<T>& values) {
  Tensor tensor{.name = std::move(name), .type = type, .shape = std::move(shape), .bytes = {}};
  tensor.bytes.resize(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(tensor.bytes.data(), values.data(), tensor.bytes.size());
  return tensor;
}

template <typename T>
std::vector<T> from_tensor(const Tensor& tensor) {
  std::vector<T> values(tensor.bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), tensor.bytes.data(), values.size() * sizeof(T));
  return values;
}

std::string text_of(const Tensor& tensor) {
  return {reinterpret_cast<const char*>(tensor.bytes.data()), tensor.bytes.size()};
}

// ---- The header: JSON
// ---------------------------------------------------------------------------------------

void write_names(JsonWriter& json, std::string_view key, const std::vector<std::string>& names) {
  json.key(key);
  json.begin_array();
  for (const std::string& name : names) json.value(name);
  json.end_array();
}

std::vector<std::string> names_of(LayerSet layers) {
  std::vector<std::string> names;
  layers.for_each([&](Layer layer) { names.emplace_back(layer_name(layer)); });
  return names;
}

/// Every name whose AOVs are in the set; together they are the set.
std::vector<std::string> names_of(const AovSet& aovs) {
  std::vector<std::string> names;
  for (const AovName& each : aov_names()) {
    if ((aovs | each.set) == aovs) names.emplace_back(each.name);
  }
  return names;
}

std::string header_text(const PartialRender& partial) {
  const Film& film = partial.film;
  JsonWriter json;
  json.begin_object();
  json.member("program", partial.identity.program);
  json.member("scene_sha256", partial.identity.scene_sha256);
  write_names(json, "material_sha256s", partial.identity.material_sha256s);
  write_names(json, "file_sha256s", partial.identity.file_sha256s);
  write_names(json, "approximations", partial.identity.approximations);
  json.member("seed", std::to_string(partial.identity.seed));
  json.member("sampler", sampler_name(partial.identity.sampler));
  json.member("width", film.width());
  json.member("height", film.height());
  json.member("first_sample", film.target().first);
  json.member("last_sample", film.target().last);
  write_names(json, "layers", names_of(film.layout().layers));
  write_names(json, "aovs", names_of(film.layout().aovs));
  if (const std::optional<SpectralBins>& bins = film.layout().bins) {
    json.key("bins");
    json.begin_object();
    json.member("min_nm", bins->range.min_nm);
    json.member("max_nm", bins->range.max_nm);
    json.member("count", bins->count);
    json.member("at_centers", bins->at_centers);
    write_names(json, "layers", names_of(film.layout().bin_layers));
    json.end_object();
  }
  json.key("image");
  json.begin_object();
  for (const auto& [name, value] : partial.metadata) {
    json.key(name);
    std::visit([&](const auto& v) { json.value(v); }, value);
  }
  json.end_object();
  json.end_object();
  return json.text();
}

LayerSet read_layers(const JsonValue& json) {
  LayerSet layers;
  for (const JsonValue& element : json.elements()) {
    const std::string name = element.string();
    bool is_known = false;
    for (int i = 0; i < kLayerCount; ++i) {
      if (layer_name(Layer(i)) != name) continue;
      layers = layers | LayerSet(Layer(i));
      is_known = true;
    }
    if (!is_known) element.error("is no layer");
  }
  return layers;
}

std::vector<std::string> read_texts(const JsonValue& json) {
  std::vector<std::string> texts;
  for (const JsonValue& element : json.elements()) texts.push_back(element.string());
  return texts;
}

std::uint64_t read_seed(const JsonValue& json) {
  const std::string text = json.string();
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size()) json.error("expected digits of a seed");
  return seed;
}

SamplerKind read_sampler(const JsonValue& json) {
  const std::string name = json.string();
  for (const SamplerKind kind : {SamplerKind::kOwenSobol, SamplerKind::kIndependent}) {
    if (name == sampler_name(kind)) return kind;
  }
  json.error("is no sampler");
  return SamplerKind::kOwenSobol;
}

struct Header {
  RenderIdentity identity;
  Metadata metadata;
  FilmLayout layout;
  int width = 1, height = 1;
  SampleRange target;
};

void read_layout(const JsonValue& root, FilmLayout& layout) {
  layout.layers = read_layers(root.require("layers"));
  for (const JsonValue& name : root.require("aovs").elements()) {
    if (const auto problem = add_aov(name.string(), layout.aovs)) name.error(*problem);
  }
  const JsonValue json = root.get("bins");
  if (!json.exists()) return;
  const auto nm = [&](const char* key) {
    return static_cast<Float>(json.require(key).number(1, {.min = 1, .max = 1e6}));
  };
  SpectralBins bins{.range = {nm("min_nm"), nm("max_nm")}};
  if (!(bins.range.width_nm() > 0)) json.error("expected min_nm below max_nm");
  bins.count = std::size_t(json.require("count").integer(1, 1, kMaxBins));
  bins.at_centers = json.require("at_centers").boolean(false);
  layout.bins = bins;
  layout.bin_layers = read_layers(json.require("layers"));
}

Header read_header(const std::string& text, const std::string& file) {
  JsonDocument document = JsonDocument::parse(text, file);
  const JsonValue root = document.root();
  Header header;
  header.identity = {.program = root.require("program").string(),
                     .scene_sha256 = root.require("scene_sha256").string(),
                     .material_sha256s = read_texts(root.require("material_sha256s")),
                     .file_sha256s = read_texts(root.require("file_sha256s")),
                     .approximations = read_texts(root.require("approximations")),
                     .seed = read_seed(root.require("seed")),
                     .sampler = read_sampler(root.require("sampler"))};
  header.width = int(root.require("width").integer(1, 1, kMaxSide));
  header.height = int(root.require("height").integer(1, 1, kMaxSide));
  header.target.first = std::uint64_t(root.require("first_sample").integer(0, 0, kMaxSamples));
  header.target.last = std::uint64_t(root.require("last_sample").integer(1, 1, kMaxSamples));
  if (header.target.first % kLeafSamples != 0 || header.target.first >= header.target.last) {
    root.error("expected first_sample to be a multiple of 8 and below last_sample");
  }
  read_layout(root, header.layout);
  const JsonValue image = root.require("image");
  for (const std::string& key : image.keys()) {
    const JsonValue value = image.get(key);
    if (value.is_string()) {
      header.metadata[key] = value.string();
    } else if (value.is_integer()) {
      constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
      header.metadata[key] = value.integer(0, -kMost, kMost);
    } else {
      header.metadata[key] = value.number(0);
    }
  }
  root.reject_unknown_keys();
  document.throw_if_wrong();
  return header;
}

// ---- Counts of mattes: three columns
// --------------------------------------------------------------------------------

std::string column(Matte matte, const char* name) { return fmt::format("{}_{}", matte_name(matte), name); }

void write_matte(Matte matte, const MatteCounts& counts, TensorFile& out) {
  std::vector<std::uint32_t> pixels, ids;
  std::vector<std::uint64_t> samples;
  for (const MatteCount& count : counts) {
    pixels.push_back(count.pixel);
    ids.push_back(count.id);
    samples.push_back(count.samples);
  }
  out.add(to_tensor(column(matte, "pixels"), TensorType::kU32, {counts.size()}, pixels));
  out.add(to_tensor(column(matte, "ids"), TensorType::kU32, {counts.size()}, ids));
  out.add(to_tensor(column(matte, "samples"), TensorType::kU64, {counts.size()}, samples));
}

MatteCounts read_matte(Matte matte, const TensorFile& in) {
  const TensorType u32[1] = {TensorType::kU32}, u64[1] = {TensorType::kU64};
  const std::size_t any[1] = {0};
  const auto pixels = from_tensor<std::uint32_t>(in.require(column(matte, "pixels"), u32, any));
  const auto as_long = [&](const Tensor& tensor) -> const Tensor& {
    if (tensor.shape[0] != pixels.size())
      throw InputError(in.file_name(), "field " + tensor.name, "is of another length");
    return tensor;
  };
  const auto ids = from_tensor<std::uint32_t>(as_long(in.require(column(matte, "ids"), u32, any)));
  const auto samples = from_tensor<std::uint64_t>(as_long(in.require(column(matte, "samples"), u64, any)));
  MatteCounts counts;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    counts.push_back({.pixel = pixels[i], .id = ids[i], .samples = samples[i]});
  }
  return counts;
}

constexpr const char* kChecksum = "checksum";

/// Of all other fields: a damaged sum would be a wrong picture that looks like a right one.
std::uint64_t checksum_of(const std::vector<Tensor>& tensors) {
  std::uint64_t h = WordsHash::kStart;
  const auto add_bytes = [&h](const void* bytes, std::size_t size) {
    const auto* at = static_cast<const std::byte*>(bytes);
    for (std::size_t i = 0; i < size; i += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, at + i, std::min(size - i, sizeof(word)));
      h = WordsHash::add(h, word);
    }
    h = WordsHash::add(h, size);
  };
  for (const Tensor& tensor : tensors) {
    if (tensor.name == kChecksum) continue;
    add_bytes(tensor.name.data(), tensor.name.size());
    for (const std::size_t extent : tensor.shape) h = WordsHash::add(h, extent);
    add_bytes(tensor.bytes.data(), tensor.bytes.size());
  }
  return h;
}

/// Last of all: what is wrong with a field is said by its name first.
void check_whole(const TensorFile& in) {
  const TensorType u64[1] = {TensorType::kU64};
  const std::size_t one[1] = {1};
  const std::uint64_t found = from_tensor<std::uint64_t>(in.require(kChecksum, u64, one)).front();
  if (found != checksum_of(in.tensors()))
    throw InputError(in.file_name(), "", "is damaged: its content is not what was written");
}

/// The file of the first line, "file: digest", that only one of two sorted lists has.
std::string first_difference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  std::vector<std::string> only;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(only));
  return only.empty() ? "file" : only.front().substr(0, only.front().rfind(": "));
}

std::string describe(const std::vector<std::string>& approximations) {
  return approximations.empty() ? "exact" : fmt::format("{}", fmt::join(approximations, "; "));
}

}  // namespace

RenderIdentity identity_of(const Scene& scene, std::uint64_t seed) {
  return {.program = fmt::format("{} ({})", version(), commit()),
          .scene_sha256 = scene.sha256,
          .material_sha256s = scene.material_sha256s,
          .file_sha256s = scene.file_sha256s,
          .approximations = scene.approximations,
          .seed = seed,
          .sampler = scene.sampler};
}

void write_partial(const fs::path& file, const PartialRender& partial) {
  const Film& film = partial.film;
  const std::size_t pixels = std::size_t(film.width()) * std::size_t(film.height());
  TensorFile out;
  out.add(Tensor::from_text("description", kDescription));
  out.add(Tensor::from_text("header", header_text(partial)));
  out.add(to_tensor("ends", TensorType::kU64, {film.ends_by_tile().size()}, film.ends_by_tile()));
  for (std::size_t i = 0; i < film.planes().size(); ++i) {
    const Film::Plane& plane = film.planes()[i];
    out.add(to_tensor(fmt::format("rows_{}", i), TensorType::kF64, {pixels, plane.rows.size() / pixels},
                      plane.rows));
    if (plane.bins.empty()) continue;
    out.add(to_tensor(fmt::format("bins_{}", i), TensorType::kF32, {pixels, plane.bins.size() / pixels},
                      plane.bins));
  }
  for (const Matte matte : kMattes) {
    if (has_matte(film.layout().aovs, matte)) write_matte(matte, film.matte_counts(matte), out);
  }
  out.add(to_tensor(kChecksum, TensorType::kU64, {1}, std::vector{checksum_of(out.tensors())}));
  out.write(file);
}

PartialRender read_partial(const fs::path& file) {
  const TensorFile in = TensorFile::read(file);
  const std::string name = file.string();
  const std::size_t any[1] = {0};
  const TensorType text[1] = {TensorType::kU8};
  if (text_of(in.require("description", text, any)) != kDescription) {
    throw InputError(name, "field description", fmt::format("is no \"{}\"", kDescription));
  }
  Header header = read_header(text_of(in.require("header", text, any)), name + " (header)");
  const std::size_t pixels = std::size_t(header.width) * std::size_t(header.height);
  const std::size_t slots = header.layout.kept_slots().size(), bins = header.layout.bins_per_pixel();
  Film film(header.width, header.height, std::move(header.layout), header.target);
  const TensorType u64[1] = {TensorType::kU64}, f64[1] = {TensorType::kF64}, f32[1] = {TensorType::kF32};
  const std::size_t tiles[1] = {film.tiles().size()};
  std::vector<Film::Plane> planes;
  for (std::size_t i = 0; in.find(fmt::format("rows_{}", i)) != nullptr; ++i) {
    const std::size_t row_shape[2] = {pixels, slots}, bin_shape[2] = {pixels, bins};
    planes.push_back(
        {.rows = from_tensor<double>(in.require(fmt::format("rows_{}", i), f64, row_shape)), .bins = {}});
    if (bins > 0) {
      planes.back().bins = from_tensor<float>(in.require(fmt::format("bins_{}", i), f32, bin_shape));
    }
  }
  std::array<MatteCounts, kMatteKinds> mattes;
  for (const Matte matte : kMattes) {
    if (has_matte(film.layout().aovs, matte)) mattes[std::size_t(matte)] = read_matte(matte, in);
  }
  if (!film.restore(from_tensor<std::uint64_t>(in.require("ends", u64, tiles)), std::move(planes), mattes)) {
    throw InputError(name, "field ends",
                     "does not fit the range of samples and the fields rows_* and crypto_*");
  }
  check_whole(in);
  return {.identity = std::move(header.identity),
          .metadata = std::move(header.metadata),
          .film = std::move(film)};
}

void check_same_image(const PartialRender& partial, const fs::path& file, const RenderIdentity& wanted,
                      int width, int height, const FilmLayout& layout) {
  const auto refuse = [&](const std::string& problem) { throw InputError(file.string(), "", problem); };
  const RenderIdentity& found = partial.identity;
  if (found.scene_sha256 != wanted.scene_sha256)
    refuse("is of another scene, or the scene has changed since");
  if (found.material_sha256s != wanted.material_sha256s) {
    refuse("is of other materials or models of them, or their files have changed since");
  }
  if (found.file_sha256s != wanted.file_sha256s) {
    refuse(fmt::format("is of another {}, or it has changed since",
                       first_difference(found.file_sha256s, wanted.file_sha256s)));
  }
  if (found.approximations != wanted.approximations) {
    refuse(fmt::format("is {}, not {}", describe(found.approximations), describe(wanted.approximations)));
  }
  if (found.seed != wanted.seed) {
    refuse(fmt::format("is of seed {}, not of seed {}", found.seed, wanted.seed));
  }
  if (found.sampler != wanted.sampler) {
    refuse(
        fmt::format("is of sampler {}, not {}", sampler_name(found.sampler), sampler_name(wanted.sampler)));
  }
  if (found.program != wanted.program) {
    refuse(fmt::format("is by spectrace {}, not {}: their images may differ", found.program, wanted.program));
  }
  if (partial.film.width() != width || partial.film.height() != height) {
    refuse(fmt::format("has {} x {} pixels, not {} x {}", partial.film.width(), partial.film.height(), width,
                       height));
  }
  if (!(partial.film.layout() == layout)) refuse("holds other AOVs or wavelengths");
}

}  // namespace spectrace
