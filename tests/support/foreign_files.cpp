// SPDX-License-Identifier: Apache-2.0
#include "tests/support/foreign_files.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#include "core/math/math.h"
#include "materials/half_difference.h"
#include "tests/support/chi_square.h"

namespace spectrace::test {

std::vector<std::byte> merl_file(const RgbBrdf& brdf) {
  // The format as its documentation has it, not by the reader's own grid.
  constexpr std::array<std::int32_t, 3> kDimensions{90, 90, 180};
  constexpr std::array kScale{1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
  constexpr std::size_t kBins = std::size_t(90) * 90 * 180;
  std::vector<double> values(3 * kBins, -1);
  std::size_t bin = 0;
  for (int h = 0; h < 90; ++h) {
    for (int d = 0; d < 90; ++d) {
      for (int p = 0; p < 180; ++p, ++bin) {
        const double degree = kPi64 / 180;
        const DirectionPair pair = from_half_difference({h * h / 90.0 * degree, d * degree, p * degree});
        if (!(pair.wo.z > 0 && pair.wi.z > 0)) continue;
        const std::array<double, 3> f = brdf(pair.wo, pair.wi);
        for (std::size_t c = 0; c < 3; ++c) values[c * kBins + bin] = f[c] / kScale[c];
      }
    }
  }
  std::vector<std::byte> bytes(sizeof(kDimensions) + values.size() * sizeof(double));
  std::memcpy(bytes.data(), kDimensions.data(), sizeof(kDimensions));
  std::memcpy(bytes.data() + sizeof(kDimensions), values.data(), values.size() * sizeof(double));
  return bytes;
}

std::string scattered_text(const SpectralBrdf& brdf, int count, const std::vector<double>& lambda_nm) {
  std::string text = fmt::format("# made by a test\n\n# num wls\n{}\n\n# wls\n{}\n\n# theta i ...\n",
                                 lambda_nm.size(), fmt::join(lambda_nm, " "));
  TestRandom random(29);
  for (int i = 0; i < count; ++i) {
    const double theta_i = 1.4 * double(random.uniform()), theta_o = 1.4 * double(random.uniform()),
                 phi = 2 * kPi64 * (double(random.uniform()) - 0.5);
    const Vec3 wi{Float(std::sin(theta_i)), 0, Float(std::cos(theta_i))};
    const Vec3 wo{Float(std::sin(theta_o) * std::cos(phi)), Float(std::sin(theta_o) * std::sin(phi)),
                  Float(std::cos(theta_o))};
    text += fmt::format("{:.6f} 0.000000 {:.6f} {:.6f}", theta_i, theta_o, phi);
    for (const double lambda : lambda_nm) text += fmt::format(" {:.6f}", brdf(wo, wi, lambda));
    text += '\n';
  }
  return text;
}

}  // namespace spectrace::test
