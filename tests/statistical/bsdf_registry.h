// SPDX-License-Identifier: Apache-2.0
// Every BSDF of the program that is not a delta distribution alone, by name: what the conformance suite runs
// over.
#pragma once

#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "materials/material.h"

namespace spectrace::test {

struct BsdfCase {
  std::string name;
  /// Nothing where the shared data it needs is absent.
  std::function<std::optional<Material>()> make;
  bool is_reciprocal = false;
  bool conserves_energy = false;
  /// How much its value may change between theta_h = 0 and 1e-6 rad beside it, relative, to any side (hard
  /// case H5). Measured tables promise nothing: their nodes at theta_h = 0 were measured one by one, at all
  /// azimuths.
  std::optional<double> specular_step = std::nullopt;
  /// Index of what lies behind the surface, over that before it.
  Spectrum interior_eta = Spectrum::constant(1);
  bool is_two_sided = false;  ///< keeps_sides() of what it makes

  friend std::ostream& operator<<(std::ostream& out, const BsdfCase& c) { return out << c.name; }
};

const std::vector<BsdfCase>& bsdf_cases();

/// Four wavelengths [nm] over the visible, each of density 1.
const SampledWavelengths& test_wavelengths();

}  // namespace spectrace::test
