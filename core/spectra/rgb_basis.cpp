// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/math/math.h"
#include "core/spectra/rgb_uplift.h"

namespace spectrace {
namespace {

constexpr Float kFirstNm = 360, kStepNm = 5;
constexpr std::size_t kNodes = 95;

// Printed by core/spectra/tools/derive_rgb_basis.cpp, which says how they are derived: the smoothest (by
// second differences) non-negative spectra that sum to 1 and have the colours of the sRGB primaries under
// D65.
// clang-format off
constexpr std::array<Float, kNodes> kRed{
    0.355399198, 0.333556347, 0.311713557, 0.289871084, 0.268029535, 0.246190147, 0.22435526, 0.202529165,
    0.180720055, 0.158944867, 0.137238829, 0.115669779, 0.0943668824, 0.0735680046, 0.053690098, 0.0354002756,
    0.0196506694, 0.00767583321, 0.000921146085, 0, 0.000240479385, 0.000268322643, 4.42166983e-05, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.0101561327, 0.0459640718, 0.113509645, 0.211412374, 0.332794395,
    0.467304927, 0.603137096, 0.728833413, 0.834848449, 0.914825457, 0.966541106, 0.992473107, 1, 1, 1, 1, 1, 1, 1,
    1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
};
constexpr std::array<Float, kNodes> kGreen{
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.00177731764, 0.0173217613, 0.0529831403, 0.110762423,
    0.189270697, 0.28497701, 0.392618885, 0.505935201, 0.618337757, 0.723461712, 0.815667789, 0.890541239,
    0.945410699, 0.979868286, 0.996246343, 1, 1, 1, 1, 1, 0.999209988, 0.991184008, 0.967183573, 0.918197488,
    0.841886078, 0.741151299, 0.622686962, 0.495490889, 0.369391211, 0.253730121, 0.15622097, 0.0820173617,
    0.033030459, 0.00752689338, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
};
constexpr std::array<Float, kNodes> kBlue{
    0.644600802, 0.666443653, 0.688286443, 0.710128916, 0.731970465, 0.753809853, 0.77564474, 0.797470835,
    0.819279945, 0.841055133, 0.862761171, 0.884330221, 0.905633118, 0.926431995, 0.946309902, 0.964599724,
    0.980349331, 0.992324167, 0.999078854, 0.998222682, 0.982437759, 0.946748537, 0.889193361, 0.810729303,
    0.71502299, 0.607381115, 0.494064799, 0.381662243, 0.276538288, 0.184332211, 0.109458761, 0.0545893007,
    0.0201317138, 0.00375365653, 0, 0, 0, 0, 0, 0.000790012186, 0.00881599162, 0.0226602944, 0.0358384404,
    0.0446042768, 0.0474363274, 0.0445186428, 0.0372041844, 0.0274716929, 0.017436466, 0.00893058089, 0.00315718131,
    0.000428435203, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
};
// clang-format on

/// A cell between two nodes, and how far into it.
struct Place {
  std::int32_t cell = 0;
  Float fraction = 0;
};

Place place(Float lambda_nm) {
  constexpr Float kPerStep = 1 / kStepNm, kLast = kNodes - 1, kLastCell = kNodes - 2;
  const Float position = std::min(std::max((lambda_nm - kFirstNm) * kPerStep, Float(0)), kLast);
  const auto cell = static_cast<std::int32_t>(std::min(position, kLastCell));
  return {cell, position - Float(cell)};
}

Float interpolate(const std::array<Float, kNodes>& table, Place at) {
  const Float* const node = &table[static_cast<std::size_t>(at.cell)];
  return lerp(node[0], node[1], at.fraction);
}

}  // namespace

std::array<Float, 3> rgb_basis(Float lambda_nm) {
  const Place at = place(lambda_nm);
  return {interpolate(kRed, at), interpolate(kGreen, at), interpolate(kBlue, at)};
}

std::array<SampledSpectrum, 3> rgb_basis(const SampledWavelengths& lambda) {
  std::array<Place, kLanes> at;
  for (int lane = 0; lane < kLanes; ++lane) at[lane] = place(lambda.lambda_nm(lane));
  std::array<SampledSpectrum, 3> out;
  for (int lane = 0; lane < kLanes; ++lane) out[0][lane] = interpolate(kRed, at[lane]);
  for (int lane = 0; lane < kLanes; ++lane) out[1][lane] = interpolate(kGreen, at[lane]);
  for (int lane = 0; lane < kLanes; ++lane) out[2][lane] = interpolate(kBlue, at[lane]);
  return out;
}

}  // namespace spectrace
