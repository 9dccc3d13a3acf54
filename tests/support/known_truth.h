// SPDX-License-Identifier: Apache-2.0
// Materials whose diffuse colour is known, measured by the virtual goniophotometer and separated.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "materials/acquisition.h"
#include "separation/separate.h"

namespace spectrace::test {

struct KnownMaterial {
  const char* name;  ///< in scenes/materials
  bool has_diffuse;
  /// Met on the database's grid too, not only on a fine one. eggshell_yellow is not: its lobe of alpha 0.6 is
  /// so nearly Lambertian that the errors of that grid, 1 to 4 %, are larger than what tells the two apart
  /// (docs/separation.md).
  bool on_coarse_grid = true;
};
inline constexpr std::array kKnownMaterials{
    KnownMaterial{"matte", true},
    KnownMaterial{"soot", true},
    KnownMaterial{"glossy", true},
    KnownMaterial{"lacquer_green", true},
    KnownMaterial{"enamel_white", true},
    KnownMaterial{"satin_red", true},
    KnownMaterial{"rubber_dark", true},
    KnownMaterial{.name = "eggshell_yellow", .has_diffuse = true, .on_coarse_grid = false},
    KnownMaterial{"metallic_blue", true},
    KnownMaterial{"pearlescent", true},
    KnownMaterial{"film_copper", true},
    KnownMaterial{"diffractive_flakes", true},
    KnownMaterial{"diffractive_metal", false},
    KnownMaterial{"gold", false}};

/// 24 elevations, tables of 96 x 96: the error of the measurement itself is then below a tenth of a percent.
AcquisitionOptions fine_acquisition();

/// Mean of |c_d / true c_d - 1| over the wavelengths at which at least a tenth of the reflected light is
/// diffuse; of a material without a diffuse lobe the largest c_d.
double recovery_error(const KnownMaterial& known, const AcquisitionOptions& acquisition,
                      const SeparationOptions& separation);

/// Fails the test where that error is 2 % or more, or a missing lobe is found; prints it too.
void expect_recovered(const KnownMaterial& known, const AcquisitionOptions& acquisition,
                      const SeparationOptions& separation);

}  // namespace spectrace::test
