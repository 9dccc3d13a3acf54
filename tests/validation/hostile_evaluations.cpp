// SPDX-License-Identifier: Apache-2.0
// Random evaluations and samples of every BSDF, of every real measurement and of each model of its
// separation, with grazing and degenerate directions and numbers far more frequent than chance would have
// them. Counts what must never be: values and weights that are not finite or are negative, samples that have
// a weight and no density. Writes a table (Markdown); exits with 1 where a count is not 0.
//
//   hostile_evaluations [EVALUATIONS of all together, default 1e6]
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "materials/measured_brdf.h"
#include "materials/separated_brdf.h"
#include "separation/separate.h"
#include "tests/statistical/bsdf_registry.h"
#include "tests/statistical/conformance.h"
#include "tests/support/test_data.h"

namespace spectrace::test {
namespace {

struct Subject {
  std::string name;
  std::function<std::optional<Material>()> make;
};

/// One in so many directions is of each kind.
Vec3 hostile_direction(TestRandom& random) {
  const Vec3 w = random_direction(random);
  const auto grazing = [&](double z) {
    const double r = std::hypot(double(w.x), double(w.y)), s = std::sqrt(1 - z * z) / std::max(r, 1e-30);
    return r > 0 ? Vec3{Float(w.x * s), Float(w.y * s), Float(z)} : Vec3{1, 0, Float(z)};
  };
  switch (int(random.uniform() * 20)) {
    case 0:
      return {0, 0, 1};
    case 1:
      return grazing(0);
    case 2:
      return grazing(std::cos(89.99 * double(kPi) / 180));
    case 3:
      return grazing(double(std::numeric_limits<Float>::min()));
    case 4:
      return grazing(double(std::numeric_limits<Float>::denorm_min()));
    case 5:
      return grazing(std::pow(10.0, -8 * double(random.uniform())));
    case 6:
      return grazing(-std::pow(10.0, -8 * double(random.uniform())));
    case 7:
      return {w.x, w.y, -w.z};
    case 8:
      return normalize({w.x * Float(1e-4), w.y * Float(1e-4), 1});  // within a table's first cell
    case 9:
      return {std::copysign(std::sqrt(1 - w.z * w.z), w.x), 0, w.z};  // azimuths 0 and π to the bit
    default:
      return w;
  }
}

/// To go with wo.
Vec3 hostile_partner(Vec3 wo, TestRandom& random) {
  switch (int(random.uniform() * 16)) {
    case 0:
      return wo;  // θd = 0
    case 1:
      return -wo;  // the half vector is null
    case 2:
      return {-wo.x, -wo.y, wo.z};  // θh = 0
    case 3:
      return {-wo.x, -wo.y, -wo.z * (1 - std::numeric_limits<Float>::epsilon())};
    case 4:
      return normalize({-wo.x + Float(1e-6), -wo.y, wo.z});
    default:
      return hostile_direction(random);
  }
}

Float hostile_number(TestRandom& random) {
  switch (int(random.uniform() * 12)) {
    case 0:
      return 0;
    case 1:
      return 1;
    case 2:
      return 1 - std::numeric_limits<Float>::epsilon() / 2;
    case 3:
      return std::numeric_limits<Float>::denorm_min();
    case 4:
      return Float(0.5);
    default:
      return random.uniform();
  }
}

struct Counts {
  std::uint64_t evaluations = 0, not_a_number = 0, infinite = 0, negative = 0, weight_without_density = 0;
  double most_weight = 0;
  std::string first_offence{};  ///< what was asked

  void look_at(const SampledSpectrum& s) {
    for (int lane = 0; lane < kLanes; ++lane) {
      not_a_number += std::uint64_t(std::isnan(s[lane]));
      infinite += std::uint64_t(std::isinf(s[lane]));
      negative += std::uint64_t(s[lane] < 0);
    }
  }
  void look_at(Float pdf) {
    not_a_number += std::uint64_t(std::isnan(pdf));
    infinite += std::uint64_t(std::isinf(pdf));
    negative += std::uint64_t(pdf < 0);
  }
  [[nodiscard]] bool is_clean() const {
    return not_a_number + infinite + negative + weight_without_density == 0;
  }
  Counts& operator+=(const Counts& other) {
    evaluations += other.evaluations;
    not_a_number += other.not_a_number;
    infinite += other.infinite;
    negative += other.negative;
    weight_without_density += other.weight_without_density;
    most_weight = std::max(most_weight, other.most_weight);
    if (first_offence.empty()) first_offence = other.first_offence;
    return *this;
  }
};

std::string text_of(Vec3 w) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", w.x, w.y, w.z); }

Counts ask(const Material& material, std::uint64_t evaluations, std::uint64_t seed) {
  Counts counts;
  TestRandom random(seed);
  const ShadingPoint at{.lambda = test_wavelengths()};
  for (std::uint64_t i = 0; i < evaluations; ++i) {
    const Vec3 wo = hostile_direction(random), wi = hostile_partner(wo, random);
    const BsdfValue value = evaluate(material, wo, wi, at);
    counts.look_at(value.value_cos);
    counts.look_at(value.pdf);
    const LobeValues lobes = evaluate_lobes(material, wo, wi, at);
    counts.look_at(lobes.diffuse);
    if (!lobes.total().is_finite()) ++counts.not_a_number;
    if (!counts.is_clean() && counts.first_offence.empty()) {
      counts.first_offence = fmt::format("evaluate, wo {}, wi {}: {:.3g}, pdf {:.3g}", text_of(wo),
                                         text_of(wi), value.value_cos.max(), value.pdf);
    }
    const BsdfRandom u{hostile_number(random), {hostile_number(random), hostile_number(random)}};
    if (const std::optional<BsdfSample> s = sample(material, wo, u, at)) {
      counts.look_at(s->weight);
      counts.look_at(s->pdf);
      if (!(s->pdf > 0) || !(std::abs(length(s->wi) - 1) < Float(1e-4))) ++counts.weight_without_density;
      counts.most_weight = std::max(counts.most_weight, double(s->weight.max()));
      if (!counts.is_clean() && counts.first_offence.empty()) {
        counts.first_offence = fmt::format(
            "sample, wo {}, u {:.9g} {:.9g} {:.9g}: wi {}, weight {:.3g}, pdf {:.3g}", text_of(wo), u.lobe,
            u.direction.x, u.direction.y, text_of(s->wi), s->weight.max(), s->pdf);
      }
    }
    ++counts.evaluations;
  }
  return counts;
}

/// The registry's, and every real measurement there is by each of its models.
std::vector<Subject> subjects() {
  std::vector<Subject> all;
  for (const BsdfCase& c : bsdf_cases()) all.push_back({c.name, c.make});
  for (const char* folder : {"epfl_rgb", "epfl_uplifted"}) {
    for (const auto& file : measured_files(folder)) {
      for (const SeparationModel model : {SeparationModel::kSun, SeparationModel::kFresnel,
                                          SeparationModel::kDiffraction, SeparationModel::kResidual}) {
        all.push_back({"Separated_" + name_of(model) + "_" + file.stem().string(),
                       [file, model]() -> std::optional<Material> {
                         SeparationOptions options;
                         options.grid = {.n_theta_h = 45, .n_theta_d = 30, .n_phi_d = 36};
                         options.threads = 1;
                         if (model == SeparationModel::kResidual)
                           options.residual_rank = kDefaultResidualRank;
                         SilentProgress progress;
                         const SeparationResult result =
                             separate(MeasuredBrdf(read_measured(file)), options, progress);
                         if (!result.report.usable) return std::nullopt;
                         return SeparatedBrdf(std::make_shared<const SeparatedTables>(result.tables), model);
                       }});
      }
    }
  }
  return all;
}

std::string row(const std::string& name, const Counts& c) {
  return fmt::format("| {} | {} | {} | {} | {} | {} | {:.3g} |\n", name, c.evaluations, c.not_a_number,
                     c.infinite, c.negative, c.weight_without_density, c.most_weight);
}

int run(double evaluations) {
  const std::vector<Subject> all = subjects();
  std::vector<std::optional<Counts>> counts(all.size());
  const auto each = std::uint64_t(std::ceil(evaluations / double(all.size())));
  tbb::parallel_for(std::size_t(0), all.size(), [&](std::size_t i) {
    if (const std::optional<Material> material = all[i].make())
      counts[i] = ask(*material, each, seed_of(all[i].name));
  });
  Counts total;
  std::size_t asked = 0;
  fmt::print(
      "| BSDF | evaluations and samples | NaN | Inf | negative | weight without density | largest weight |\n"
      "|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!counts[i]) {
      fmt::print(stderr, "skipped: {} (set SPECTRACE_DATA)\n", all[i].name);
      continue;
    }
    ++asked;
    fmt::print("{}", row(all[i].name, *counts[i]));
    if (!counts[i]->is_clean()) fmt::print(stderr, "{}: {}\n", all[i].name, counts[i]->first_offence);
    total += *counts[i];
  }
  fmt::print("{}", row(fmt::format("all {}", asked), total));
  return total.is_clean() ? 0 : 1;
}

}  // namespace
}  // namespace spectrace::test

int main(int count, char** arguments) {
  return spectrace::test::run(count > 1 ? std::atof(arguments[1]) : 1e6);
}
