// SPDX-License-Identifier: Apache-2.0
#include "core/math/sampler.h"

#include "core/spectra/sampled_spectrum.h"

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

/// The second Sobol' dimension of index n, first binary digit in bit 0: digit i is the sum of C(j, i) n_j mod
/// 2, and C(j, i) is odd where the bits of i are among those of j (Lucas).
constexpr std::uint32_t sobol_second_digits(std::uint32_t n) {
  n ^= (n & 0xaaaaaaaa) >> 1;
  n ^= (n & 0xcccccccc) >> 2;
  n ^= (n & 0xf0f0f0f0) >> 4;
  n ^= (n & 0xff00ff00) >> 8;
  return n ^ (n >> 16);
}

/// Counter `n` under `key`; the second mix parts keys that differ by a multiple of kGolden.
constexpr std::uint64_t hash(std::uint64_t key, std::uint64_t n) { return mix(key ^ mix((n + 1) * kGolden)); }

/// The base-2 radical inverse of n, in units of 2^-64: the first Sobol' dimension.
constexpr std::uint64_t radical_inverse(std::uint64_t n) {
  std::uint64_t r = 0;
  for (std::uint64_t digit = std::uint64_t(1) << 63; n != 0; n >>= 1, digit >>= 1) {
    if (n & 1) r |= digit;
  }
  return r;
}

/// The second Sobol' dimension, whose direction numbers are the rows of Pascal's triangle mod 2; with the
/// first it forms a (0,2)-sequence in base 2 (Sobol' 1967; Kollig & Keller 2002).
constexpr std::uint64_t sobol_second(std::uint64_t n) {
  std::uint64_t r = 0;
  for (std::uint64_t direction = std::uint64_t(1) << 63; n != 0; n >>= 1, direction ^= direction >> 1) {
    if (n & 1) r ^= direction;
  }
  return r;
}

/// Stratifies the hero wavelength over the samples n of a pixel. The lanes of a path lie at u + i/kLanes, so
/// the radical inverse alone would give kLanes paths in a row the same set of wavelengths. Here it spreads
/// the sets (u mod 1/kLanes), and the second dimension says which of a set is the hero: of kLanes^2 paths
/// each kLanes^-2-wide stratum of u gets exactly one, and so on for higher powers.
constexpr std::uint64_t wavelength_stratum(std::uint64_t n) {
  static_assert((kLanes & (kLanes - 1)) == 0, "base-2 strata need a power of two of lanes");
  constexpr auto kHeroWidth = std::uint64_t(-1) / kLanes;  // all bits below the ones that choose the hero
  return (sobol_second(n) & ~kHeroWidth) | (radical_inverse(n) / kLanes);
}

// An additive recurrence of low discrepancy in two dimensions: steps 1/g and 1/g^2 with g^3 = g + 1, in units
// of 2^-64: M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018 ("R2").
constexpr std::uint64_t kR2StepX = 0xc13fa9a902a6328f;  // 0.7548776662466927...
constexpr std::uint64_t kR2StepY = 0x91e10da5c79e7b1d;  // 0.5698402909980532...

/// The top bits that a Float holds exactly: never rounds up to 1.
constexpr Float to_unit(std::uint64_t bits) {
  if constexpr (sizeof(Float) == 4) return Float(bits >> 40) * Float(0x1p-24);
  return Float(bits >> 11) * Float(0x1p-53);
}

}  // namespace

Sampler::Sampler(std::uint64_t pixel, std::uint64_t sample, std::uint64_t seed)
    : pixel_key_(hash(mix(seed + kGolden), pixel)),
      sample_(sample),
      block_key_(hash(pixel_key_, sample >> 32)),
      reversed_sample_(reversed(static_cast<std::uint32_t>(sample))) {}

/// Rotates a sequence on the unit circle, for each pixel by an amount of its own. `~` keys it
/// apart from the samples of that pixel.
std::uint64_t Sampler::pixel_offset(std::uint32_t dimension) const { return hash(~pixel_key_, dimension); }

/// Two scramblings of one dimension: of the samples' order, so that dimensions do not march in step, and of
/// the digits.
Sampler::Keys Sampler::keys(std::uint32_t dimension) const {
  const std::uint64_t key = hash(block_key_, dimension);
  return {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)};
}

/// The place of this sample in the dimension's own order: a permutation that keeps every aligned block of 2^k
/// samples together.
std::uint32_t Sampler::shuffled_index(std::uint32_t order_key) const {
  return reversed(scrambled(reversed_sample_, order_key));
}

std::uint64_t Sampler::bits(std::uint32_t dimension) const {
  constexpr auto kWavelength = static_cast<std::uint32_t>(PathDimension::kWavelength);
  constexpr auto kPixel = static_cast<std::uint32_t>(PathDimension::kPixel);
  switch (dimension) {  // sums of fixed-point fractions: overflow is the "mod 1"
    case kWavelength:
      return pixel_offset(dimension) + wavelength_stratum(sample_);
    case kPixel:
      return pixel_offset(dimension) + sample_ * kR2StepX;
    case kPixel + 1:
      return pixel_offset(dimension) + sample_ * kR2StepY;
    default: {
      const Keys of = keys(dimension);
      return std::uint64_t(reversed(scrambled(shuffled_index(of.order), of.digits))) << 32;
    }
  }
}

Vec2 Sampler::pair(std::uint32_t dimension) const {
  if (dimension == static_cast<std::uint32_t>(PathDimension::kPixel)) {
    return {number(dimension), number(dimension + 1)};
  }
  const Keys first = keys(dimension), second = keys(dimension + 1);
  const std::uint32_t index = shuffled_index(first.order);
  return {to_unit(std::uint64_t(reversed(scrambled(index, first.digits))) << 32),
          to_unit(std::uint64_t(reversed(scrambled(sobol_second_digits(index), second.digits))) << 32)};
}

Float Sampler::number(std::uint32_t dimension) const { return to_unit(bits(dimension)); }

}  // namespace spectrace
