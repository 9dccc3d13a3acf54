// SPDX-License-Identifier: Apache-2.0
// H1 to H3: measured BRDFs at the horizon, where tables end, hold zeros and divide by small numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/hard_cases/every_measurement.h"
#include "tests/support/acquired.h"
#include "tests/support/chi_square.h"
#include "tests/support/render_scenes.h"
#include "tests/support/shading_point.h"
#include "tests/support/temporary_folder.h"

namespace spectrace::test {
namespace {

using H01_GrazingIncidence = EveryMeasurement;

/// From the last that single precision tells from the horizon to what is well below it.
constexpr std::array kGrazingDeg{85.0, 89.9, 89.99, 89.9999, 89.999999};
constexpr double kBelowDeg = 90.01;
constexpr std::array kAzimuthsDeg{0.0, 30.0, 90.0, 179.99, 180.0};

TEST_P(H01_GrazingIncidence, IsFiniteUpToTheHorizonAndNothingInOrBelowIt) {
  const Vec3 horizon{Float(0.6), Float(0.8), 0};
  for (const auto& [name, material] : forms()) {
    SCOPED_TRACE(name);
    for (const double phi : kAzimuthsDeg) {
      for (const double other_deg : {0.0, 45.0, 78.0, 89.99, 89.999999}) {
        const Vec3 other = direction_deg(other_deg, phi);
        for (const double theta : kGrazingDeg) {
          const Vec3 grazing = direction_deg(theta, 10);
          EXPECT_TRUE(is_valid(evaluate(material, grazing, other, kAt))) << theta << ' ' << other_deg;
          EXPECT_TRUE(is_valid(evaluate(material, other, grazing, kAt))) << theta << ' ' << other_deg;
        }
        for (const Vec3 dark : {horizon, direction_deg(kBelowDeg, 10)}) {
          EXPECT_TRUE(is_nothing(evaluate(material, dark, other, kAt))) << other_deg;
          EXPECT_TRUE(is_nothing(evaluate(material, other, dark, kAt))) << other_deg;
          EXPECT_TRUE(evaluate_lobes(material, other, dark, kAt).total().is_zero()) << other_deg;
          EXPECT_FALSE(sample(material, dark, {Float(0.5), {Float(0.5), Float(0.5)}}, kAt));
        }
      }
    }
  }
}

TEST_P(H01_GrazingIncidence, SamplesFromThereAreValid) {
  TestRandom random(1);
  for (const auto& [name, material] : forms()) {
    SCOPED_TRACE(name);
    for (const double theta : kGrazingDeg) {
      const Vec3 wo = direction_deg(theta, 10);
      for (int i = 0; i < 500; ++i) {
        const Float lobe = random.uniform();
        const auto s = sample(material, wo, {lobe, random.uniform2()}, kAt);
        if (!s) continue;
        ASSERT_TRUE(s->wi.z > 0 && s->pdf > 0 && std::isfinite(s->pdf)) << theta;
        ASSERT_TRUE(is_valid(s->weight)) << theta;
      }
    }
  }
}

TEST_P(H01_GrazingIncidence, BeyondTheLastMeasuredSliceIsExtrapolated) {
  const double last_deg = radians_to_degrees(double(measured().last_measured_theta_i()));
  EXPECT_LT(last_deg, 86);  // each of these files ends in a copy
  const Vec3 wi = direction_deg(30, 200);
  for (const double theta : {0.0, 45.0, last_deg - 0.01}) {
    EXPECT_FALSE(measured().footprint(direction_deg(theta, 10), wi)->extrapolated) << theta;
  }
  for (const double theta : {last_deg + 0.01, 89.99, 89.999999}) {
    const auto footprint = measured().footprint(direction_deg(theta, 10), wi);
    EXPECT_TRUE(footprint->extrapolated) << theta;
    EXPECT_FALSE(footprint->measured) << theta;
  }
}

SeparationOptions small_grid() {
  SeparationOptions options;
  options.grid = {.n_theta_h = 30, .n_theta_d = 20, .n_phi_d = 18};
  return options;
}
SeparationResult separated(const MeasuredTables& tables) {
  SilentProgress progress;
  return separate(MeasuredBrdf(tables), small_grid(), progress);
}

/// What the fits find; rho_s also holds what no fit knows: the file's own value where nothing was measured.
void expect_equal_fits(const SeparationResult& a, const SeparationResult& b) {
  ASSERT_TRUE(a.report.usable && b.report.usable);
  EXPECT_EQ(a.report.measured, b.report.measured);
  EXPECT_EQ(a.report.extrapolated, b.report.extrapolated);
  EXPECT_EQ(a.report.invalid, b.report.invalid);
  const auto expect_near = [](const std::vector<float>& x, const std::vector<float>& y, const char* name) {
    ASSERT_EQ(x.size(), y.size()) << name;
    // A copied slice is interpolated with, to the same values but for rounding.
    for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(x[i], y[i], 1e-5F * y[i]) << name << ' ' << i;
  };
  expect_near(a.tables.c_d, b.tables.c_d, "c_d");
  expect_near(a.tables.s_sun, b.tables.s_sun, "s_sun");
  expect_near(a.tables.s_fresnel, b.tables.s_fresnel, "s_fresnel");
  expect_near(a.tables.s_diffraction, b.tables.s_diffraction, "s_diffraction");
}

TEST(H01_GrazingIncidence, TheCopyOfTheLastSliceIsNotFitted) {
  const MeasuredTables whole = acquired_tables("pearlescent");
  ASSERT_LT(whole.last_measured_theta_i(), whole.theta_i.back());
  const SeparationResult fitted = separated(whole);
  EXPECT_GT(fitted.report.extrapolated, 0U);
  MeasuredTables cut = whole;
  const auto drop_last = [&](auto& table) {
    table.resize(table.size() / whole.slices() * (whole.slices() - 1));
  };
  cut.theta_i.pop_back();
  drop_last(cut.vndf);
  drop_last(cut.luminance);
  drop_last(cut.spectra);
  drop_last(cut.valid);
  expect_equal_fits(separated(cut), fitted);
}

using H02_ZerosInTables = EveryMeasurement;

TEST(H02_ZerosInTables, WhatIsNotValidWeighsNothingInTheFit) {
  MeasuredTables tables = acquired_tables("pearlescent");
  const auto m = std::size_t(tables.table_size), cells = m * m, n = tables.axis.size();
  // A band of azimuths, and within it, a row of cells away from all that is valid, garbage.
  const std::size_t first = m / 3, end = m / 3 + 8;
  MeasuredTables garbage = tables;
  for (std::size_t slice = 0; slice < tables.slices(); ++slice) {
    for (std::size_t y = first; y < end; ++y) {
      for (std::size_t x = 0; x < m; ++x) {
        tables.valid[slice * cells + y * m + x] = 0;
        if (y == first || y + 1 == end) continue;
        for (std::size_t k = 0; k < n; ++k) garbage.spectra[(slice * n + k) * cells + y * m + x] = 1e4F;
      }
    }
  }
  garbage.valid = tables.valid;
  const SeparationResult a = separated(tables), b = separated(garbage);
  EXPECT_GT(a.report.invalid, 0U);
  expect_equal_fits(b, a);
  EXPECT_NE(a.report.full().find("fill rule"), std::string::npos);
}

TEST_P(H02_ZerosInTables, DivideNothing) {
  TestRandom random(2);
  for (const auto& [name, material] : forms()) {
    SCOPED_TRACE(name);
    for (int i = 0; i < 3000; ++i) {
      const Vec3 wo = direction_deg(90 * double(random.uniform()), 360 * double(random.uniform())),
                 wi = direction_deg(90 * double(random.uniform()), 360 * double(random.uniform()));
      ASSERT_TRUE(is_valid(evaluate(material, wo, wi, kAt))) << wo.z << ' ' << wi.z;
      const Float lobe = random.uniform();
      const auto s = sample(material, wo, {lobe, random.uniform2()}, kAt);
      if (!s) continue;
      ASSERT_TRUE(s->pdf > 0 && std::isfinite(s->pdf) && is_valid(s->weight)) << wo.z;
    }
  }
}

using H03_DivisionByTheCosine = EveryMeasurement;

/// Largest luminance of any pixel of a ball under a sky of 1: each is a mean of weights.
double brightest_on_a_ball(decltype(MaterialDesc::kind) kind) {
  SceneDesc scene = empty_scene();
  scene.film = {32, 32};
  scene.camera.fov_deg = Float(23.2);  // its rim runs through the pixels at the edges: grazing
  scene.materials = {{.name = "ball", .where = "", .kind = std::move(kind)}};
  scene.shapes = {sphere({0, 0, 0}, 1, "ball")};
  scene.lights = {sky(1)};
  const Image image = render_scene(scene, 16).image;
  double largest = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      largest =
          std::max(largest, pixel_xyz(image, x, y, "diffuse")[1] + pixel_xyz(image, x, y, "specular")[1]);
    }
  }
  return largest;
}

TEST_P(H03_DivisionByTheCosine, NoPixelSeesIt) {
  // A ball that reflects all has 1. Seen: 1.06 (of "synthetic_rgb"), where f itself reaches 1e8.
  constexpr double kBrightest = 1.5;
  EXPECT_LT(brightest_on_a_ball(MeasuredDesc{file()}), kBrightest);
  if (!separated()) return;
  const TemporaryFolder folder;
  separated_to_tensors(*separated()).write(folder / "separated.sep");
  for (const std::string_view model : kSeparationModelNames) {
    EXPECT_LT(brightest_on_a_ball(
                  SeparatedDesc{.file = folder / "separated.sep", .model = separation_model_named(model)}),
              kBrightest)
        << model;
  }
}

SPECTRACE_ON_EVERY_MEASUREMENT(H01_GrazingIncidence);
SPECTRACE_ON_EVERY_MEASUREMENT(H02_ZerosInTables);
SPECTRACE_ON_EVERY_MEASUREMENT(H03_DivisionByTheCosine);

}  // namespace
}  // namespace spectrace::test
