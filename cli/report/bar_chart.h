// SPDX-License-Identifier: Apache-2.0
// Grouped bars as SVG.
#pragma once

#include <string>
#include <vector>

namespace spectrace::cli {

struct BarSeries {
  std::string name;
  std::vector<double> values;  ///< one a group; not finite: no bar
};

struct BarChart {
  std::string title, unit;
  std::vector<std::string> groups;
  std::vector<BarSeries> series;
};

/// Stands alone as a file and inside HTML; each bar tells its value where the pointer rests.
std::string svg(const BarChart& chart);

/// Text as HTML and SVG hold it: &, <, > and " escaped.
std::string escaped(const std::string& text);

}  // namespace spectrace::cli
