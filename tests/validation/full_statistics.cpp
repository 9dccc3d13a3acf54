// SPDX-License-Identifier: Apache-2.0
// The statistics of every BSDF at full size: 10^6 samples at each of 5 incidences and 3 bands of wavelengths,
// counted in 80 x 160 bins of one size and in cells that follow the lobe; weights, Jacobians, energy and
// reciprocity beside them. A line of tab-separated figures for each; tests/validation/full_statistics.py
// judges them and makes the table of docs/validation.md.
//
//   full_statistics RESULTS [SAMPLES, default 1e6] [only names that contain this]
//
// Appends to RESULTS, and leaves out the subjects that are in it already: to go on after a stop.
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <set>
#include <string>
#include <vector>

#include "tests/statistical/conformance.h"
#include "tests/validation/sampled_jacobian.h"
#include "tests/validation/subjects.h"

namespace spectrace::test {
namespace {

constexpr std::size_t kBinRows = 80, kBinColumns = 160;
constexpr int kPairs = 20'000;

struct Band {
  const char* name;
  double min_nm, max_nm;
};
constexpr std::array kBands{Band{"400-490", 400, 490}, Band{"490-580", 490, 580}, Band{"580-700", 580, 700}};

SampledWavelengths wavelengths_of(const Band& band) {
  std::array<Float, kLanes> nm{}, pdf{};
  for (int i = 0; i < kLanes; ++i)
    nm[std::size_t(i)] = Float(band.min_nm + (band.max_nm - band.min_nm) * (i + 0.5) / kLanes);
  pdf.fill(1);
  return {nm, pdf};
}

/// 99th percentile and worst of errors.
class Errors {
 public:
  void add(double error) { all_.push_back(std::isfinite(error) ? error : INFINITY); }
  [[nodiscard]] double percentile(double share) {
    if (all_.empty()) return 0;
    const auto at = all_.begin() + std::ptrdiff_t(double(all_.size() - 1) * share);
    std::nth_element(all_.begin(), at, all_.end());
    return *at;
  }

 private:
  std::vector<double> all_;
};

double relative_difference(double a, double b) {
  return a == b ? 0 : std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

struct Trial {
  double theta_deg = 0;
  int side = 1;
  Band band{};
};

class SubjectTest {
 public:
  SubjectTest(const Subject& subject, const Material& material, double samples)
      : subject_(subject), material_(material), samples_(samples) {}

  [[nodiscard]] std::vector<std::string> run() const {
    std::vector<Trial> trials;
    for (const int side : sides()) {
      for (const double theta_deg : kIncidenceDeg) {
        for (const Band& band : kBands) trials.push_back({theta_deg, side, band});
      }
    }
    std::vector<std::string> lines(trials.size());
    tbb::parallel_for(std::size_t(0), trials.size(), [&](std::size_t i) { lines[i] = test(trials[i]); });
    return lines;
  }

 private:
  [[nodiscard]] std::vector<int> sides() const {
    return keeps_sides(material_) ? std::vector{1, -1} : std::vector{1};
  }
  [[nodiscard]] double index_squared(Vec3 w, Float lambda_nm) const {
    return w.z < 0 ? sqr(double(subject_.bsdf.interior_eta.at(lambda_nm))) : 1;
  }
  [[nodiscard]] std::uint64_t seed(const Trial& t) const {
    return seed_of(subject_.bsdf.name + t.band.name) + std::uint64_t(t.theta_deg * 10) +
           std::uint64_t(t.side < 0);
  }

  /// Into the hemisphere of one side: samples of the other count as lost.
  [[nodiscard]] SamplingTestResult sampling(const Trial& t, int half, const ShadingPoint& at) const {
    const Vec3 wo = on_side(direction(t.theta_deg, kAzimuthRad), t.side);
    SamplingTestOptions options;
    options.samples = std::size_t(samples_ / double(sides().size()));
    options.seed = seed(t);
    options.azimuth_zero = direction(90, kAzimuthRad + double(kPi));  // lobes lie opposite to wo
    options.bin_rows = kBinRows, options.bin_columns = kBinColumns;
    return test_sampling(
        [&](TestRandom& random) -> std::optional<Vec3> {
          const std::optional<BsdfSample> s = sample(material_, wo, random_numbers(random), at);
          if (!s || s->is_delta) return std::nullopt;
          if (keeps_sides(material_) && s->wi.z * Float(half) < 0) return std::nullopt;
          return on_side(s->wi, half);
        },
        [&](Vec3 wi) { return double(evaluate(material_, wo, on_side(wi, half), at).pdf); }, options);
  }

  [[nodiscard]] std::string test(const Trial& t) const {
    const SampledWavelengths lambda = wavelengths_of(t.band);
    const ShadingPoint at{.lambda = lambda};
    const Vec3 wo = on_side(direction(t.theta_deg, kAzimuthRad), t.side);
    std::string line = fmt::format("{}\t{}\t{:g}\t{}\t{}", subject_.family, subject_.bsdf.name, t.theta_deg,
                                   t.side, t.band.name);
    double p_bins = 1, p_cells = 1, p_mass = 1, mass_error = 0;
    std::size_t below = 0;
    for (const int half : sides()) {
      const SamplingTestResult r = sampling(t, half, at);
      p_bins = std::min(p_bins, r.p_value_bins);
      p_cells = std::min(p_cells, r.p_value);
      if (r.kept > kLeastMass) p_mass = std::min(p_mass, r.p_value_kept);
      mass_error = std::max(mass_error, std::abs(r.integral - r.kept));
      below += r.below_horizon;
    }
    line += fmt::format("\t{:.3g}\t{:.3g}\t{:.3g}\t{:.2e}\t{}", p_bins, p_cells, p_mass, mass_error, below);
    return line + weights(t, wo, at) + jacobians(t, wo, at) + reciprocity(t, at) + "\n";
  }

  /// 99th percentiles of weight against value / density and of density against density; the energy and its
  /// standard deviation at the lane that reflects most.
  [[nodiscard]] std::string weights(const Trial& t, Vec3 wo, const ShadingPoint& at) const {
    TestRandom random(seed(t) + 1);
    Errors weight_errors, pdf_errors;
    std::array<double, kLanes> sum{}, sum2{};
    const int n = int(samples_ / 10);
    for (int i = 0; i < n; ++i) {
      const std::optional<BsdfSample> s = sample(material_, wo, random_numbers(random), at);
      if (!s) continue;
      for (int lane = 0; lane < kLanes; ++lane) {
        const Float nm = at.lambda.lambda_nm(lane);
        const double w = double(s->weight[lane]) * index_squared(s->wi, nm) / index_squared(wo, nm);
        sum[std::size_t(lane)] += w;
        sum2[std::size_t(lane)] += w * w;
      }
      if (s->is_delta || i >= kPairs) continue;
      const BsdfValue v = evaluate(material_, wo, s->wi, at);
      pdf_errors.add(relative_difference(double(v.pdf), double(s->pdf)));
      for (int lane = 0; lane < kLanes; ++lane)
        weight_errors.add(
            relative_difference(double(s->weight[lane]), double(v.value_cos[lane]) / double(v.pdf)));
    }
    double energy = 0, deviation = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double mean = sum[lane] / n;
      if (mean < energy) continue;
      energy = mean;
      deviation = std::sqrt(std::max(sum2[lane] / n - mean * mean, 0.0) / n);
    }
    return fmt::format("\t{:.2e}\t{:.2e}\t{:.5f}\t{:.1e}", weight_errors.percentile(0.99),
                       pdf_errors.percentile(0.99), energy, deviation);
  }

  /// Of the maps from random numbers to directions (sampled_jacobian.h): what the density lacks of a
  /// lobe's part (upper quartile), and, where there is but one lobe, the difference either way (median: at
  /// the edges of tables' cells the map has kinks).
  [[nodiscard]] std::string jacobians(const Trial& t, Vec3 wo, const ShadingPoint& at) const {
    constexpr int kPlaces = 400;
    TestRandom random(seed(t) + 2);
    Errors lacking, different;
    for (int i = 0; i < kPlaces; ++i) {
      const std::optional<LobeDensity> d = density_by_differences(material_, wo, random_numbers(random), at);
      if (!d) continue;
      const double ratio = d->share_of_numbers * d->density_of_map / d->pdf;
      lacking.add(std::max(ratio - 1, 0.0));
      if (d->share_of_numbers == 1) different.add(std::abs(ratio - 1));
    }
    return fmt::format("\t{:.2e}\t{:.2e}", lacking.percentile(0.75), different.percentile(0.5));
  }

  /// 99th percentile of f(wo, wi) against f(wi, wo) over random pairs; each incidence its own pairs.
  [[nodiscard]] std::string reciprocity(const Trial& t, const ShadingPoint& at) const {
    TestRandom random(seed(t) + 3);
    Errors errors;
    const auto any_side = [&](Vec3 w) {
      return keeps_sides(material_) && random.uniform() < Float(0.5) ? on_side(w, -1) : w;
    };
    for (int i = 0; i < kPairs; ++i) {
      const Vec3 a = any_side(random_direction(random)), b = any_side(random_direction(random));
      const SampledSpectrum ab = evaluate(material_, a, b, at).value_cos;
      const SampledSpectrum ba = evaluate(material_, b, a, at).value_cos;
      for (int lane = 0; lane < kLanes; ++lane) {
        const Float nm = at.lambda.lambda_nm(lane);
        errors.add(relative_difference(double(ab[lane]) / std::abs(double(b.z)) / index_squared(a, nm),
                                       double(ba[lane]) / std::abs(double(a.z)) / index_squared(b, nm)));
      }
    }
    return fmt::format("\t{:.2e}\t{}\t{}", errors.percentile(0.99), int(subject_.bsdf.is_reciprocal),
                       int(subject_.bsdf.conserves_energy));
  }

  static constexpr double kLeastMass = 1e-3;  // as in the default suite (sampling_test.cpp)
  const Subject& subject_;
  const Material& material_;
  double samples_;
};

std::set<std::string> names_in(const std::string& results) {
  std::set<std::string> names;
  std::ifstream in(results);
  for (std::string line; std::getline(in, line);) {
    const std::size_t first = line.find('\t'), second = line.find('\t', first + 1);
    if (second != std::string::npos) names.insert(line.substr(first + 1, second - first - 1));
  }
  return names;
}

int run(const std::string& results, double samples, const std::string& only) {
  const std::set<std::string> known = names_in(results);
  std::size_t done = 0, skipped = 0;
  for (const Subject& subject : validation_subjects()) {
    const std::string& name = subject.bsdf.name;
    if (known.contains(name) || name.find(only) == std::string::npos) continue;
    const std::optional<Material> material = subject.bsdf.make();
    if (!material) {
      ++skipped;
      std::cerr << "skipped: " << name << " (no data, or no separation)\n";
      continue;
    }
    std::ofstream out(results, std::ios::app);
    for (const std::string& line : SubjectTest(subject, *material, samples).run()) out << line;
    if (!out.flush()) {
      std::cerr << results << ": cannot be written\n";
      return 4;
    }
    ++done;
    std::cerr << name << "\n";
  }
  std::cerr << done << " BSDFs, " << skipped << " skipped\n";
  return 0;
}

}  // namespace
}  // namespace spectrace::test

int main(int count, char** arguments) {
  if (count < 2) {
    std::cerr << "full_statistics RESULTS [SAMPLES] [only names that contain this]\n";
    return 2;
  }
  return spectrace::test::run(arguments[1], count > 2 ? std::atof(arguments[2]) : 1e6,
                              count > 3 ? arguments[3] : "");
}
