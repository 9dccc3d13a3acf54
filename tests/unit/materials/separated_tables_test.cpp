// SPDX-License-Identifier: Apache-2.0
#include "materials/separated_tables.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "core/base/error.h"
#include "core/math/math.h"
#include "tests/support/synthetic_separated.h"

namespace spectrace {
namespace {

constexpr HalfDifferenceGrid kSmall{.n_theta_h = 9, .n_theta_d = 7, .n_phi_d = 10};

std::string message(const TensorFile& file) {
  try {
    separated_from_tensors(file);
  } catch (const InputError& e) {
    return e.diagnostics().front().text();
  }
  return "accepted";
}

/// The fields of a good file, with one of them exchanged.
TensorFile with(const Tensor& exchanged) {
  const TensorFile whole = separated_to_tensors(*test::synthetic_separated({.grid = kSmall}));
  TensorFile file;
  for (const Tensor& tensor : whole.tensors()) {
    file.add(tensor.name == exchanged.name ? exchanged : tensor);
  }
  return file;
}

TEST(HalfDifferenceGrid, CoordinatesInvertNodesForBothSpacings) {
  for (bool quadratic : {true, false}) {
    HalfDifferenceGrid grid;
    grid.quadratic_theta_h = quadratic;
    for (double i = 0; i <= 89; i += 0.25) {
      EXPECT_NEAR(grid.coordinate_h(grid.theta_h(i)), i, 1e-9);
      EXPECT_NEAR(grid.coordinate_d(grid.theta_d(i)), i, 1e-9);
      EXPECT_NEAR(grid.coordinate_p(grid.phi_d(2 * i)), 2 * i, 1e-9);
    }
  }
}

TEST(HalfDifferenceGrid, QuadraticSpacingIsThatOfMerl) {
  const HalfDifferenceGrid grid;
  EXPECT_NEAR(grid.theta_h(30) * 180 / kPi64, 10, 1e-12);  // (30/90)² 90°
}

TEST(HalfDifferenceGrid, OutsideTheNodesTheNearestHolds) {
  const HalfDifferenceGrid grid;
  EXPECT_EQ(grid.coordinate_h(kPi64 / 2), 89);
  EXPECT_EQ(grid.coordinate_h(-1e-9), 0);
  EXPECT_EQ(grid.coordinate_d(kPi64 / 2), 89);
  EXPECT_EQ(grid.coordinate_p(kPi64), 0);
}

TEST(HalfDifferenceGrid, LocateInterpolatesLinearlyAndWrapsInPhi) {
  const HalfDifferenceGrid grid;
  const HalfDifference angles{0.75 * grid.theta_h(3) + 0.25 * grid.theta_h(4), grid.theta_d(10.5),
                              grid.phi_d(179.75)};
  const GridPoint point = grid.locate(angles);
  const auto sum = [](const auto& weights) { return std::accumulate(weights.begin(), weights.end(), 0.0F); };
  EXPECT_NEAR(sum(point.cell_weight), 1, 1e-6);
  EXPECT_NEAR(sum(point.angular_weight), 1, 1e-6);
  EXPECT_NEAR(sum(point.theta_d_weight), 1, 1e-6);
  EXPECT_EQ(point.cell[0], grid.index(3, 10, 179));
  EXPECT_EQ(point.cell[1], grid.index(3, 10, 0));
  EXPECT_NEAR(point.cell_weight[1], 0.75 * 0.5 * 0.75, 1e-5);
  EXPECT_EQ(point.cell[7], grid.index(4, 11, 0));
  EXPECT_NEAR(point.cell_weight[7], 0.25 * 0.5 * 0.75, 1e-5);
  EXPECT_EQ(point.angular[2], 4U * 90 + 10);
}

TEST(SeparatedTables, AFileGivesBackWhatWasWritten) {
  for (bool rgb : {false, true}) {
    auto tables = test::synthetic_separated({.grid = kSmall});
    if (rgb) {
      tables->axis = SpectralAxis::rgb();
      tables->c_d.resize(3);
      tables->s_sun.resize(3);
      tables->s_fresnel.resize(std::size_t(7) * 3);
      tables->s_diffraction.resize(std::size_t(63) * 3);
    }
    tables->grid.quadratic_theta_h = rgb;
    tables->source_name = "paint.bsdf";
    tables->source_sha256 = "0123";
    tables->report_json = "{}";
    const SeparatedTables read =
        separated_from_tensors(TensorFile::parse(separated_to_tensors(*tables).serialize(), "a.sep"));
    EXPECT_EQ(read.grid.n_theta_h, 9);
    EXPECT_EQ(read.grid.n_theta_d, 7);
    EXPECT_EQ(read.grid.n_phi_d, 10);
    EXPECT_EQ(read.grid.quadratic_theta_h, rgb);
    EXPECT_EQ(read.axis.is_rgb(), rgb);
    EXPECT_EQ(read.axis.size(), tables->axis.size());
    EXPECT_EQ(read.c_d, tables->c_d);
    EXPECT_EQ(read.rho_s, tables->rho_s);
    EXPECT_EQ(read.s_sun, tables->s_sun);
    EXPECT_EQ(read.s_fresnel, tables->s_fresnel);
    EXPECT_EQ(read.s_diffraction, tables->s_diffraction);
    EXPECT_EQ(read.source_name, "paint.bsdf");
    EXPECT_EQ(read.source_sha256, "0123");
    EXPECT_EQ(read.report_json, "{}");
  }
}

TEST(SeparatedTables, HostileFieldsAreNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::array<float, 8> good{1, 1, 1, 1, 1, 1, 1, 1};
  std::array<float, 8> negative = good, undefined = good;
  negative[3] = -0.5F;
  undefined[5] = nan;
  EXPECT_EQ(message(with(Tensor::from_floats("c_d", {8}, good))), "accepted");
  EXPECT_NE(message(with(Tensor::from_floats("c_d", {8}, negative))).find("\"c_d\""), std::string::npos);
  EXPECT_NE(message(with(Tensor::from_floats("s_sun", {8}, undefined))).find("element 5"), std::string::npos);
  EXPECT_NE(message(with(Tensor::from_floats("s_fresnel", {4, 2}, good))).find("s_fresnel"),
            std::string::npos);
  EXPECT_NE(message(with(Tensor::from_floats("wavelengths", {8}, good))).find("increasing"),
            std::string::npos);
  EXPECT_NE(message(with(Tensor::from_text("theta_h_spacing", "cubic"))).find("quadratic"),
            std::string::npos);
  EXPECT_NE(message(with(Tensor::from_text("format", "spectrace separated material 2"))).find("format"),
            std::string::npos);
  EXPECT_NE(message(with(Tensor::from_floats("rho_s", {8, 1, 1}, good))).find("rho_s"), std::string::npos);
  TensorFile misspelt = with(Tensor::from_floats("c_d", {8}, good));
  misspelt.add(Tensor::from_floats("analytik", {8}, good));
  EXPECT_NE(message(misspelt).find("did you mean \"analytic\"?"), std::string::npos);
}

TEST(SeparatedTables, EveryMissingFieldIsNamed) {
  const TensorFile whole = separated_to_tensors(*test::synthetic_separated({.grid = kSmall}));
  for (const Tensor& left_out : whole.tensors()) {
    TensorFile file;
    for (const Tensor& tensor : whole.tensors()) {
      if (tensor.name != left_out.name) file.add(tensor);
    }
    // Without wavelengths a file claims to be RGB: then the number of channels gives it away.
    const std::string named = left_out.name == "wavelengths" ? "c_d" : left_out.name;
    EXPECT_NE(message(file).find(named), std::string::npos) << left_out.name << ": " << message(file);
  }
}

}  // namespace
}  // namespace spectrace
