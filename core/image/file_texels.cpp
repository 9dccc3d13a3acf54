// SPDX-License-Identifier: Apache-2.0
// Texels of files, through OpenImageIO.
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <fstream>
#include <optional>
#include <span>

#include "core/base/error.h"
#include "core/image/area_means.h"
#include "core/image/exr.h"
#include "core/image/kept_levels.h"
#include "core/image/texels.h"
#include "core/image/texture_cache.h"
#include "core/spectra/color.h"

namespace spectrace {

namespace {

// Beyond it a header is damaged or hostile: a row of that many texels must fit memory.
constexpr int kMaxSide = 1 << 17;
constexpr int kMaxChannels = 1024;
constexpr std::size_t kStripTexels = std::size_t(1) << 20;  // read at once: 4 MiB of floats

std::unique_ptr<OIIO::ImageInput> open_texture(const std::filesystem::path& file) {
  check_exr_header(file);
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // colours as stored, not multiplied by alpha
  auto in = OIIO::ImageInput::open(file.string(), &config);
  if (!in) {
    throw InputError(file.string(), "", fmt::format("cannot be read as an image: {}", OIIO::geterror()));
  }
  const OIIO::ImageSpec& spec = in->spec();
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 || spec.deep ||
      spec.width > kMaxSide || spec.height > kMaxSide || spec.nchannels > kMaxChannels) {
    throw InputError(file.string(), "",
                     fmt::format("{} x {} x {} pixels of {} channels are not read", spec.width, spec.height,
                                 spec.depth, spec.nchannels));
  }
  return in;
}

/// Grey has the names of colours, but in EXR, where names are a file's own.
std::vector<std::string> names_of(const OIIO::ImageInput& in) {
  const OIIO::ImageSpec& spec = in.spec();
  if (spec.nchannels >= 3 || std::string_view(in.format_name()) == "openexr") return spec.channelnames;
  std::vector<std::string> names{"R", "G", "B"};
  if (spec.nchannels == 2) names.emplace_back("A");
  return names;
}

/// Which stored channel the `i`-th of names_of() is.
int stored_channel(const OIIO::ImageInput& in, std::size_t i) {
  if (names_of(in).size() == std::size_t(in.spec().nchannels)) return int(i);
  return i == 3 ? 1 : 0;
}

/// 8-bit colours, decoded.
const std::array<float, 256>& decoded_bytes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < t.size(); ++i) t[i] = float(srgb_decode(double(i) / 255));
    return t;
  }();
  return table;
}

/// What is taken of a file, and how.
struct Selection {
  std::filesystem::path file;
  std::vector<int> channels;   // stored ones
  std::vector<bool> is_coded;  // in sRGB
  bool is_8bit = false;
  int first = 0, last = 0;  // the stored ones in between are read

  [[nodiscard]] float decoded(std::size_t c, float x) const {
    if (!is_coded[c]) return usable_texel(x);
    if (is_8bit) return decoded_bytes()[std::size_t(std::lround(x * 255)) & 255U];
    return usable_texel(float(srgb_decode(double(x))));
  }
};

Selection select(OIIO::ImageInput& in, const std::filesystem::path& file,
                 const std::vector<std::string>& channels, TexelCoding coding) {
  const OIIO::ImageSpec& spec = in.spec();
  const std::vector<std::string> names = names_of(in);
  const bool is_coded = coding == TexelCoding::kColour && !spec.format.is_floating_point() &&
                        !OIIO::Strutil::iequals(spec.get_string_attribute("oiio:ColorSpace"), "linear");
  Selection s{.file = file, .channels = {}, .is_coded = {}, .is_8bit = spec.format == OIIO::TypeUInt8};
  for (const std::string& channel : channels) {
    const auto it = std::find(names.begin(), names.end(), channel);
    if (it == names.end()) {
      throw InputError(file.string(), "", fmt::format("has no channel \"{}\"", channel));
    }
    s.channels.push_back(stored_channel(in, std::size_t(it - names.begin())));
    s.is_coded.push_back(is_coded && s.channels.back() != spec.alpha_channel);
  }
  const auto [first, last] = std::minmax_element(s.channels.begin(), s.channels.end());
  s.first = *first;
  s.last = *last + 1;
  return s;
}

class FileReader final : public TexelReader {
 public:
  FileReader(const Selection& selection, const std::vector<TexelLevel>& levels, const KeptLevels* kept)
      : selection_(selection), levels_(levels), kept_(kept), in_(open_texture(selection.file)) {
    const OIIO::ImageSpec& spec = in_->spec();
    if (spec.width != levels[0].width || spec.height != levels[0].height || spec.nchannels < selection.last) {
      throw InputError(selection.file.string(), "", "has changed since it was first read");
    }
  }

  std::vector<float> rows(std::size_t level, int y0, int y1) override {
    const auto row_size = std::size_t(levels_[level].width) * selection_.channels.size();
    if (kept_ != nullptr && level >= kept_->first()) return kept_->rows(level, y0, y1, row_size);
    return level == 0 ? stored_rows(y0, y1) : means(level, y0, y1);
  }

  std::vector<float> tile(std::size_t level, int x, int y) override {
    const TexelLevel& l = levels_[level];
    return stored_tiles(int(level), x, std::min(x + l.tile_width, l.width), y,
                        std::min(y + l.tile_height, l.height), l.tile_width, l.tile_height);
  }

  /// Of the finest level, strip by strip.
  std::vector<float> means(std::size_t level, int y0, int y1) {
    const TexelLevel &fine = levels_[0], &coarse = levels_[level];
    AreaMeans means({fine.width, fine.height}, {coarse.width, coarse.height}, y0, y1,
                    selection_.channels.size());
    for_each_strip(means.first_row(), means.last_row(),
                   [&](int row, const float* texels) { means.add(row, texels); });
    return means.means();
  }

  template <typename Visit>
  void for_each_strip(int y0, int y1, const Visit& visit) {
    const auto row_size = std::size_t(levels_[0].width) * selection_.channels.size();
    const int at_once = std::max(int(kStripTexels / row_size), 1);
    for (int y = y0; y < y1; y += at_once) {
      const int end = std::min(y + at_once, y1);
      const std::vector<float> strip = stored_rows(y, end);
      for (int row = y; row < end; ++row) visit(row, &strip[std::size_t(row - y) * row_size]);
    }
  }

 private:
  [[nodiscard]] InputError damaged() const {
    return {selection_.file.string(), "", fmt::format("damaged image: {}", in_->geterror())};
  }

  /// Picks and decodes: `texels` has the stored channels from first to last.
  std::vector<float> decoded(const std::vector<float>& texels) const {
    const auto stored = std::size_t(selection_.last - selection_.first);
    const std::size_t n = selection_.channels.size();
    std::vector<float> result(texels.size() / stored * n);
    for (std::size_t c = 0; c < n; ++c) {
      const float* from = &texels[std::size_t(selection_.channels[c] - selection_.first)];
      for (std::size_t i = c; i < result.size(); i += n, from += stored) {
        result[i] = selection_.decoded(c, *from);
      }
    }
    return result;
  }

  std::vector<float> stored_rows(int y0, int y1) {
    const OIIO::ImageSpec& spec = in_->spec();
    const int width = levels_[0].width;
    if (spec.tile_width > 0) {
      const int top = y0 / spec.tile_height * spec.tile_height;
      const int bottom =
          std::min((y1 + spec.tile_height - 1) / spec.tile_height * spec.tile_height, levels_[0].height);
      const std::vector<float> all = stored_tiles(0, 0, width, top, bottom, width, bottom - top);
      const auto row_size = std::ptrdiff_t(std::size_t(width) * selection_.channels.size());
      return {all.begin() + (y0 - top) * row_size, all.begin() + (y1 - top) * row_size};
    }
    std::vector<float> texels(std::size_t(y1 - y0) * std::size_t(width) *
                              std::size_t(selection_.last - selection_.first));
    if (!in_->read_scanlines(0, 0, spec.y + y0, spec.y + y1, spec.z, selection_.first, selection_.last,
                             OIIO::TypeFloat, texels.data())) {
      throw damaged();
    }
    return decoded(texels);
  }

  /// Texels [x0, x1) x [y0, y1), which begin and end at tiles' borders or the image's, in a picture of
  /// `width` x `height`.
  std::vector<float> stored_tiles(int level, int x0, int x1, int y0, int y1, int width, int height) {
    const OIIO::ImageSpec spec = in_->spec_dimensions(0, level);
    const int stored = selection_.last - selection_.first;
    std::vector<float> texels(std::size_t(width) * std::size_t(height) * std::size_t(stored));
    const auto x_stride = OIIO::stride_t(sizeof(float)) * stored;
    if (!in_->read_tiles(0, level, spec.x + x0, spec.x + x1, spec.y + y0, spec.y + y1, spec.z, spec.z + 1,
                         selection_.first, selection_.last, OIIO::TypeFloat, texels.data(), x_stride,
                         x_stride * width)) {
      throw damaged();
    }
    return decoded(texels);
  }

  const Selection& selection_;
  const std::vector<TexelLevel>& levels_;
  const KeptLevels* kept_;
  std::unique_ptr<OIIO::ImageInput> in_;
};

/// The levels of a file that has its own, in tiles; none where it does not.
std::vector<TexelLevel> own_levels(OIIO::ImageInput& in) {
  std::vector<TexelLevel> levels;
  for (int level = 0; in.seek_subimage(0, level); ++level) {
    const OIIO::ImageSpec& spec = in.spec();
    if (spec.tile_width < 1) return {};
    levels.push_back({spec.width, spec.height, spec.tile_width, spec.tile_height});
  }
  return levels.size() > 1 ? levels : std::vector<TexelLevel>{};
}

/// Of the memory for whole images, what one of them takes.
class Share {
 public:
  Share() = default;
  ~Share() { taken() -= bytes_; }
  Share(const Share&) = delete;
  Share& operator=(const Share&) = delete;
  /// False where there is not as much left.
  bool take(std::size_t bytes) {
    if ((taken() += bytes) > limit()) {
      taken() -= bytes;
      return false;
    }
    bytes_ += bytes;
    return true;
  }
  static std::atomic<std::size_t>& limit() {
    static std::atomic<std::size_t> bytes{(kTextureCacheMiB << 20) / 2};
    return bytes;
  }

 private:
  static std::atomic<std::size_t>& taken() {
    static std::atomic<std::size_t> bytes{0};
    return bytes;
  }
  std::size_t bytes_ = 0;
};

class FileSource final : public TexelSource {
 public:
  FileSource(const std::filesystem::path& file, const std::vector<std::string>& channels,
             TexelCoding coding) {
    channels_ = channels.size();
    {
      const auto in = open_texture(file);
      selection_ = select(*in, file, channels, coding);
      levels_ = halved_levels(in->spec().width, in->spec().height);
      if (std::vector<TexelLevel> own = own_levels(*in); !own.empty()) {
        levels_ = std::move(own);
        return;
      }
    }
    keep_coarse_levels();
  }

  [[nodiscard]] std::unique_ptr<TexelReader> open() const override {
    return std::make_unique<FileReader>(selection_, levels_, kept_ ? &*kept_ : nullptr);
  }

 private:
  void keep_coarse_levels() {
    const auto fits = [&](const TexelLevel& level) {
      return std::size_t(level.width) * std::size_t(level.height) * channels_ <= kKeptTexels;
    };
    const auto first = std::size_t(std::find_if(levels_.begin(), levels_.end(), fits) - levels_.begin());
    SPECTRACE_CHECK(first < levels_.size());
    FileReader reader(selection_, levels_, nullptr);
    using Levels = std::vector<std::vector<float>>;
    if (first > 0 && !share_.take(bytes_of_all())) {
      kept_.emplace(levels_, first, channels_, Levels{reader.means(first, 0, levels_[first].height)});
      return;
    }
    // The same numbers as made from the file: levels up to `first` are means of the finest.
    Levels finest{reader.rows(0, 0, levels_[0].height)};
    const auto row_size = std::size_t(levels_[0].width) * channels_;
    for (std::size_t i = 1; i <= first; ++i) {
      AreaMeans means({levels_[0].width, levels_[0].height}, {levels_[i].width, levels_[i].height}, 0,
                      levels_[i].height, channels_);
      for (int y = 0; y < levels_[0].height; ++y) means.add(y, &finest[0][std::size_t(y) * row_size]);
      finest.push_back(means.means());
    }
    kept_.emplace(levels_, 0, channels_, std::move(finest));
  }

  [[nodiscard]] std::size_t bytes_of_all() const {
    std::size_t texels = 0;
    for (const TexelLevel& level : levels_) texels += std::size_t(level.width) * std::size_t(level.height);
    return texels * channels_ * sizeof(float);
  }

  Selection selection_;
  Share share_;
  std::optional<KeptLevels> kept_;
};

}  // namespace

void set_kept_limit(std::size_t bytes) { Share::limit() = bytes; }

std::vector<std::string> texel_channels(const std::filesystem::path& file) {
  return names_of(*open_texture(file));
}

std::unique_ptr<TexelSource> texels_of_file(const std::filesystem::path& file,
                                            const std::vector<std::string>& channels, TexelCoding coding) {
  SPECTRACE_CHECK(!channels.empty());
  return std::make_unique<FileSource>(file, channels, coding);
}

}  // namespace spectrace
