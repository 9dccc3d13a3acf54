// SPDX-License-Identifier: Apache-2.0
#include "core/image/spectral_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/image/texture.h"
#include "tests/support/temporary_folder.h"

namespace spectrace::test {
namespace {

constexpr auto kT = SpectralKind::kReflectance;
constexpr auto kS0 = SpectralKind::kRadiance;

/// A pixel's value of channel c is its number plus c.
Image numbered(int width, int height, std::vector<std::string> channels) {
  Image image(width, height, std::move(channels));
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = float(i / image.channels.size()) + float(i % image.channels.size());
  }
  return image;
}

std::string problem_of(std::vector<std::string> channels, SpectralKind kind = kT) {
  try {
    (void)spectral_channels(numbered(1, 1, std::move(channels)), kind, "x.exr");
  } catch (const InputError& e) {
    return e.diagnostics()[0].problem;
  }
  return "";
}

TEST(SpectralImage, ChannelsAreOrderedByWavelengthWhateverTheirNames) {
  // By name 1000 nm would come first; 0.55 µm is 550 nm.
  const Image image =
      numbered(2, 1, {"B", "T.1000,000000nm", "T.0,55um", "T.400,5nm", "T.R", "S0.400,0nm", "S0.5e2nm"});
  const auto spectra = spectral_channels(image, kT, "x.exr");
  ASSERT_TRUE(spectra);
  EXPECT_EQ(spectra->lambda_nm(), (std::vector<Float>{400.5F, 550, 1000}));
  EXPECT_EQ(spectra->values(), (std::vector<float>{3, 2, 1, 4, 3, 2}));
  EXPECT_EQ(spectral_channels(image, kS0, "x.exr")->lambda_nm(), (std::vector<Float>{400, 500}));
  EXPECT_FALSE(spectral_channels(numbered(1, 1, {"R", "G", "B", "T.R"}), kT, "x.exr"));
  EXPECT_FALSE(has_spectral_channels(numbered(1, 1, {"R", "G", "B", "T.R", "S1.400,0nm"}), kT));
}

TEST(SpectralImage, IsLinearBetweenItsWavelengthsAndConstantOutside) {
  const auto spectra =
      spectral_channels(numbered(2, 1, {"T.400,0nm", "T.500,0nm", "T.700,0nm"}), kT, "x.exr");
  const TabulatedSpectrum table = spectra->spectrum(1);
  for (Float nm :
       {Float(100), Float(400), Float(425), Float(500), Float(501), Float(650), Float(700), Float(900)}) {
    EXPECT_NEAR(spectra->at(1, spectra->place(nm)), table.at(nm), 1e-6) << nm;
  }
  EXPECT_EQ(spectra->at(0, spectra->place(450)), Float(0.5));
}

TEST(SpectralImage, NamesAndWavelengthsAreChecked) {
  EXPECT_EQ(problem_of({"T.500.0nm", "T.600,0nm"}),
            "channel \"T.500.0nm\": expected a wavelength behind \"T.\", with a decimal comma and a unit: "
            "550,000000nm");
  EXPECT_NE(problem_of({"T.500,0", "T.600,0nm"}), "");
  EXPECT_NE(problem_of({"T.500,0THz", "T.600,0nm"}), "");
  EXPECT_NE(problem_of({"T.400,0nm.500,0nm", "T.600,0nm"}), "");  // fluorescence
  EXPECT_EQ(problem_of({"T.500,0m", "T.600,0nm"}),
            "channel \"T.500,0m\": 500000000000 nm is not in [100, 10000]");
  EXPECT_EQ(problem_of({"T.500,0nm", "T.0,5um"}),
            "channels \"T.500,0nm\" and \"T.0,5um\" are of one wavelength");
  EXPECT_EQ(problem_of({"S0.500,0nm", "R"}, kS0), "\"S0.500,0nm\" is its only wavelength: no spectrum");
  EXPECT_EQ(problem_of({"S0.5x", "T.400,0nm", "T.500,0nm"}, kT), "");  // the other kind is not looked at
}

TEST(SpectralImage, UnitsOfRadianceAreChecked) {
  EXPECT_EQ(check_emissive_units({{"emissiveUnits", "W.m^-2.sr^-1"}}, "x.exr"), std::nullopt);
  EXPECT_EQ(check_emissive_units({{"emissiveUnits", "W.m^-2.sr^-1.nm^-1"}}, "x.exr"), std::nullopt);
  EXPECT_EQ(check_emissive_units({}, "x.exr"),
            "x.exr: no attribute emissiveUnits; read as W.m^-2.sr^-1.nm^-1");
  EXPECT_THROW((void)check_emissive_units({{"emissiveUnits", "cd.m^-2"}}, "x.exr"), InputError);
  EXPECT_THROW((void)check_emissive_units({{"emissiveUnits", 1.0}}, "x.exr"), InputError);
}

TEST(SpectralTexture, ReadsItsFileAtThePathsWavelengths) {
  const TemporaryFolder folder;
  Image image(2, 2, {"R", "G", "B", "T.400,000000nm", "T.500,000000nm", "T.800,000000nm"});
  for (int i = 0; i < 4; ++i) {
    for (std::size_t c = 3; c < 6; ++c) image.at(i % 2, i / 2, c) = 0.1F * float(i) + 0.2F * float(c - 3);
  }
  image.at(0, 0, 3) = 7;  // more than all
  image.at(1, 0, 3) = std::numeric_limits<float>::quiet_NaN();
  write_exr(folder / "t.exr", image, {{"spectralLayoutVersion", "1.0"}});
  const Texture texture = image_texture(folder / "t.exr");
  EXPECT_TRUE(texture.is_textured());
  const SampledWavelengths lambda = WavelengthDistribution::uniform({}).sample(Float(0.3));
  const auto expect = [&](Vec2 uv, const TabulatedSpectrum& spectrum) {
    const SampledSpectrum sampled = texture.sample(lambda, uv);
    for (int i = 0; i < kLanes; ++i) EXPECT_NEAR(sampled[i], spectrum.at(lambda.lambda_nm(i)), 1e-6);
  };
  const std::vector<Float> nm{400, 500, 800};
  expect({Float(0.25), Float(0.25)}, {nm, {Float(0.2), Float(0.4), Float(0.6)}});  // v = 0 is the bottom row
  expect({Float(0.25), Float(0.75)}, {nm, {1, Float(0.2), Float(0.4)}});
  expect({Float(0.75), Float(0.75)}, {nm, {0, Float(0.3), Float(0.5)}});
  expect({Float(0.5), Float(0.25)}, {nm, {Float(0.25), Float(0.45), Float(0.65)}});
  expect({Float(0), Float(0.25)}, {nm, {Float(0.25), Float(0.45), Float(0.65)}});  // it repeats
}

TEST(SpectralTexture, RadianceIsNoReflectance) {
  const TemporaryFolder folder;
  const auto read = [&](const std::vector<std::string>& channels) {
    write_exr(folder / "x.exr", numbered(1, 1, channels), {});
    return image_texture(folder / "x.exr");
  };
  EXPECT_THROW(read({"S0.400,0nm", "S0.500,0nm"}), InputError);
  EXPECT_NO_THROW(read({"R", "G", "B", "S0.400,0nm", "S0.500,0nm"}));
  EXPECT_THROW(read({"Y"}), InputError);
}

}  // namespace
}  // namespace spectrace::test
