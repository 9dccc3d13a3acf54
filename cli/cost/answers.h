// SPDX-License-Identifier: Apache-2.0
// What one reads off the measured settings.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "cli/cost/measurement.h"

namespace spectrace::cli {

/// A setting, and what the fits say of it.
struct Answer {
  double rel_mse = 0;
  const CostRecord* record = nullptr;
  double samples = 0, seconds = 0;
};

/// The setting that reaches an error soonest, by the fits; none where no setting reaches it.
[[nodiscard]] std::optional<Answer> cheapest(const CostStudy& study, double rel_mse);

/// The setting that comes nearest in so many seconds, by the fits; never one that has no time for a sample,
/// so there may be none.
[[nodiscard]] std::optional<Answer> best_within(const CostStudy& study, double seconds);

/// The root of the bias in relMSE [%], or what it lies below where it cannot be told from none: "< 0.3".
[[nodiscard]] std::string bias_text(const Estimate& bias);

/// Round errors from what the fewest samples have to what the reference can tell.
[[nodiscard]] std::vector<double> errors_to_ask_for(const CostStudy& study);

/// A measured render that no other beats in both time and error.
struct FrontPoint {
  const CostRecord* record = nullptr;
  const CostPoint* point = nullptr;
};
/// By time.
[[nodiscard]] std::vector<FrontPoint> pareto_front(const CostStudy& study);

}  // namespace spectrace::cli
