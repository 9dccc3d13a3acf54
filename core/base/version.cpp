// SPDX-License-Identifier: Apache-2.0
#include "core/base/version.h"

#include "spectrace_commit.h"

namespace spectrace {

std::string_view version() { return SPECTRACE_VERSION; }
std::string_view commit() { return SPECTRACE_COMMIT; }

}  // namespace spectrace
