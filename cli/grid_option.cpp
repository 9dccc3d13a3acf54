// SPDX-License-Identifier: Apache-2.0
#include "cli/grid_option.h"

#include <fmt/format.h>

#include <charconv>
#include <string>
#include <system_error>

#include "separation/separate.h"

namespace spectrace::cli {
namespace {

/// "90x90x180": nodes over theta_h, theta_d and phi_d.
std::string text_of(const HalfDifferenceGrid& grid) {
  return fmt::format("{}x{}x{}", grid.n_theta_h, grid.n_theta_d, grid.n_phi_d);
}

/// The same read back. Throws CLI::ValidationError.
HalfDifferenceGrid grid_named(const std::string& text) {
  HalfDifferenceGrid grid;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int* const nodes : {&grid.n_theta_h, &grid.n_theta_d, &grid.n_phi_d}) {
    const auto [next, error] = std::from_chars(at, end, *nodes);
    const bool is_followed = nodes == &grid.n_phi_d ? next == end : next != end && *next == 'x';
    if (error != std::errc() || !is_followed) {
      throw CLI::ValidationError("--grid", "expected three numbers such as " + text_of({}));
    }
    at = next == end ? end : next + 1;
  }
  if (const std::string problem = SeparationOptions{.grid = grid}.problem(); !problem.empty()) {
    throw CLI::ValidationError("--grid", problem);
  }
  return grid;
}

}  // namespace

void add_grid_option(CLI::App& command, HalfDifferenceGrid& grid) {
  command
      .add_option_function<std::string>(
          "--grid",
          [&grid](const std::string& text) {
            const bool quadratic = grid.quadratic_theta_h;
            grid = grid_named(text);
            grid.quadratic_theta_h = quadratic;
          },
          "nodes over theta_h, theta_d and phi_d of the tables that separation makes; default: the paper's")
      ->type_name("HxDxP")
      ->default_str(text_of(grid));
}

}  // namespace spectrace::cli
