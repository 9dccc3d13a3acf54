// SPDX-License-Identifier: Apache-2.0
// Colour and glass: what the wavelengths of a path must add up to.
#include <gtest/gtest.h>

#include <cmath>

#include "core/math/math.h"
#include "materials/fresnel.h"
#include "tests/support/render_scenes.h"

namespace spectrace::test {
namespace {

constexpr double kSigmas = 4;  // about 40 comparisons at alpha 0.01 (Šidák): 3.7

void expect_xyz(const Image& image, const Xyz& expected, const char* what) {
  for (int c = 0; c < 3; ++c) {
    const Estimate e = estimate_xyz(image, "", c);
    // 1e-3 of Y: the steps of the quadrature (1 nm) beside the statistical error.
    EXPECT_NEAR(e.mean, expected[c], kSigmas * e.standard_error + 1e-3 * expected[1]) << what << ", "
                                                                                      << "XYZ"[c];
  }
}

TEST(Spectral, EmittersShowTheColourOfTheirSpectrum) {
  // H7: one narrow peak; H13: a range wider than what is seen.
  const Spectrum peak = TabulatedSpectrum({360, 540, 545, 550, 830}, {0, 0, 100, 0, 0});
  const Spectrum slope = TabulatedSpectrum({360, 830}, {0, 2});
  for (const Spectrum& emission : {peak, slope, Spectrum(BlackbodySpectrum{3000, Float(1e-3)})}) {
    for (bool visible : {true, false}) {
      for (WavelengthRange range :
           {WavelengthRange{360, 830}, WavelengthRange{360, 1000}, WavelengthRange{500, 600}}) {
        SceneDesc scene = empty_scene();
        scene.visible_sampling = visible;
        scene.range = range;
        scene.lights = {EnvironmentDesc{.radiance = emission}};
        expect_xyz(render_scene(scene, 1024).image, spectrum_to_xyz(emission, range), "sky");
      }
    }
  }
}

TEST(Spectral, FewerLanesShowTheSameColourWithMoreNoise) {
  const Spectrum slope = TabulatedSpectrum({360, 830}, {0, 2});
  double noise = 0;
  for (const int lanes : {kLanes, 4, 2, 1}) {
    SceneDesc scene = empty_scene();
    scene.lanes = lanes;
    scene.sampler = SamplerKind::kIndependent;
    scene.lights = {EnvironmentDesc{.radiance = slope}};
    const Image image = render_scene(scene, 1024).image;
    expect_xyz(image, spectrum_to_xyz(slope, scene.range), "sky");
    const double found = estimate_xyz(image, "", 0).standard_error;
    EXPECT_GT(found, noise) << lanes << " lanes";
    noise = found;
  }
}

TEST(Spectral, ReflectancesMultiplyEmissions) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("slope", TabulatedSpectrum({360, 830}, {0, 1}))};
  scene.shapes = {sphere({0, 0, 0}, 1, "slope")};
  scene.camera.fov_deg = 5;
  scene.lights = {EnvironmentDesc{.radiance = TabulatedSpectrum({360, 830}, {2, 0})}};
  std::vector<Float> lambda, product;
  for (int nm = 360; nm <= 830; ++nm) {
    const Float t = Float(nm - 360) / 470;
    lambda.push_back(Float(nm));
    product.push_back(2 * t * (1 - t));
  }
  expect_xyz(render_scene(scene, 2048).image, spectrum_to_xyz(TabulatedSpectrum(lambda, product)), "slope");
}

/// Looking down at 45 degrees through the surface of glass that fills z < 0.
SceneDesc pool(const Spectrum& eta) {
  SceneDesc scene = empty_scene();
  scene.materials = {{.name = "glass", .where = "", .kind = Dielectric{eta}}, lambert("black", 0)};
  // Small coordinates: the offset of refracted rays, a share of them, shifts where they land.
  scene.shapes = {quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, "glass")};
  look_at_point(scene, {-2, 0, 2}, {0, 0, 0});
  return scene;
}

/// Where on the pool's floor at depth 1 that look ends: Snell's law.
double landing(double eta) {
  const double sin_t = std::sin(0.25 * kPi64) / eta;
  return sin_t / std::sqrt(1 - sin_t * sin_t);
}

double transmitted(double eta) {
  return (1 - fresnel_dielectric(Float(std::sqrt(0.5)), Float(eta))) / (eta * eta);
}

TEST(Spectral, RefractionFollowsSnell) {
  const double x = landing(1.5);
  for (double shift : {0.0, 0.003, -0.003}) {
    SceneDesc scene = pool(Spectrum::constant(Float(1.5)));
    // Half a landing width of 2e-3 around x + shift: hit only where shift is 0.
    scene.shapes.push_back(
        emitting(quad({Float(x + shift - 1e-3), -1, -1}, {Float(2e-3), 0, 0}, {0, 2, 0}, "black"), 1));
    const Image image = render_scene(scene, 1024).image;
    const Estimate y = estimate_y(image, "specular");
    EXPECT_NEAR(y.mean, shift == 0 ? transmitted(1.5) : 0, kSigmas * y.standard_error + 1e-6)
        << "shift " << shift;
    EXPECT_EQ(estimate_y(image, "emission").mean, 0);
  }
}

// BK7 (Schott's data sheet), as any flint would do.
const SellmeierSpectrum kBk7{.b = {Float(1.03961212), Float(0.231792344), Float(1.01046945)},
                             .c_um2 = {Float(0.00600069867), Float(0.0200179144), Float(103.560653)}};

TEST(Spectral, DispersionKeepsTheSpectrumOfWhatIsSeenThroughGlass) {
  SceneDesc scene = pool(kBk7);
  scene.shapes.push_back(emitting(quad({-10, -10, -1}, {20, 0, 0}, {0, 20, 0}, "black"), 1));
  std::vector<Float> lambda, seen;
  for (int nm = 360; nm <= 830; ++nm) {
    lambda.push_back(Float(nm));
    seen.push_back(Float(transmitted(kBk7.at(Float(nm)))));
  }
  // H12: the hero alone goes on, and no bin is favoured.
  expect_xyz(render_scene(scene, 8192).image, spectrum_to_xyz(TabulatedSpectrum(lambda, seen)),
             "through BK7");
}

TEST(Spectral, AStripOfAPrismShowsItsBandOfWavelengths) {
  SceneDesc scene = pool(kBk7);
  const double from = landing(kBk7.at(520)), to = landing(kBk7.at(600));  // longer waves land further out
  ASSERT_LT(from, to);
  scene.shapes.push_back(
      emitting(quad({Float(from), -1, -1}, {Float(to - from), 0, 0}, {0, 2, 0}, "black"), 1));
  std::vector<Float> lambda, seen;
  for (int nm = 520; nm <= 600; ++nm) {
    lambda.push_back(Float(nm));
    seen.push_back(Float(transmitted(kBk7.at(Float(nm)))));
  }
  const Spectrum band = TabulatedSpectrum(lambda, seen);
  const Image image = render_scene(scene, 8192).image;
  const Xyz expected = spectrum_to_xyz(band, {520, 600});
  for (int c = 0; c < 3; ++c) {
    const Estimate e = estimate_xyz(image, "", c);
    // 2 %: offset and rounding shift the band of 1.7e-3 by up to 2e-6, the view of 1e-3 degrees smears it by
    // 4e-5.
    EXPECT_NEAR(e.mean, expected[c], kSigmas * e.standard_error + 0.02 * expected[1]) << "XYZ"[c];
  }
}

/// A grey floor under a lossless glass ball, seen beside the ball.
SceneDesc ball_on_floor(const Spectrum& eta, Float albedo) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("floor", albedo), {.name = "glass", .where = "", .kind = Dielectric{eta}}};
  scene.shapes = {quad({-10, -10, 0}, {20, 0, 0}, {0, 20, 0}, "floor"), sphere({0, 0, 2}, 1, "glass")};
  look_at_point(scene, {4, 0, 1}, {0, 0, 0});
  return scene;
}

TEST(Spectral, DispersingGlassKeepsTheFurnace) {
  // Glass absorbs nothing: with a white floor and the same sky all around, radiance is 1 everywhere.
  SceneDesc scene = ball_on_floor(kBk7, 1);
  scene.lights = {sky(1)};
  scene.integrator = {.max_depth = 200, .roulette_depth = 200};
  const Estimate y = estimate_y(render_scene(scene, 256).image);
  EXPECT_NEAR(y.mean, 1, kSigmas * y.standard_error + 1e-4);
}

TEST(Spectral, NoGlassColoursTheFurnace) {
  // Looking into the ball itself, under a white sky: whatever disperses or interferes, no colour is left
  // over.
  const ThinFilm film{.eta = Spectrum::constant(Float(2.2)), .thickness_nm = 300};
  const std::vector<std::pair<std::string, decltype(MaterialDesc::kind)>> balls{
      {"smooth", Dielectric{kBk7}},
      {"under a film", Dielectric{kBk7, film}},
      {"rough", RoughDielectric(kBk7, {kMinAlpha, kMinAlpha})},
      {"rough, under a film", RoughDielectric(kBk7, {kMinAlpha, kMinAlpha}, film)}};
  const Xyz white = spectrum_to_xyz(Spectrum::constant(1));
  for (const auto& [name, kind] : balls) {
    SceneDesc scene = empty_scene();
    scene.materials = {{.name = "ball", .where = "", .kind = kind}};
    scene.shapes = {sphere({0, 0, 0}, 1, "ball")};
    scene.lights = {sky(1)};
    scene.camera.fov_deg = 12;
    scene.integrator = {.max_depth = 200, .roulette_depth = 200};
    const Image image = render_scene(scene, 4096).image;
    for (int c = 0; c < 3; ++c) {
      const Estimate e = estimate_xyz(image, "", c);
      // 1e-3: what facets of the least roughness lose, at some incidences up to their own slope.
      EXPECT_NEAR(e.mean / white[c], 1, kSigmas * e.standard_error / white[c] + 1e-3) << name << " "
                                                                                      << "XYZ"[c];
      EXPECT_LT(kSigmas * e.standard_error / white[c], 0.02) << name;
    }
  }
}

TEST(Spectral, LightGatheredBeforeDispersionKeepsAllItsWavelengths) {
  // With two segments nothing that shines lies behind the glass: whether it disperses must not change a bit
  // of what the floor has sent before (hard case H12: terminated wavelengths were lit until then).
  const auto render_with = [](const Spectrum& eta) {
    SceneDesc scene = ball_on_floor(eta, Float(0.5));
    scene.lights = {PointLightDesc{{3, 0, 3}, Spectrum::constant(10)}};
    scene.integrator.max_depth = 2;
    return render_scene(scene, 64).image;
  };
  const Image dispersing = render_with(kBk7), plain = render_with(Spectrum::constant(Float(1.5)));
  EXPECT_GT(estimate_y(plain).mean, 0);
  EXPECT_EQ(dispersing.data, plain.data);
}

}  // namespace
}  // namespace spectrace::test
