// SPDX-License-Identifier: Apache-2.0
// Images of spectra, in the layout of Fichet, Pacanowski and Wilkie 2021 ("An OpenEXR Layout for Spectral
// Images", JCGT 10(3)): one channel a wavelength, "T.550,000000nm" of reflectance, "S0.550,000000nm" of
// radiance.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/spectra/spectrum.h"

namespace spectrace {

enum class SpectralKind : std::uint8_t { kReflectance, kRadiance };

/// Where a wavelength lies between those of a table: linear between them, outside the end values hold.
struct SpectralPlace {
  std::size_t node = 0;  // this one and the next
  Float weight = 0;      // of the next
};
/// `lambda_nm`: strictly increasing, at least two.
[[nodiscard]] SpectralPlace spectral_place(std::span<const Float> lambda_nm, Float at_nm);

class SpectralImage {
 public:
  /// `values`: [height][width][wavelength]; `lambda_nm` strictly increasing, at least two: checked.
  SpectralImage(int width, int height, std::vector<Float> lambda_nm, std::vector<float> values);

  [[nodiscard]] SpectralPlace place(Float at_nm) const { return spectral_place(lambda_nm_, at_nm); }
  /// `texel`: row · width + column.
  [[nodiscard]] Float at(std::size_t texel, SpectralPlace place) const {
    const float* values = &values_[texel * lambda_nm_.size() + place.node];
    return Float(values[0]) + place.weight * (Float(values[1]) - Float(values[0]));
  }
  [[nodiscard]] TabulatedSpectrum spectrum(std::size_t texel) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const std::vector<Float>& lambda_nm() const { return lambda_nm_; }
  [[nodiscard]] const std::vector<float>& values() const { return values_; }

 private:
  int width_, height_;
  std::vector<Float> lambda_nm_;
  std::vector<float> values_;
};

[[nodiscard]] bool has_spectral_channels(std::span<const std::string> channels, SpectralKind kind);
[[nodiscard]] bool has_spectral_channels(const Image& image, SpectralKind kind);

struct SpectralChannel {
  double lambda_nm = 0;
  std::size_t index = 0;  ///< among all channels
  std::string name;
};
/// Those of one kind, by wavelength: none, or at least two. Throws InputError naming `file` and the channel
/// where a name or a wavelength is wrong.
[[nodiscard]] std::vector<SpectralChannel> find_spectral_channels(std::span<const std::string> channels,
                                                                  SpectralKind kind, const std::string& file);
/// "S0.550,000000nm".
[[nodiscard]] std::string spectral_channel_name(SpectralKind kind, double lambda_nm);
/// The same with their values; nothing where the image has none.
[[nodiscard]] std::optional<SpectralImage> spectral_channels(const Image& image, SpectralKind kind,
                                                             const std::string& file);

/// A remark where a file does not say in which unit its radiance is; throws InputError where it is none that
/// is read. Read is spectral radiance, "W.m^-2.sr^-1.nm^-1", also as "W.m^-2.sr^-1", which the layout
/// prescribes.
[[nodiscard]] std::optional<std::string> check_emissive_units(const Metadata& metadata,
                                                              const std::string& file);

}  // namespace spectrace
