// SPDX-License-Identifier: Apache-2.0
// The wavelengths a path carries, and how they are drawn from the scene's range.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "core/spectra/sampled_spectrum.h"

namespace spectrace {

/// A closed range of wavelengths [nm]; scene data, never a compile-time constant.
struct WavelengthRange {
  Float min_nm = 360;  // default: what the CIE 1931 observer sees
  Float max_nm = 830;

  [[nodiscard]] constexpr Float width_nm() const { return max_nm - min_nm; }
  friend constexpr bool operator==(WavelengthRange, WavelengthRange) = default;
};

/// kLanes wavelengths [nm] with the density [1/nm] each was drawn with (hero wavelengths: Wilkie et al.
/// 2014). Lane 0 is the hero.
class SampledWavelengths {
 public:
  SampledWavelengths() = default;
  SampledWavelengths(const std::array<Float, kLanes>& lambda_nm, const std::array<Float, kLanes>& pdf_per_nm)
      : lambda_nm_(lambda_nm), pdf_per_nm_(pdf_per_nm) {}

  [[nodiscard]] Float lambda_nm(int lane) const { return lambda_nm_[lane]; }
  /// f of each wavelength [nm].
  template <typename F>
  [[nodiscard]] SampledSpectrum map(const F& f) const {
    SampledSpectrum result;
    Float* const out = result.v.data();
    const Float* const nm = lambda_nm_.data();
    for (int i = 0; i < kLanes; ++i) out[i] = f(nm[i]);
    return result;
  }
  /// 0 for a terminated lane.
  [[nodiscard]] Float pdf_per_nm(int lane) const { return pdf_per_nm_[lane]; }
  [[nodiscard]] bool secondary_terminated() const { return kLanes > 1 && pdf_per_nm_[1] == 0; }
  /// At a dispersive event only the hero goes on; its density is divided by kLanes, because a hero is one
  /// of kLanes equally likely choices. Idempotent.
  void terminate_secondary();

 private:
  alignas(kLaneAlignment) std::array<Float, kLanes> lambda_nm_{};
  std::array<Float, kLanes> pdf_per_nm_{};
};

/// Density over a range from which the hero and, by rotation in the unit interval, the other lanes are
/// drawn: constant over each of its cells, which are equally likely. Immutable; shared by threads.
class WavelengthDistribution {
 public:
  /// Constant density: 1 / width.
  static WavelengthDistribution uniform(WavelengthRange range);
  /// Constant density over `count` cells, each of which is met at its centre only: for images that hold the
  /// spectrum at given wavelengths rather than means over bins.
  static WavelengthDistribution at_centers(WavelengthRange range, std::size_t count);
  /// What a pixel sees of each wavelength, the length of its linear sRGB vector, times what is there to be
  /// seen: a path's squared error is least where its density follows the colour it brings. `emission`: of all
  /// lights at a wavelength [nm], >= 0, any unit; empty: as much everywhere. A fifth of the density knows
  /// nothing of the lights, since one of them may be hidden, and 2 % of the mean is left to wavelengths
  /// nobody sees.
  static WavelengthDistribution visible(WavelengthRange range,
                                        const std::function<double(double)>& emission = {});

  /// The same with `lanes` different wavelengths, 1, 2, 4 ... kLanes, each carried by as many lanes: as
  /// unbiased, and as slow; what more of them are worth is seen by it.
  [[nodiscard]] WavelengthDistribution carrying(int lanes) const;

  /// `u` in [0, 1).
  [[nodiscard]] SampledWavelengths sample(Float u) const;
  /// The same with each lane moved on by its share `shifts` in [0, 1) of its kLanes-th of the range, round
  /// within it. At equal distances lanes share what is uneven in the `u` of a pixel, and a spectrum of many
  /// bins shows it kLanes times over; shifts that differ between pixels and lanes leave no such pattern.
  [[nodiscard]] SampledWavelengths sample(Float u, const std::array<Float, kLanes>& shifts) const;
  /// [1/nm]; 0 outside the range.
  [[nodiscard]] Float pdf_per_nm(Float lambda_nm) const;
  [[nodiscard]] WavelengthRange range() const { return range_; }

 private:
  /// `density` at equal steps over the range, linear between them, not all 0.
  WavelengthDistribution(WavelengthRange range, const std::vector<double>& density);

  /// Wavelengths of equal probability, and the density between two of them: what is drawn is linear in the
  /// number it is drawn by, so that a sample is two lookups and its density is exact.
  struct Cell {
    Float begin_nm = 0, width_nm = 0, pdf_per_nm = 0;
  };
  /// At places in [0, 1) of the cumulative density.
  [[nodiscard]] SampledWavelengths at(const std::array<Float, kLanes>& position) const;

  WavelengthDistribution(WavelengthRange range, std::vector<Cell> cells)
      : range_(range), cells_(std::move(cells)) {}

  /// The lane whose wavelength a lane carries.
  [[nodiscard]] int source_of(int lane) const { return lane * step_ % kLanes; }

  WavelengthRange range_;
  std::vector<Cell> cells_;
  int step_ = 1;                                       // lanes between two that differ
  std::array<Float, kLanes> rotation_ = rotations(1);  // of each lane, in the unit interval

  static constexpr std::array<Float, kLanes> rotations(int step) {
    std::array<Float, kLanes> result{};
    for (int lane = 0; lane < kLanes; ++lane)
      result[std::size_t(lane)] = Float(lane * step % kLanes) / kLanes;
    return result;
  }
};

}  // namespace spectrace
