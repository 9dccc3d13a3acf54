// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace spectrace {

/// While it lives, this thread flushes denormal numbers to zero, as Embree asks of its callers.
class FlushDenormals {
 public:
  FlushDenormals();
  ~FlushDenormals();
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

}  // namespace spectrace
