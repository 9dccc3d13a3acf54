// SPDX-License-Identifier: Apache-2.0
// Separated materials made by formula, for tests of everything that reads them.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "core/math/math.h"
#include "materials/separated_tables.h"

namespace spectrace::test {

struct SyntheticSeparated {
  HalfDifferenceGrid grid{};
  double albedo_d = 0.3;  ///< 0: no diffuse lobe
  double rho_0 = 0.4;     ///< 0: no specular lobe
  double alpha = 0.2;     ///< GGX roughness
};

/// Lambert + GGX without Fresnel, over eight wavelengths. The three models differ: s_fresnel turns with
/// theta_d, s_diffraction with theta_h too. rho_s depends on phi_d a little, so that no test passes by
/// ignoring it.
inline std::shared_ptr<SeparatedTables> synthetic_separated(const SyntheticSeparated& m = {}) {
  auto tables = std::make_shared<SeparatedTables>();
  tables->grid = m.grid;
  tables->axis = SpectralAxis::wavelengths({400, 450, 500, 550, 600, 650, 700, 750});
  const std::size_t n = tables->axis.size();
  const double a2 = m.alpha * m.alpha;
  const auto colour = [&](std::size_t k, double phase) {
    return 0.6 + 0.4 * std::sin(0.8 * double(k) + phase);
  };

  for (std::size_t k = 0; k < n; ++k) {
    tables->c_d.push_back(static_cast<float>(m.albedo_d * colour(k, 2)));
    tables->s_sun.push_back(static_cast<float>(colour(k, 0)));
  }
  for (int d = 0; d < m.grid.n_theta_d; ++d) {
    for (std::size_t k = 0; k < n; ++k)
      tables->s_fresnel.push_back(static_cast<float>(colour(k, m.grid.theta_d(d))));
  }
  for (int h = 0; h < m.grid.n_theta_h; ++h) {
    const double cos_h = std::cos(m.grid.theta_h(h));
    const double t = a2 * cos_h * cos_h + 1 - cos_h * cos_h;
    for (int d = 0; d < m.grid.n_theta_d; ++d) {
      for (std::size_t k = 0; k < n; ++k) {
        tables->s_diffraction.push_back(
            static_cast<float>(colour(k, m.grid.theta_d(d) + 3 * m.grid.theta_h(h))));
      }
      for (int p = 0; p < m.grid.n_phi_d; ++p) {
        const double ripple = 1 + 0.5 * (1 - cos_h) * m.grid.theta_d(d) * std::cos(2 * m.grid.phi_d(p));
        tables->rho_s.push_back(static_cast<float>(m.rho_0 * ripple * a2 / (kPi64 * t * t) / 2));
      }
    }
  }
  return tables;
}

}  // namespace spectrace::test
