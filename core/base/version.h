// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace spectrace {

/// "0.1.0": the project's version.
std::string_view version();
/// The git commit the program was built from, "-dirty" after it where files differed; "unknown" where the
/// source was no git checkout.
std::string_view commit();

}  // namespace spectrace
