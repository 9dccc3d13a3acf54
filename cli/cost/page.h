// SPDX-License-Identifier: Apache-2.0
// A cost study to look at: one page that needs no network and no other file.
#pragma once

#include <string>

#include "cli/cost/measurement.h"

namespace spectrace::cli {

[[nodiscard]] std::string cost_page(const CostStudy& study);

}  // namespace spectrace::cli
