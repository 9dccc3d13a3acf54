// SPDX-License-Identifier: Apache-2.0
// Random numbers by name: a function of (pixel, sample, seed) and of what they are for, never of what was
// drawn before, so an image has the same bits for any thread count, tile order and split of the sample range
// (ADR 0003).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/math/vec.h"
#include "core/spectra/sampled_spectrum.h"

namespace spectrace {

/// What a path draws once, each in [0, 1).
struct PathNumbers {
  /// The hero's; the lanes follow it by rotation. Stratified for heroes and for all lanes together.
  Float wavelength = 0;
  Vec2 pixel;
  Vec2 lens;
};

/// What a path draws at one vertex, each in [0, 1).
struct VertexNumbers {
  Float light_choice = 0;
  Vec2 light;  ///< a point on the light
  Float lobe = 0;
  Vec2 bsdf;  ///< a direction of the lobe
  Float roulette = 0;
};

/// How the samples of a pixel relate.
enum class SamplerKind : std::uint8_t {
  kOwenSobol,    ///< stratified, jointly: the error falls faster than with independent samples
  kIndependent,  ///< not at all: the squared error falls as 1/samples, whatever is integrated
};
/// In scenes, headers and on the command line.
constexpr std::string_view sampler_name(SamplerKind kind) {
  return kind == SamplerKind::kIndependent ? "independent" : "owen-sobol";
}

/// The numbers of one sample of one pixel. Over the samples of a pixel each number is an Owen-scrambled
/// Sobol' dimension: each aligned block of 2^k samples has one in every stratum of width 2^-k. The numbers of
/// the path and of its first two vertices are dimensions of one sequence, so that what depends on several of
/// them at once is stratified too; later vertices have a sequence each, in an order of its own. Different
/// pixels, seeds, and blocks of 2^32 samples are independent. Independent samples are scrambled each by
/// itself, which leaves nothing of the sequence.
class Sampler {
 public:
  /// `pixel` = y · width + x of the whole image, crop windows included.
  Sampler(std::uint64_t pixel, std::uint64_t sample, std::uint64_t seed,
          SamplerKind kind = SamplerKind::kOwenSobol);

  [[nodiscard]] PathNumbers path() const;
  /// `vertex` = 0 for the first surface hit.
  [[nodiscard]] VertexNumbers vertex(std::uint32_t vertex) const;

  /// Which of the pixel's samples, but for the blocks of 2^32.
  [[nodiscard]] std::uint32_t sample() const { return sample_; }
  /// One number in [0, 1) a lane, the same for all samples of the pixel that are not independent; the first
  /// is 0: what keeps the lanes of a spectral image apart (WavelengthDistribution::sample).
  [[nodiscard]] std::array<Float, kLanes> lane_shifts() const;

  /// Numbers come in blocks of as many as a register of 256 bits holds.
  static constexpr int kBlock = 8;

 private:
  std::uint64_t key_;  // of this pixel, seed and block of 2^32 samples, or sample
  std::uint32_t sample_;
};

}  // namespace spectrace
