// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "renderer/aovs.h"

namespace spectrace::cli {

/// --aovs NAME[,NAME...]; `fallback`: what holds where it is not given, as --help says it.
CLI::Option* add_aovs_option(CLI::App& command, std::optional<AovSet>& aovs, const std::string& fallback);

}  // namespace spectrace::cli
