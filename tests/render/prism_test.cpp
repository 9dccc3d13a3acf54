// SPDX-License-Identifier: Apache-2.0
// A prism of BK7 puts each bin of wavelengths where Snell's law and the Sellmeier equation do, to 0.1 degree.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/render_scenes.h"

namespace spectrace::test {
namespace {

const SellmeierSpectrum kBk7{.b = {Float(1.03961212), Float(0.231792344), Float(1.01046945)},
                             .c_um2 = {Float(0.00600069867), Float(0.0200179144), Float(103.560653)}};

/// In the plane of refraction, in double: what the renderer is held against shares no code with it.
struct Plane {
  double x = 0, z = 0;
  friend Plane operator+(Plane a, Plane b) { return {a.x + b.x, a.z + b.z}; }
  friend Plane operator-(Plane a, Plane b) { return {a.x - b.x, a.z - b.z}; }
  friend Plane operator*(Plane a, double s) { return {a.x * s, a.z * s}; }
};
double dot(Plane a, Plane b) { return a.x * b.x + a.z * b.z; }
Vec3 in_space(Plane p, double y) { return {Float(p.x), Float(y), Float(p.z)}; }

/// SCHOTT's three-term equation, λ in µm.
double index_of_bk7(double nm) {
  const double l2 = nm * nm * 1e-6;
  return std::sqrt(1 + 1.03961212 * l2 / (l2 - 0.00600069867) + 0.231792344 * l2 / (l2 - 0.0200179144) +
                   1.01046945 * l2 / (l2 - 103.560653));
}

/// Way of a ray and what of it passes, unpolarised.
struct Passed {
  Plane direction;
  double share = 1;
};
/// At a face with normal `n` against unit `d`; `eta`: index behind it / index before it.
Passed refract(Plane d, Plane n, double eta) {
  const double cos_i = -dot(d, n), cos_t = std::sqrt(1 - (1 - cos_i * cos_i) / (eta * eta));
  const double s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t),
               p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  return {d * (1 / eta) + n * (cos_i / eta - cos_t), 1 - (s * s + p * p) / 2};
}

// Faces rise at 60 degrees from (-c, 0) and (c, 0) to the edge at (0, 1): an equilateral prism.
const double kHalfBase = std::tan(kPi64 / 6);
const Plane kEntry{-kHalfBase / 2, 0.5};  // where the view enters: the middle of the left face
const Plane kLeft{-std::cos(kPi64 / 6), 0.5}, kRight{std::cos(kPi64 / 6), 0.5};  // outward normals
const Plane kView{std::cos(0.35), std::sin(0.35)};  // 20 degrees upwards: 50 degrees to the left face

struct Exit {
  Plane position, direction;
  double share = 0;
};
Exit through_prism(double nm) {
  const double eta = index_of_bk7(nm);
  const Passed inside = refract(kView, kLeft, eta);
  const Plane edge{0, 1};
  const Plane out = kEntry + inside.direction * (dot(edge - kEntry, kRight) / dot(inside.direction, kRight));
  const Passed outside = refract(inside.direction, kRight * -1, 1 / eta);
  return {out, outside.direction, inside.share * outside.share};
}

constexpr double kHalfBin = 2.5;        // nm: BK7 spreads it over 0.02 degrees at most
constexpr double kTolerance_deg = 0.1;  // what is promised

/// The prism before a strip that shines in one bin of wavelengths, 2 · 0.1 degrees wide and `offset_deg` away
/// from where the bin's middle leaves to.
SceneDesc strip_behind_prism(double nm, double offset_deg) {
  SceneDesc scene = empty_scene();
  scene.materials = {lambert("black", 0), {.name = "glass", .where = "", .kind = Dielectric{kBk7}}};
  const double c = kHalfBase;
  scene.shapes = {quad({Float(-c), -1, 0}, {Float(c), 0, 1}, {0, 2, 0}, "glass"),
                  quad({Float(c), -1, 0}, {0, 2, 0}, {Float(-c), 0, 1}, "glass")};
  const Exit exit = through_prism(nm);
  const double distance = 10, turn = offset_deg * kPi64 / 180;
  const Plane way{exit.direction.x * std::cos(turn) - exit.direction.z * std::sin(turn),
                  exit.direction.x * std::sin(turn) + exit.direction.z * std::cos(turn)};
  const Plane across{-way.z, way.x};
  const double half = distance * std::tan(kTolerance_deg * kPi64 / 180);
  const Spectrum bin = TabulatedSpectrum({Float(nm - kHalfBin) - Float(0.01), Float(nm - kHalfBin),
                                          Float(nm + kHalfBin), Float(nm + kHalfBin) + Float(0.01)},
                                         {0, 1, 1, 0});
  // edge_u x edge_v = across x y = -way or so: its front faces the prism.
  scene.shapes.push_back(emitting(quad(in_space(exit.position + way * distance - across * half, -1),
                                       in_space(across * (2 * half), 0), {0, 2, 0}, "black"),
                                  bin));
  look_at_point(scene, in_space(kEntry - kView * 3, 0), in_space(kEntry, 0));
  return scene;
}

TEST(Prism, EachBinLeavesWhereSnellAndSellmeierSay) {
  // 3 comparisons (XYZ) of each bin at alpha 0.01 (Šidák) ask for 3.3 standard errors.
  constexpr double kSigmas = 4;
  for (double nm : {430.0, 470.0, 510.0, 550.0, 590.0, 630.0, 670.0}) {
    const Image image = render_scene(strip_behind_prism(nm, 0), 512).image;
    const auto share = Spectrum::constant(Float(through_prism(nm).share));
    const Xyz expected = spectrum_to_xyz(share, {Float(nm - kHalfBin), Float(nm + kHalfBin)});
    for (int c = 0; c < 3; ++c) {
      const Estimate e = estimate_xyz(image, "", c);
      // 1 %: the spectrum's flanks of 0.01 nm, and Fresnel within the bin.
      EXPECT_NEAR(e.mean, expected[std::size_t(c)], kSigmas * e.standard_error + 0.01 * expected[1])
          << nm << " nm, "
          << "XYZ"[c];
    }
    const Estimate y = estimate_y(image);
    EXPECT_LT(y.standard_error, 0.05 * expected[1]) << nm << " nm: cannot tell a difference";
    for (double offset : {-0.25, 0.25}) {  // from 0.15 degrees off on there is nothing
      EXPECT_EQ(estimate_y(render_scene(strip_behind_prism(nm, offset), 64).image).mean, 0) << nm << " nm";
    }
  }
}

TEST(Prism, SpreadsTheVisibleOverManyTolerances) {
  const Plane violet = through_prism(430).direction, red = through_prism(670).direction;
  EXPECT_GT(std::acos(dot(violet, red)) * 180 / kPi64, 10 * kTolerance_deg);
}

}  // namespace
}  // namespace spectrace::test
