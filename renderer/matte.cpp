// SPDX-License-Identifier: Apache-2.0
#include "renderer/matte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <iterator>
#include <map>
#include <tuple>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/murmur_hash.h"
#include "renderer/aovs.h"

namespace spectrace {

std::string_view matte_name(Matte matte) {
  return matte == Matte::kObject ? "crypto_object" : "crypto_material";
}

bool has_matte(const AovSet& aovs, Matte matte) {
  return matte == Matte::kObject ? aovs.crypto_object : aovs.crypto_material;
}

std::uint32_t matte_id(std::string_view name) {
  constexpr unsigned kMantissaBits = 23, kLargestExponent = 255;
  const std::uint32_t hash = murmur_hash3_32(name);
  const std::uint32_t exponent = hash >> kMantissaBits & kLargestExponent;
  return exponent == 0 || exponent == kLargestExponent ? hash ^ 1U << kMantissaBits : hash;
}

bool comes_before(const MatteCount& a, const MatteCount& b) {
  return std::tie(a.pixel, a.id) < std::tie(b.pixel, b.id);
}

MatteCounts sum_of(const MatteCounts& a, const MatteCounts& b) {
  MatteCounts sum;
  sum.reserve(std::max(a.size(), b.size()));
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(sum), comes_before);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (kept > 0 && !comes_before(sum[kept - 1], sum[i])) {
      sum[kept - 1].samples += sum[i].samples;
    } else {
      sum[kept++] = sum[i];
    }
  }
  sum.resize(kept);
  return sum;
}

void PixelMatte::add(std::uint32_t id) {
  for (MatteCount& count : counts_) {  // a handful
    if (count.id != id) continue;
    ++count.samples;
    return;
  }
  counts_.push_back({.pixel = 0, .id = id, .samples = 1});
}

void PixelMatte::move_to(std::uint32_t pixel, MatteCounts& counts) {
  for (MatteCount& count : counts_) count.pixel = pixel;
  std::sort(counts_.begin(), counts_.end(), comes_before);
  counts.insert(counts.end(), counts_.begin(), counts_.end());
  counts_.clear();
}

std::vector<std::string> matte_channels(Matte matte) {
  std::vector<std::string> channels;
  for (std::size_t layer = 0; layer < kMatteRanks / 2; ++layer) {
    for (const char channel : {'R', 'G', 'B', 'A'}) {
      channels.push_back(fmt::format("{}{:02}.{}", matte_name(matte), layer, channel));
    }
  }
  return channels;
}

void write_ranks(std::span<const MatteCount> counts, double samples, std::span<float> ranks) {
  SPECTRACE_CHECK(ranks.size() == 2 * kMatteRanks);
  std::vector<MatteCount> sorted(counts.begin(), counts.end());
  std::sort(sorted.begin(), sorted.end(), [](const MatteCount& a, const MatteCount& b) {
    return a.samples != b.samples ? a.samples > b.samples : a.id < b.id;
  });
  std::fill(ranks.begin(), ranks.end(), 0.0F);
  for (std::size_t i = 0; i < std::min(sorted.size(), kMatteRanks); ++i) {
    ranks[2 * i] = std::bit_cast<float>(sorted[i].id);
    ranks[2 * i + 1] = static_cast<float>(double(sorted[i].samples) / samples);
  }
}

void add_matte_metadata(const MatteNames& names, const AovSet& aovs, Metadata& metadata) {
  for (const Matte matte : kMattes) {
    if (!has_matte(aovs, matte)) continue;
    std::map<std::string, std::uint32_t> ids;
    for (const std::string& name : names.names[std::size_t(matte)]) ids.emplace(name, matte_id(name));
    JsonWriter manifest;
    manifest.begin_object();
    for (const auto& [name, id] : ids) manifest.member(name, fmt::format("{:08x}", id));
    manifest.end_object();
    // Seven digits of the layer's own hash keep several mattes of a file apart.
    const std::string layer(matte_name(matte));
    const std::string key =
        fmt::format("cryptomatte/{}/", fmt::format("{:08x}", murmur_hash3_32(layer)).substr(0, 7));
    metadata[key + "name"] = layer;
    metadata[key + "hash"] = std::string("MurmurHash3_32");
    metadata[key + "conversion"] = std::string("uint32_to_float32");
    std::string text = manifest.line();
    if (text.ends_with('\n')) text.pop_back();
    metadata[key + "manifest"] = std::move(text);
  }
}

}  // namespace spectrace
