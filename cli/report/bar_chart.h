// SPDX-License-Identifier: Apache-2.0
// Grouped bars.
#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"

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
/// The same as pixels, for what shows no SVG: R, G, B.
Image picture(const BarChart& chart);

}  // namespace spectrace::cli
