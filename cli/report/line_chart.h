// SPDX-License-Identifier: Apache-2.0
// Curves over two logarithmic axes.
#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"

namespace spectrace::cli {

struct CurvePoint {
  double x = 0, y = 0;  ///< > 0 to be drawn
  std::string label;    ///< told where the pointer rests
};

struct Curve {
  std::string name;
  std::vector<CurvePoint> points;  ///< by x; what was measured, drawn as dots
  std::vector<CurvePoint> line;    ///< by x; what was fitted, drawn as a line
};

struct LineChart {
  std::string title, x_title, y_title;
  std::vector<Curve> curves;
};

/// Stands alone as a file and inside HTML.
std::string svg(const LineChart& chart);
/// The same as pixels, for what shows no SVG: R, G, B.
Image picture(const LineChart& chart);

}  // namespace spectrace::cli
