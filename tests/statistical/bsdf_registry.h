// SPDX-License-Identifier: Apache-2.0
// Every BSDF of the program that is not a delta distribution, by name: what the conformance suite runs over.
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
  /// Its value at theta_h = 0 does not depend on the side it is approached from. Measured tables do not
  /// promise it: their nodes at theta_h = 0 were measured one by one, at all azimuths.
  bool is_smooth_at_specular = false;

  friend std::ostream& operator<<(std::ostream& out, const BsdfCase& c) { return out << c.name; }
};

const std::vector<BsdfCase>& bsdf_cases();

/// Four wavelengths [nm] over the visible, each of density 1.
const SampledWavelengths& test_wavelengths();

}  // namespace spectrace::test
