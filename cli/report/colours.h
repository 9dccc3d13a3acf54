// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace spectrace::cli {

/// Of series in a chart: told apart by the colour-blind too, and in grey (Okabe & Ito 2008).
inline constexpr std::array<std::string_view, 6> kSeriesColours{"#999999", "#56b4e9", "#e69f00",
                                                                "#009e73", "#cc79a7", "#0072b2"};

}  // namespace spectrace::cli
