// SPDX-License-Identifier: Apache-2.0
// Which objects and materials a pixel shows, and how much of it each covers: Cryptomatte, by its public
// specification 1.2.0 (Psyop). Counts are integers: whatever the order they are added in, the result is the
// same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image.h"

namespace spectrace {

struct AovSet;

enum class Matte : std::uint8_t { kObject, kMaterial };
inline constexpr std::array kMattes{Matte::kObject, Matte::kMaterial};
inline constexpr std::size_t kMatteKinds = kMattes.size();

/// "crypto_object"
[[nodiscard]] std::string_view matte_name(Matte matte);
[[nodiscard]] bool has_matte(const AovSet& aovs, Matte matte);

/// How a name is written into pixels: its hash, one bit of which is turned where as a float it would be
/// denormal, infinite or no number.
[[nodiscard]] std::uint32_t matte_id(std::string_view name);

/// What the scene's objects and materials are called, and their ids.
struct MatteNames {
  std::array<std::vector<std::string>, kMatteKinds> names;  ///< by Matte; objects: the scene file's shapes
  std::vector<std::uint32_t> id_of_shape, id_of_instance;   ///< of Geometry
  std::vector<std::uint32_t> id_of_material;
};

/// Samples of a pixel that see one object, or one material.
struct MatteCount {
  std::uint32_t pixel = 0;  ///< of the film, row by row
  std::uint32_t id = 0;
  std::uint64_t samples = 0;

  friend constexpr bool operator==(const MatteCount&, const MatteCount&) = default;
};
/// In the order of pixels and ids, each pair once.
using MatteCounts = std::vector<MatteCount>;
[[nodiscard]] bool comes_before(const MatteCount& a, const MatteCount& b);
[[nodiscard]] MatteCounts sum_of(const MatteCounts& a, const MatteCounts& b);

/// The counts of one pixel on their way.
class PixelMatte {
 public:
  void add(std::uint32_t id);
  /// Appends what was counted, and begins anew.
  void move_to(std::uint32_t pixel, MatteCounts& counts);

 private:
  MatteCounts counts_;
};

using PixelMattes = std::array<PixelMatte, kMatteKinds>;

/// The largest so many are written: three layers of two pairs of id and coverage.
inline constexpr std::size_t kMatteRanks = 6;
/// crypto_object00.R, ...
[[nodiscard]] std::vector<std::string> matte_channels(Matte matte);
/// Ids and coverages of the counts of one pixel, of which `samples` count; 0 where there are fewer.
void write_ranks(std::span<const MatteCount> counts, double samples, std::span<float> ranks);

/// Name, hash, conversion and manifest of each matte that is asked for, as the specification wants them.
void add_matte_metadata(const MatteNames& names, const AovSet& aovs, Metadata& metadata);
[[nodiscard]] inline bool is_matte_metadata(std::string_view key) { return key.starts_with("cryptomatte/"); }

}  // namespace spectrace
