// SPDX-License-Identifier: Apache-2.0
#include "core/image/texture_cache.h"

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/texture.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include "core/base/error.h"
#include "core/image/kept_levels.h"

namespace spectrace {

namespace {

constexpr int kTile = 64;  // texels, as wide as high: of levels that the cache reads by rows

/// By the names the cache knows them under.
class Sources {
 public:
  static Sources& all() {
    static auto* const sources = new Sources;  // outlives every image and thread
    return *sources;
  }
  void add(const std::string& name, const TexelSource* source) {
    const std::lock_guard lock(mutex_);
    sources_[name] = source;
  }
  void remove(const std::string& name) {
    const std::lock_guard lock(mutex_);
    sources_.erase(name);
  }
  [[nodiscard]] const TexelSource* find(const std::string& name) const {
    const std::lock_guard lock(mutex_);
    const auto it = sources_.find(name);
    return it == sources_.end() ? nullptr : it->second;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, const TexelSource*> sources_;
};

/// Shows a source to the cache as a file of floats with all its levels.
class SourceInput final : public OIIO::ImageInput {
 public:
  [[nodiscard]] const char* format_name() const override { return "spectrace"; }

  bool open(const std::string& name, OIIO::ImageSpec& spec) override {
    return guarded([&] {
      source_ = Sources::all().find(name);
      if (source_ == nullptr) throw InternalError("the cache asks for an image that is gone");
      reader_ = source_->open();
      if (!seek_subimage(0, 0)) throw InternalError("an image without levels");
      spec = m_spec;
    });
  }
  bool open(const std::string& name, OIIO::ImageSpec& spec, const OIIO::ImageSpec&) override {
    return open(name, spec);
  }
  bool close() override {
    reader_.reset();
    return true;
  }

  [[nodiscard]] int current_subimage() const override { return 0; }
  [[nodiscard]] int current_miplevel() const override { return level_; }
  bool seek_subimage(int subimage, int level) override {
    if (subimage != 0 || level < 0 || std::size_t(level) >= source_->levels().size()) return false;
    const TexelLevel& l = source_->levels()[std::size_t(level)];
    m_spec = OIIO::ImageSpec(l.width, l.height, int(source_->channels()), OIIO::TypeFloat);
    m_spec.tile_width = l.tile_width;
    m_spec.tile_height = l.tile_height;
    level_ = level;
    return true;
  }

  bool read_native_scanline(int subimage, int level, int y, int z, void* data) override {
    return read_native_scanlines(subimage, level, y, y + 1, z, data);
  }
  bool read_native_scanlines(int, int level, int begin, int end, int, void* data) override {
    return guarded([&] {
      const std::lock_guard lock(mutex_);
      const std::vector<float> rows = reader_->rows(std::size_t(level), begin, end);
      std::copy(rows.begin(), rows.end(), static_cast<float*>(data));
    });
  }
  bool read_native_tile(int, int level, int x, int y, int, void* data) override {
    return guarded([&] {
      const std::lock_guard lock(mutex_);
      const std::vector<float> tile = reader_->tile(std::size_t(level), x, y);
      std::copy(tile.begin(), tile.end(), static_cast<float*>(data));
    });
  }

 private:
  /// The library knows no exceptions.
  template <typename Read>
  bool guarded(const Read& read) {
    try {
      read();
      return true;
    } catch (const std::exception& e) {
      errorfmt("{}", e.what());
      return false;
    }
  }

  const TexelSource* source_ = nullptr;
  std::unique_ptr<TexelReader> reader_;
  std::mutex mutex_;
  int level_ = 0;
};

OIIO::TextureSystem& textures() {
  static OIIO::TextureSystem* const system = [] {
    OIIO::TextureSystem* s = OIIO::TextureSystem::create(false);  // never destroyed: threads hold parts of it
    s->attribute("max_memory_MB", float(kTextureCacheMiB) / 2);
    s->attribute("autotile", kTile);
    s->attribute("deduplicate", 0);
    s->attribute("max_tile_channels", 1 << 16);  // a spectrum's channels share a tile
    return s;
  }();
  return *system;
}

OIIO::ImageCache& cache() { return *textures().imagecache(); }

OIIO::TextureSystem::Perthread* this_thread() {
  thread_local OIIO::TextureSystem::Perthread* const mine = textures().get_perthread_info();
  return mine;
}

float fraction(Float x) { return float(double(x) - std::floor(double(x))); }

}  // namespace

struct CachedImage::Entry {
  std::unique_ptr<const TexelSource> source;
  std::string file;  // for messages
  OIIO::ustring name;
  OIIO::TextureSystem::TextureHandle* handle = nullptr;

  Entry(std::unique_ptr<const TexelSource> texels, std::string for_messages)
      : source(std::move(texels)), file(std::move(for_messages)) {
    static std::atomic<std::uint64_t> count{0};
    name = OIIO::ustring(fmt::format("spectrace {}", ++count));
    Sources::all().add(name.string(), source.get());
    cache().add_file(name, [] { return static_cast<OIIO::ImageInput*>(new SourceInput); });
    handle = textures().get_texture_handle(name, this_thread());
    SPECTRACE_CHECK(handle != nullptr);
  }
  ~Entry() {
    cache().invalidate(name);
    Sources::all().remove(name.string());
  }
  Entry(const Entry&) = delete;
  Entry& operator=(const Entry&) = delete;
};

void set_texture_cache_limit(std::size_t mebibytes) {
  // Half for tiles, half for whole images of files that cannot be read from the middle at no cost.
  textures().attribute("max_memory_MB", float(mebibytes) / 2);
  set_kept_limit((mebibytes << 20) / 2);
}

std::size_t texture_cache_bytes() {
  long long bytes = 0;
  cache().getattribute("stat:cache_memory_used", OIIO::TypeInt64, &bytes);
  return std::size_t(bytes);
}

CachedImage::CachedImage(const Image& image)
    : entry_(std::make_shared<const Entry>(texels_in_memory(image), "image in memory")) {}

CachedImage::CachedImage(const std::filesystem::path& file, const std::vector<std::string>& channels,
                         TexelCoding coding)
    : entry_(std::make_shared<const Entry>(texels_of_file(file, channels, coding), file.string())) {}

std::size_t CachedImage::channels() const { return entry_->source->channels(); }

void CachedImage::mean(Vec2 uv, const Footprint& over, std::size_t first, std::size_t count,
                       float* means) const {
  if (!std::isfinite(uv.x)) uv.x = 0;
  if (!std::isfinite(uv.y)) uv.y = 0;
  const bool is_point = over.major.x == 0 && over.major.y == 0;
  OIIO::TextureOpt options;
  options.swrap = options.twrap = OIIO::TextureOpt::WrapPeriodic;
  options.interpmode = OIIO::TextureOpt::InterpBilinear;
  options.mipmode = is_point ? OIIO::TextureOpt::MipModeNoMIP : OIIO::TextureOpt::MipModeAniso;
  options.anisotropic = int(kLongestFootprint);
  options.firstchannel = int(first);
  // Rows run from the top, v from the bottom.
  const bool found = textures().texture(entry_->handle, this_thread(), options, fraction(uv.x),
                                        fraction(-uv.y), float(over.major.x), -float(over.major.y),
                                        float(over.minor.x), -float(over.minor.y), int(count), means);
  if (!found) throw InputError(entry_->file, "", textures().geterror());
}

}  // namespace spectrace
