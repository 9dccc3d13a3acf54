// SPDX-License-Identifier: Apache-2.0
// A microfacet normal distribution from backscattering, on the grid of the EPFL tables.
#pragma once

#include <functional>
#include <vector>

#include "core/math/vec.h"

namespace spectrace {

/// D(ωm) [1/sr] and its projected area σ(ω) = ∫ D(ωm) max(0, ω·ωm) dωm, σ = 1 at the normal, at the nodes of
/// the unit square (materials/normal_square.h): [height: azimuth][width: elevation].
struct NormalDistribution {
  int width = 0, height = 0;
  std::vector<float> ndf, sigma;
};

/// f(ω, ω) cosθ [1/sr] of a direction above the horizon.
using Backscatter = std::function<double(Vec3)>;

/// Solves D(ω) ∝ f(ω, ω) cosθ σ(ω) by power iteration: Dupuy & Jakob 2018, sec. 5.1. `height` = 2 asks for an
/// isotropic distribution, measured at azimuth 0. A backscatter of zeros gives an ndf of zeros.
NormalDistribution ndf_from_backscatter(const Backscatter& backscatter, int width, int height);

}  // namespace spectrace
