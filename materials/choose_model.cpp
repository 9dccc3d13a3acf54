// SPDX-License-Identifier: Apache-2.0
#include "materials/choose_model.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/math/sampler.h"
#include "core/spectra/sampled_wavelengths.h"
#include "materials/lambert.h"
#include "materials/separated_brdf.h"

namespace spectrace {
namespace {

constexpr std::uint64_t kSamples = 1 << 14, kSeed = 20;

double sum_of_lanes(const SampledSpectrum& s) {
  double sum = 0;
  for (int lane = 0; lane < kLanes; ++lane) sum += double(s[lane]);
  return sum;
}

/// What model_error() says, of anything with a BRDF's evaluate().
template <typename Brdf>
double error_against(const Brdf& whole, const SeparatedSource& source, SeparationModel model) {
  const SeparatedBrdf brdf(source, model);
  const WavelengthDistribution wavelengths = WavelengthDistribution::uniform({});
  double difference = 0, reflected = 0;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    const Sampler sampler(0, i, kSeed);
    const SampledWavelengths lambda = wavelengths.sample(sampler.path().wavelength);
    const ShadingPoint at{.lambda = lambda};
    const Vec3 wo = sample_cosine_hemisphere(sampler.path().pixel);
    const VertexNumbers numbers = sampler.vertex(0);
    const BsdfRandom u{numbers.lobe, numbers.bsdf};
    const std::optional<BsdfSample> drawn = brdf.sample(wo, u, at);
    if (!drawn) continue;
    const SampledSpectrum truth = whole.evaluate(wo, drawn->wi, at).value_cos / drawn->pdf;
    SampledSpectrum error;
    for (int lane = 0; lane < kLanes; ++lane) error[lane] = std::abs(truth[lane] - drawn->weight[lane]);
    difference += sum_of_lanes(error);
    reflected += sum_of_lanes(truth);
  }
  return reflected > 0 ? difference / reflected : 0;
}

/// `light`: what errors are shares of, in words.
template <typename Brdf>
ModelChoice choose_by(const Brdf& whole, const SeparatedSource& source, double tolerance,
                      std::string_view light) {
  ModelChoice choice;
  const SeparationModel richest = richest_model(source);
  std::string others;
  for (int m = 0; m <= static_cast<int>(richest); ++m) {
    choice.model = static_cast<SeparationModel>(m);
    choice.errors.push_back(error_against(whole, source, choice.model));
    choice.within_tolerance = choice.errors.back() <= tolerance;
    if (choice.within_tolerance) break;
    others += fmt::format("; {} has {:.2f} %", name_of(choice.model), 100 * choice.errors.back());
  }
  choice.reason =
      choice.within_tolerance
          ? fmt::format("{}: error {:.2f} % of {}, at most {:.2f} % wanted{}", name_of(choice.model),
                        100 * choice.errors.back(), light, 100 * tolerance, others)
          : fmt::format("{}: no model has an error of at most {:.2f} % of {}{}", name_of(choice.model),
                        100 * tolerance, light, others);
  return choice;
}

}  // namespace

double model_error(const MeasuredBrdf& measured, const SeparatedSource& source, SeparationModel model) {
  return error_against(measured, source, model);
}

ModelChoice choose_model(const MeasuredBrdf& measured, const SeparatedSource& source, double tolerance) {
  return choose_by(measured, source, tolerance, "the reflected light");
}

ModelChoice choose_model(const SeparatedSource& source, double tolerance) {
  const SeparationModel richest = richest_model(source);
  return choose_by(SeparatedBrdf(source, richest), source, tolerance,
                   fmt::format("what the model {} reflects", name_of(richest)));
}

}  // namespace spectrace
