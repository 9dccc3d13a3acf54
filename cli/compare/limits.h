// SPDX-License-Identifier: Apache-2.0
// What a comparison must keep to: limits of metrics, from the command line or from a file.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/image/metrics.h"
#include "core/image/z_test.h"

namespace spectrace::cli {

struct MetricName {
  const char* name;
  double Metrics::*field;
};
inline constexpr std::array<MetricName, 7> kMetricNames{{{"psnr", &Metrics::psnr_db},
                                                         {"ssim", &Metrics::ssim},
                                                         {"mape", &Metrics::mape},
                                                         {"relmse", &Metrics::rel_mse},
                                                         {"mse", &Metrics::mse},
                                                         {"mae", &Metrics::mae},
                                                         {"maxabs", &Metrics::max_abs}}};

/// In place of a layer: all that are compared.
inline constexpr const char* kEveryLayer = "*";

struct Limit {
  std::string layer;  ///< empty: the layers of --layer, without --layer the beauty
  const MetricName* metric = nullptr;
  bool is_max = true;
  double value = 0;

  /// A metric that could not be computed (NaN) is within no limit.
  [[nodiscard]] bool holds(double x) const { return is_max ? x <= value : x >= value; }
  [[nodiscard]] std::string text() const;  ///< "mse <= 0.1"
};

/// "relmse=1e-3", "specular.relmse=1e-3", "*.relmse=1e-3"; anything else is a usage error of --max or --min.
Limit parse_limit(const std::string& text, bool is_max);

/// What is absent in the file is left to the command line.
struct LimitsFile {
  std::vector<Limit> limits;
  std::optional<double> data_range, epsilon, mape_floor;
  std::optional<ZTestOptions> z_test;
};
/// docs/compare.md has the format. Throws InputError with all mistakes of the file.
LimitsFile read_limits(const std::filesystem::path& file);

}  // namespace spectrace::cli
