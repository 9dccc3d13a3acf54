// SPDX-License-Identifier: Apache-2.0
#include "cli/aovs_option.h"

#include <vector>

namespace spectrace::cli {

CLI::Option* add_aovs_option(CLI::App& command, std::optional<AovSet>& aovs, const std::string& fallback) {
  const auto read = [&aovs](const std::vector<std::string>& names) {
    aovs = kNoAovs;
    for (const std::string& name : names) {
      if (const auto problem = add_aov(name, *aovs)) throw CLI::ValidationError("--aovs", *problem);
    }
  };
  return command
      .add_option_function<std::vector<std::string>>("--aovs", read,
                                                     "what the image holds beside its beauty: none, lobes, "
                                                     "denoise, all, or names (docs/aovs.md); default: " +
                                                         fallback)
      ->delimiter(',');
}

}  // namespace spectrace::cli
