// SPDX-License-Identifier: Apache-2.0
#include "core/spectra/spectrum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "core/base/error.h"
#include "core/base/wide.h"
#include "core/math/math.h"
#include "core/math/piecewise_linear.h"
#include "core/spectra/cie_tables.h"
#include "core/spectra/color.h"
#include "core/spectra/sigmoid_fit.h"

namespace spectrace {
namespace {

/// D65 over its luminance, in the light path's own type: white of Y = 1.
class WhiteD65 {
 public:
  static const WhiteD65& table() {
    static const WhiteD65 made;
    return made;
  }
  /// As illuminant_d65(): linear between the samples, the end values outside.
  [[nodiscard]] Float at(Float lambda_nm) const {
    const Float position = clamped((lambda_nm - kD65MinNm) * (Float(1) / kD65StepNm), Float(0), kLast);
    const auto i = static_cast<std::int32_t>(position);
    const auto k = static_cast<std::size_t>(i);
    return nodes_[k] + (position - Float(i)) * (nodes_[k + 1] - nodes_[k]);
  }
  /// The same of all lanes: all but the fetching is work of whole registers.
  [[nodiscard]] SampledSpectrum sample(const SampledWavelengths& lambda) const {
    const SampledSpectrum position = lambda.map(
        [](Float nm) { return clamped((nm - kD65MinNm) * (Float(1) / kD65StepNm), Float(0), kLast); });
    SampledSpectrum whole, below, above;
    for (int lane = 0; lane < kLanes; ++lane) {
      const auto i = static_cast<std::int32_t>(position[lane]);
      whole[lane] = Float(i);
      below[lane] = nodes_[static_cast<std::size_t>(i)];
      above[lane] = nodes_[static_cast<std::size_t>(i) + 1];
    }
    return below + (position - whole) * (above - below);
  }

 private:
  static constexpr auto kLast = Float(kD65Samples - 1);
  WhiteD65() {
    for (std::size_t i = 0; i < kD65Samples; ++i) {
      nodes_[i] = static_cast<Float>(kD65[i] / 100 / d65_luminance());
    }
    nodes_[kD65Samples] = nodes_[kD65Samples - 1];
  }
  std::array<Float, kD65Samples + 1> nodes_{};  // the last twice: no cell ends beyond
};

// Steps that differ by less count as equal: wavelengths written with three decimals at 0.5 nm steps. The cell
// found is then off by at most one node's rounding, which the clamp in at() absorbs.
constexpr double kEqualStepTolerance = 1e-3;

Float step_inverse(const std::vector<Float>& lambda_nm) {
  if (lambda_nm.size() < 2) return 0;
  const auto cells = double(lambda_nm.size() - 1);
  const double step_nm = (double(lambda_nm.back()) - double(lambda_nm.front())) / cells;
  for (std::size_t i = 0; i < lambda_nm.size(); ++i) {
    const double expected = lambda_nm.front() + step_nm * double(i);
    if (std::abs(lambda_nm[i] - expected) > kEqualStepTolerance * step_nm) return 0;
  }
  return static_cast<Float>(1 / step_nm);
}

bool all_equal(std::span<const Float> values) {
  return std::all_of(values.begin(), values.end(), [&](Float x) { return x == values.front(); });
}

}  // namespace

TabulatedSpectrum::TabulatedSpectrum(std::vector<Float> lambda_nm, std::vector<Float> values)
    : lambda_nm_(std::move(lambda_nm)), values_(std::move(values)) {
  SPECTRACE_CHECK(!lambda_nm_.empty() && lambda_nm_.size() == values_.size());
  const auto finite = [](Float x) { return std::isfinite(x); };
  SPECTRACE_CHECK(std::all_of(lambda_nm_.begin(), lambda_nm_.end(), finite));
  SPECTRACE_CHECK(std::all_of(values_.begin(), values_.end(), finite));
  SPECTRACE_CHECK(std::adjacent_find(lambda_nm_.begin(), lambda_nm_.end(), std::greater_equal<>()) ==
                  lambda_nm_.end());
  inverse_step_per_nm_ = step_inverse(lambda_nm_);
}

Float TabulatedSpectrum::at(Float lambda_nm) const {
  if (!(lambda_nm > lambda_nm_.front())) return values_.front();
  if (lambda_nm >= lambda_nm_.back()) return values_.back();
  const auto above = std::upper_bound(lambda_nm_.begin(), lambda_nm_.end(), lambda_nm);
  const auto i = static_cast<std::size_t>(above - lambda_nm_.begin()) - 1;
  const Float t = (lambda_nm - lambda_nm_[i]) / (lambda_nm_[i + 1] - lambda_nm_[i]);
  return lerp(values_[i], values_[i + 1], clamped(t, Float(0), Float(1)));
}

SPECTRACE_WIDE SampledSpectrum TabulatedSpectrum::sample(const SampledWavelengths& lambda) const {
  if (!(inverse_step_per_nm_ > 0)) return lambda.map([this](Float nm) { return at(nm); });
  const Float last_cell = Float(lambda_nm_.size() - 2), begin_nm = lambda_nm_.front();
  return lambda.map([nodes = lambda_nm_.data(), values = values_.data(), per_nm = inverse_step_per_nm_,
                     last_cell, begin_nm](Float nm) {
    const auto i = static_cast<std::int32_t>(clamped((nm - begin_nm) * per_nm, Float(0), last_cell));
    const Float t = clamped((nm - nodes[i]) / (nodes[i + 1] - nodes[i]), Float(0), Float(1));
    return lerp(values[i], values[i + 1], t);
  });
}

Float BlackbodySpectrum::at(Float lambda_nm) const {
  // CODATA 2018, exact: 2 h c² [W·m²·sr⁻¹] and h c / k [m·K].
  constexpr double kTwoHcSquared = 1.191042972397188e-16, kHcOverK = 1.438776877503934e-2;
  const double lambda_m = double(lambda_nm) * 1e-9;
  if (!(lambda_m > 0) || !(kelvin > 0)) return 0;
  const double per_m =
      kTwoHcSquared / (std::pow(lambda_m, 5) * std::expm1(kHcOverK / (lambda_m * double(kelvin))));
  return static_cast<Float>(double(scale) * per_m * 1e-9);
}

Float SigmoidSpectrum::at(Float lambda_nm) const {
  const Float t = (lambda_nm - kCenterNm) * (1 / kHalfWidthNm);
  const Float x = (c[0] * t + c[1]) * t + c[2];
  return scale * sigmoid(x);
}

SPECTRACE_WIDE SampledSpectrum SigmoidSpectrum::sample(const SampledWavelengths& lambda) const {
  return lambda.map([s = *this](Float nm) { return s.at(nm); });
}

Float RgbIlluminantSpectrum::at(Float lambda_nm) const {
  return sigmoid.at(lambda_nm) * WhiteD65::table().at(lambda_nm);
}

SPECTRACE_WIDE SampledSpectrum RgbIlluminantSpectrum::sample(const SampledWavelengths& lambda) const {
  const SampledSpectrum colour = lambda.map([s = sigmoid](Float nm) { return s.at(nm); });
  return colour * WhiteD65::table().sample(lambda);
}

Float SellmeierSpectrum::at(Float lambda_nm) const {
  const double square_um2 = sqr(double(lambda_nm) * 1e-3);
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += double(b[i]) * square_um2 / (square_um2 - double(c_um2[i]));
  const double n = std::isfinite(sum) ? std::sqrt(1 + std::max(sum, 0.0)) : 1.0;
  return static_cast<Float>(double(scale) * n);
}

Float CauchySpectrum::at(Float lambda_nm) const {
  const double inverse_square = 1 / sqr(double(lambda_nm) * 1e-3);
  const double n = double(a) + (double(b_um2) + double(c_um4) * inverse_square) * inverse_square;
  return static_cast<Float>(double(scale) * n);
}

Float Spectrum::at(Float lambda_nm) const {
  return std::visit([&](const auto& s) { return s.at(lambda_nm); }, v_);
}

SampledSpectrum Spectrum::sample(const SampledWavelengths& lambda) const {
  return std::visit(
      [&](const auto& s) {
        if constexpr (requires { s.sample(lambda); }) {
          return s.sample(lambda);
        } else {
          return lambda.map([s](Float nm) { return s.at(nm); });
        }
      },
      v_);
}

bool Spectrum::is_constant() const {
  if (std::holds_alternative<ConstantSpectrum>(v_)) return true;
  if (const auto* t = std::get_if<TabulatedSpectrum>(&v_)) return all_equal(t->values());
  if (const auto* s = std::get_if<SigmoidSpectrum>(&v_))
    return s->scale == 0 || (s->c[0] == 0 && s->c[1] == 0);
  if (const auto* s = std::get_if<SellmeierSpectrum>(&v_))
    return s->scale == 0 || s->b == std::array<Float, 3>{};
  if (const auto* s = std::get_if<CauchySpectrum>(&v_))
    return s->scale == 0 || (s->b_um2 == 0 && s->c_um4 == 0);
  return false;
}

Float Spectrum::max_over(WavelengthRange range) const {
  Float largest = std::max(at(range.min_nm), at(range.max_nm));
  // Whole nanometres: the kinks of D65 lie among them.
  for (int nm = static_cast<int>(std::ceil(range.min_nm)); nm < range.max_nm; ++nm) {
    largest = std::max(largest, at(static_cast<Float>(nm)));
  }
  if (const auto* t = std::get_if<TabulatedSpectrum>(&v_)) {  // peaks between them: its own nodes
    for (std::size_t i = 0; i < t->values().size(); ++i) {
      const Float nm = t->lambda_nm()[i];
      if (nm >= range.min_nm && nm <= range.max_nm) largest = std::max(largest, t->values()[i]);
    }
  }
  return largest;
}

Spectrum Spectrum::scaled(Float factor) const {
  return std::visit(
      [&](auto s) -> Spectrum {
        using Kind = decltype(s);
        if constexpr (std::is_same_v<Kind, ConstantSpectrum>) {
          return ConstantSpectrum{s.value * factor};
        } else if constexpr (std::is_same_v<Kind, TabulatedSpectrum>) {
          std::vector<Float> values(s.values().begin(), s.values().end());
          for (Float& x : values) x *= factor;
          return TabulatedSpectrum({s.lambda_nm().begin(), s.lambda_nm().end()}, std::move(values));
        } else if constexpr (std::is_same_v<Kind, RgbIlluminantSpectrum>) {
          s.sigmoid.scale *= factor;
          return s;
        } else {
          s.scale *= factor;
          return s;
        }
      },
      v_);
}

}  // namespace spectrace
