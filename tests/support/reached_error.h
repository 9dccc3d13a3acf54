// SPDX-License-Identifier: Apache-2.0
// The error that a render has which was to stop at one.
#pragma once

#include <cstdint>
#include <string>

namespace spectrace::test {

struct ReachedError {
  double relative_error = 0;  ///< against a long render; what that is off by itself is taken out
  std::uint64_t samples = 0;
};

/// A scene of `scenes/`, in 48 x 48 pixels, until it has this relative error by its halves.
ReachedError render_until(const std::string& scene, double relative_error);

}  // namespace spectrace::test
