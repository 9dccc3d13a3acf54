// SPDX-License-Identifier: Apache-2.0
#include "tests/cli/program.h"

#include <algorithm>

#include "materials/measured_tables.h"
#include "tests/support/synthetic_measured.h"

namespace spectrace::test {

void Program::write_measured(const std::string& name) const {
  measured_to_tensors(make_measured({})).write(folder_ / name);
}

std::vector<std::string> Program::names() const {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
    all.push_back(std::filesystem::relative(entry.path(), folder_.path()).string());
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace spectrace::test
