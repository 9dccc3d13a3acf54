// SPDX-License-Identifier: Apache-2.0
#include "core/math/sampler.h"

#include <bit>
#include <cstddef>

#include "core/base/wide.h"
#include "core/math/sobol.h"

namespace spectrace {
namespace {

// 2^64 / golden ratio, odd: consecutive multiples lie far apart (Knuth, TAOCP 3, sec. 6.4), so that counters
// enter the mixer with many bits changed.
constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15;

/// A bijection in which every input bit flips every output bit with probability near 1/2: xor-shift and
/// multiply, three rounds, with the constants Stafford searched for ("Better Bit Mixing", 2011, variant 13).
constexpr std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// Counter `n` under `key`; the second mix parts keys that differ by a multiple of kGolden.
constexpr std::uint64_t hash(std::uint64_t key, std::uint64_t n) { return mix(key ^ mix((n + 1) * kGolden)); }

/// The same of 32 bits, as a register holds eight of: constants by C. Wellons ("Prospecting for Hash
/// Functions", 2018, lowbias32).
constexpr std::uint32_t mix32(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352d;
  x = (x ^ (x >> 15)) * 0x846ca68b;
  return x ^ (x >> 16);
}

/// The bits of a word in reverse order.
constexpr std::uint32_t reversed(std::uint32_t x) {
  x = (x & 0x55555555) << 1 | ((x >> 1) & 0x55555555);
  x = (x & 0x33333333) << 2 | ((x >> 2) & 0x33333333);
  x = (x & 0x0f0f0f0f) << 4 | ((x >> 4) & 0x0f0f0f0f);
  x = (x & 0x00ff00ff) << 8 | ((x >> 8) & 0x00ff00ff);
  return x << 16 | x >> 16;
}

/// Owen's nested uniform scramble, of a fraction whose first binary digit is bit 0: whether a digit flips is
/// a hash of those before it. Only operations that carry upwards: Laine & Karras 2011, with the constants of
/// N. Vegdahl, "Building a Better LK Hash", 2021 (as used by B. Burley, "Practical Hash-based Owen
/// Scrambling", JCGT 9(4), 2020).
constexpr std::uint32_t scrambled(std::uint32_t x, std::uint32_t key) {
  x ^= x * 0x3d20adea;
  x += key;
  x *= (key >> 16) | 1;
  x ^= x * 0x05526c56;
  x ^= x * 0x53a22864;
  return x;
}

/// The top bits that a float holds exactly: never rounds up to 1. The same numbers in double precision, so that
/// images of both builds differ by rounding alone.
constexpr Float to_unit(std::uint32_t bits) { return Float(std::int32_t(bits >> 8)) * Float(0x1p-24); }

constexpr std::size_t kBlock = Sampler::kBlock;
using Words = std::array<std::uint32_t, kBlock>;

// The places of numbers in their block.
enum PathPlace { kWavelength, kHero, kPixelX, kPixelY, kLensX, kLensY };
enum VertexPlace { kLightChoice, kLightX, kLightY, kLobe, kBsdfX, kBsdfY, kRoulette };

/// Blocks of the joint sequence: the path's, and those of its first vertices.
constexpr std::uint32_t kJointBlocks = 3;
/// The Sobol' dimension of each number. Dimensions are not equally even together: an annealing over
/// assignments has found the one whose counts in boxes of two and three numbers, over 16 to 1024 samples,
/// vary least where numbers meet (a light's choice and point; a direction and the light found from there;
/// ...): 30 % less than in two orders chosen by hand. Those without a name stand for none.
constexpr std::array<std::array<int, kBlock>, kJointBlocks> kJointDimensions{
    {{12, 10, 0, 1, 17, 14, 0, 0}, {4, 9, 11, 13, 2, 3, 18, 0}, {6, 7, 5, 15, 8, 16, 19, 0}}};
/// Of a vertex with a sequence to itself.
constexpr std::array<int, kBlock> kOwnDimensions{4, 2, 3, 5, 0, 1, 6, 7};

/// By bit of the index, for all numbers of a block.
using BlockColumns = std::array<Words, kSobolBits>;

constexpr BlockColumns block_columns(const std::array<int, kBlock>& dimensions) {
  BlockColumns block{};
  for (std::size_t i = 0; i < kBlock; ++i) {
    const SobolColumns columns = sobol_columns(dimensions[i]);
    for (std::size_t bit = 0; bit < columns.size(); ++bit) block[bit][i] = columns[bit];
  }
  return block;
}

constexpr std::array<BlockColumns, kJointBlocks> kJointColumns{block_columns(kJointDimensions[0]),
                                                               block_columns(kJointDimensions[1]),
                                                               block_columns(kJointDimensions[2])};
constexpr BlockColumns kOwnColumns = block_columns(kOwnDimensions);

/// The numbers of a block as 32-bit fractions. A scrambling each; loops over the block are one operation of a
/// wide register.
SPECTRACE_WIDE Words block_at(const BlockColumns& columns, std::uint32_t index, std::uint64_t key) {
  Words x{};
  for (; index != 0; index &= index - 1) {
    const Words& column = columns[std::size_t(std::countr_zero(index))];
    for (std::size_t i = 0; i < kBlock; ++i) x[i] ^= column[i];
  }
  for (std::size_t i = 0; i < kBlock; ++i) {
    const std::uint32_t counter = std::uint32_t(key) + std::uint32_t(i) * std::uint32_t(kGolden >> 32);
    const std::uint32_t own_key = mix32(mix32(counter) ^ std::uint32_t(key >> 32));
    x[i] = reversed(scrambled(x[i], own_key));
  }
  return x;
}

/// Stratified for heroes and lanes. The lanes of a path lie at u + i/kLanes: one number spreads the sets of
/// lanes (u mod 1/kLanes), another says which of a set is the hero.
std::uint32_t wavelength_bits(std::uint32_t set, std::uint32_t hero) {
  static_assert(std::has_single_bit(unsigned(kLanes)), "strata of base 2 need a power of two of lanes");
  constexpr std::uint32_t kSetBits = ~std::uint32_t(0) / kLanes;  // all below those that choose the hero
  return (hero & ~kSetBits) | (set / kLanes);
}

}  // namespace

Sampler::Sampler(std::uint64_t pixel, std::uint64_t sample, std::uint64_t seed, SamplerKind kind)
    : key_(hash(hash(mix(seed + kGolden), pixel), kind == SamplerKind::kIndependent ? sample : sample >> 32)),
      sample_(std::uint32_t(sample)) {}

PathNumbers Sampler::path() const {
  const Words x = block_at(kJointColumns[0], sample_, hash(key_, 0));
  return {.wavelength = to_unit(wavelength_bits(x[kWavelength], x[kHero])),
          .pixel = {to_unit(x[kPixelX]), to_unit(x[kPixelY])},
          .lens = {to_unit(x[kLensX]), to_unit(x[kLensY])}};
}

std::array<Float, kLanes> Sampler::lane_shifts() const {
  std::array<Float, kLanes> shifts{};
  for (std::size_t lane = 1; lane < kLanes; ++lane) {
    shifts[lane] = to_unit(std::uint32_t(hash(~key_, lane) >> 32));
  }
  return shifts;
}

VertexNumbers Sampler::vertex(std::uint32_t vertex) const {
  const std::uint32_t block = vertex + 1;
  const std::uint64_t key = hash(key_, block);
  Words x{};
  if (block < kJointBlocks) {
    x = block_at(kJointColumns[block], sample_, key);
  } else {
    // An order of its own: scrambling the index keeps every aligned block of 2^k samples together.
    const std::uint32_t index = reversed(scrambled(reversed(sample_), std::uint32_t(mix(key))));
    x = block_at(kOwnColumns, index, key);
  }
  return {.light_choice = to_unit(x[kLightChoice]),
          .light = {to_unit(x[kLightX]), to_unit(x[kLightY])},
          .lobe = to_unit(x[kLobe]),
          .bsdf = {to_unit(x[kBsdfX]), to_unit(x[kBsdfY])},
          .roulette = to_unit(x[kRoulette])};
}

}  // namespace spectrace
