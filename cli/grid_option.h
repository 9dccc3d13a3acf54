// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "materials/half_difference_grid.h"

namespace spectrace::cli {

/// `--grid 90x90x180`: nodes over theta_h, theta_d and phi_d, into `grid`, which holds the default and must
/// outlive `command`.
void add_grid_option(CLI::App& command, HalfDifferenceGrid& grid);

}  // namespace spectrace::cli
