// SPDX-License-Identifier: Apache-2.0
#include "tests/support/known_truth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "core/math/math.h"
#include "tests/support/chi_square.h"

namespace spectrace::test {
namespace {

constexpr double kTolerance = 0.02;     // the product's own demand
constexpr double kDiffuseShare = 0.10;  // and where it holds

Material built_in(const std::string& name) {
  return build_material(
      load_material(std::filesystem::path(SPECTRACE_SOURCE_DIR) / "scenes/materials" / (name + ".json")));
}

SampledWavelengths at_wavelength(float lambda_nm) {
  std::array<Float, kLanes> nm{}, pdf{};
  nm.fill(lambda_nm);
  pdf.fill(1);
  return {nm, pdf};
}

struct Truth {
  double c_d = 0;
  double diffuse_share = 0;  ///< of the light reflected under uniform light
};

Truth truth_of(const Material& material, float lambda_nm) {
  const SampledWavelengths lambda = at_wavelength(lambda_nm);
  const ShadingPoint at{.lambda = lambda};
  const Vec3 above{0, 0, 1};
  Truth truth{.c_d = double(evaluate_lobes(material, above, above, at).diffuse[0]) * kPi64};
  // The specular albedo, averaged over views in proportion to their cosine. The share only decides which
  // wavelengths count: 2000 samples give it to 2 %.
  constexpr int kSamples = 2000;
  TestRandom random(41);
  double specular = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Float z = std::sqrt((Float(i) + Float(0.5)) / kSamples);
    const Vec3 wo{std::sqrt(1 - z * z), 0, z};
    const Float lobe = random.uniform();
    const auto s = sample(material, wo, {lobe, random.uniform2()}, at);
    if (s) specular += double(evaluate_lobes(material, wo, s->wi, at).specular()[0] / s->pdf) / kSamples;
  }
  truth.diffuse_share = truth.c_d > 0 ? truth.c_d / (truth.c_d + specular) : 0;
  return truth;
}

}  // namespace

/// c_d.
double recovery_error(const KnownMaterial& known, const AcquisitionOptions& acquisition,
                      const SeparationOptions& separation) {
  const Material material = built_in(known.name);
  SilentProgress progress;
  const SeparationResult result =
      separate(MeasuredBrdf(acquire(material, acquisition, progress)), separation, progress);
  EXPECT_TRUE(result.report.usable) << known.name;
  double sum = 0, largest = 0;
  int count = 0;
  for (std::size_t k = 0; k < acquisition.lambda_nm.size(); ++k) {
    const Truth truth = truth_of(material, acquisition.lambda_nm[k]);
    largest = std::max(largest, double(result.tables.c_d[k]));
    if (truth.diffuse_share < kDiffuseShare) continue;
    sum += std::abs(double(result.tables.c_d[k]) / truth.c_d - 1);
    ++count;
  }
  EXPECT_EQ(count > 0, known.has_diffuse) << known.name;
  return known.has_diffuse ? sum / std::max(count, 1) : largest;
}

AcquisitionOptions fine_acquisition() {
  AcquisitionOptions options;
  options.elevations = 24;
  options.table_size = 96;
  return options;
}

void expect_recovered(const KnownMaterial& known, const AcquisitionOptions& acquisition,
                      const SeparationOptions& separation) {
  const double error = recovery_error(known, acquisition, separation);
  if (known.has_diffuse) {
    EXPECT_LT(error, kTolerance) << known.name;
  } else {
    EXPECT_EQ(error, 0) << known.name;
  }
  std::cout << "  " << known.name << ": " << 100 * error << " %\n";
}

}  // namespace spectrace::test
