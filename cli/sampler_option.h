// SPDX-License-Identifier: Apache-2.0
// --sampler, of commands that render.
#pragma once

#include <optional>

#include "cli/command.h"
#include "core/math/sampler.h"

namespace spectrace::cli {

void add_sampler_option(CLI::App& app, std::optional<SamplerKind>& sampler);

}  // namespace spectrace::cli
