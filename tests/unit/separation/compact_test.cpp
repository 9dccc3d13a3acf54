// SPDX-License-Identifier: Apache-2.0
#include "separation/compact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "materials/separated_brdf.h"
#include "materials/separated_lookup.h"
#include "tests/support/chi_square.h"
#include "tests/support/synthetic_separated.h"

namespace spectrace {
namespace {

constexpr HalfDifferenceGrid kGrid{.n_theta_h = 30, .n_theta_d = 20, .n_phi_d = 24};

std::shared_ptr<SeparatedTables> material() {
  auto tables = test::synthetic_separated({.grid = kGrid});
  tables->rho_s[5] = 0;
  tables->residual = {.basis = std::vector<float>(2 * tables->axis.size(), 0.5F),
                      .ratio = std::vector<std::int8_t>(2 * kGrid.size()),
                      .step = 1.0F / 64,
                      .rank = 2,
                      .axis_size = tables->axis.size()};
  for (std::size_t i = 0; i < tables->residual.ratio.size(); ++i) {
    tables->residual.ratio[i] = static_cast<std::int8_t>(int(i % 41) - 20);
  }
  tables->analytic.assign(4 * tables->axis.size(), 0.5F);
  tables->source_name = "made for tests";
  return tables;
}

TEST(Compact, RhoSKeepsTheErrorBoundItStates) {
  const auto tables = material();
  for (int quality = kMinQuality; quality <= kMaxQuality; ++quality) {
    const CompactResult result = compact(*tables, quality);
    double worst = 0;
    for (std::size_t i = 0; i < tables->rho_s.size(); ++i) {
      const double exact = double(tables->rho_s[i]), coded = double(result.tables.rho_s[i]);
      ASSERT_EQ(exact == 0, coded == 0) << i;
      if (exact > 0) worst = std::max(worst, std::abs(coded / exact - 1));
    }
    EXPECT_LE(worst, result.report.rho_s_error_bound * (1 + 1e-4) + 1e-7) << quality;  // rounding of floats
    EXPECT_GT(worst, result.report.rho_s_error_bound / 4) << quality;  // the bound says something
  }
}

TEST(Compact, MorePrecisionIsALargerFileAndASmallerError) {
  const auto tables = material();
  std::size_t last_size = 0;
  double last_error = 1;
  for (int quality : {2, 5, 8, 11}) {
    const CompactResult result = compact(*tables, quality);
    const std::size_t size = compact_to_tensors(result.tables).serialize().size();
    EXPECT_GT(size, last_size);
    EXPECT_LE(result.report.spectral_rms_error, last_error);
    EXPECT_LE(result.report.spectral_rms_error, std::exp2(-(quality + 1)));
    last_size = size;
    last_error = result.report.spectral_rms_error;
  }
}

TEST(Compact, EveryOptionalFieldIsReadFromEitherForm) {
  const auto tables = material();
  tables->residual.odd.assign(tables->residual.ratio.size(), std::int8_t(3));
  tables->diffuse_shape.assign(kGrid.size(), 0.5F);
  tables->source_sha256 = std::string(64, 'a');
  tables->report_json = "{}";
  const auto parsed = [](const TensorFile& file) { return TensorFile::parse(file.serialize(), "a.sep"); };
  const SeparatedTables plain = separated_from_tensors(parsed(separated_to_tensors(*tables)));
  const CompactTables small = compact_from_tensors(parsed(compact_to_tensors(compact(*tables, 6).tables)));
  EXPECT_EQ(plain.residual.odd, tables->residual.odd);
  EXPECT_EQ(small.residual.odd, tables->residual.odd);
  EXPECT_EQ(plain.diffuse_shape, tables->diffuse_shape);
  EXPECT_EQ(small.diffuse_shape.size(), kGrid.size());
  EXPECT_EQ(plain.analytic, tables->analytic);
  EXPECT_EQ(small.analytic, tables->analytic);
  EXPECT_EQ(small.report_json, "{}");
}

TEST(Compact, AFileGivesBackTheSameMaterial) {
  const CompactResult result = compact(*material(), 6);
  const TensorFile file = compact_to_tensors(result.tables);
  ASSERT_TRUE(is_compact(file));
  const CompactTables back = compact_from_tensors(TensorFile::parse(file.serialize(), "a.sep"));
  EXPECT_EQ(back.rho_s.code, result.tables.rho_s.code);
  EXPECT_EQ(back.rho_s.level, result.tables.rho_s.level);
  EXPECT_EQ(back.c_d, result.tables.c_d);
  EXPECT_EQ(back.basis, result.tables.basis);
  EXPECT_EQ(back.residual.ratio, result.tables.residual.ratio);
  EXPECT_EQ(back.residual.basis, result.tables.residual.basis);
  EXPECT_EQ(back.analytic, result.tables.analytic);
  EXPECT_EQ(back.source_name, "made for tests");
  ASSERT_EQ(back.s_diffraction.size(), result.tables.s_diffraction.size());
  for (std::size_t i = 0; i < back.s_diffraction.size(); ++i) {
    // Half a step of 1/32767 of the largest weight, which is below 8 here.
    ASSERT_NEAR(back.s_diffraction[i], result.tables.s_diffraction[i], 8 / 32767.0);
  }
}

TEST(Compact, EvaluatesLikeThePlainTables) {
  const auto tables = material();
  const auto small = std::make_shared<const CompactTables>(compact(*tables, 10).tables);
  std::array<Float, kLanes> lambda_nm{}, pdf{};
  for (int i = 0; i < kLanes; ++i) lambda_nm[i] = 420 + 80 * Float(i);
  pdf.fill(1);
  const SampledWavelengths lambda(lambda_nm, pdf);
  test::TestRandom random(3);
  for (int m = 0; m < 4; ++m) {
    const auto model = static_cast<SeparationModel>(m);
    const SeparatedBrdf plain(tables, model), compacted(small, model);
    for (int i = 0; i < 2000; ++i) {
      const auto draw = [&] {
        const double z = 0.05 + 0.95 * double(random.uniform()), phi = 6.283 * double(random.uniform());
        const double r = std::sqrt(1 - z * z);
        return Vec3{Float(r * std::cos(phi)), Float(r * std::sin(phi)), Float(z)};
      };
      const Vec3 wo = draw(), wi = draw();
      const SampledSpectrum a = plain.evaluate(wo, wi, {.lambda = lambda}).value_cos,
                            b = compacted.evaluate(wo, wi, {.lambda = lambda}).value_cos;
      for (int lane = 0; lane < kLanes; ++lane) {
        // rho_s to 2^-11, spectra to 2^-11 in the mean; a residual that cancels keeps their absolute error.
        ASSERT_NEAR(double(b[lane]), double(a[lane]), 0.01 * (double(a[lane]) + 0.05)) << name_of(model);
      }
    }
  }
}

TEST(Compact, HoldsNoMoreThanItsRichestModelNeeds) {
  const auto tables = material();
  std::size_t last = 0;
  for (int m = 0; m < 4; ++m) {
    const auto model = static_cast<SeparationModel>(m);
    const auto small = std::make_shared<const CompactTables>(compact(*tables, 7, model).tables);
    EXPECT_EQ(richest_model(small), model);
    const TensorFile file = compact_to_tensors(*small);
    const CompactTables back = compact_from_tensors(TensorFile::parse(file.serialize(), "a.sep"));
    EXPECT_EQ(richest_model(std::make_shared<const CompactTables>(back)), model);
    EXPECT_GT(file.serialize().size(), last);
    last = file.serialize().size();
  }
}

TEST(Compact, HostileFieldsAreNamed) {
  const TensorFile whole = compact_to_tensors(compact(*material(), 4).tables);
  for (const Tensor& exchanged : whole.tensors()) {
    if (exchanged.name == "format" || exchanged.name.starts_with("source") ||
        exchanged.name == "wavelengths") {
      continue;
    }
    TensorFile file;
    for (const Tensor& tensor : whole.tensors()) {
      Tensor copy = tensor;
      if (tensor.name == exchanged.name) {  // cut in half: of a shape nobody expects
        copy.bytes.resize(std::max<std::size_t>(
            size_of(copy.type), copy.bytes.size() / 2 / size_of(copy.type) * size_of(copy.type)));
        copy.shape = {copy.bytes.size() / size_of(copy.type)};
        if (copy.bytes.size() == tensor.bytes.size()) copy.bytes.assign(copy.bytes.size(), std::byte{0xff});
      }
      file.add(copy);
    }
    try {
      compact_from_tensors(file);
      ADD_FAILURE() << exchanged.name << " accepted";
    } catch (const InputError& e) {
      EXPECT_NE(e.diagnostics().front().text().find(exchanged.name), std::string::npos)
          << exchanged.name << ": " << e.diagnostics().front().text();
    }
  }
}

}  // namespace
}  // namespace spectrace
