// SPDX-License-Identifier: Apache-2.0
// The table lies in its own source so that the tool which makes it need not contain it.
#include "core/spectra/uplift_table.h"

extern "C" const float spectrace_uplift_table[];  // from uplift_table.S, generated (core/CMakeLists.txt)

namespace spectrace {

const UpliftTable& UpliftTable::built_in() {
  static const UpliftTable table({spectrace_uplift_table, kFloats});
  return table;
}

}  // namespace spectrace
