// SPDX-License-Identifier: Apache-2.0
// Files of other instruments' layouts, made from a BRDF that a test knows.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/math/vec.h"

namespace spectrace::test {

/// wo, wi -> f in the three channels [1/sr].
using RgbBrdf = std::function<std::array<double, 3>(Vec3, Vec3)>;
/// A MERL `.binary`; bins whose directions lie below the horizon are marked invalid.
std::vector<std::byte> merl_file(const RgbBrdf& brdf);

/// wo, wi, wavelength [nm] -> f [1/sr].
using SpectralBrdf = std::function<double(Vec3, Vec3, double)>;
/// Cornell's scattered text, `count` random pairs of directions at the wavelengths given.
std::string scattered_text(const SpectralBrdf& brdf, int count, const std::vector<double>& lambda_nm);

}  // namespace spectrace::test
