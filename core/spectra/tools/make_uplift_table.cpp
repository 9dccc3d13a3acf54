// SPDX-License-Identifier: Apache-2.0
// Run while building: writes the table of uplift_reflectance_fast() to the file named by its one argument.
#include <cstdio>
#include <exception>
#include <fstream>
#include <vector>

#include "core/spectra/uplift_table.h"

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_uplift_table OUTPUT\n");
    return 2;
  }
  const std::vector<float> table = spectrace::UpliftTable::build();
  std::ofstream out(argv[1], std::ios::binary);
  out.write(reinterpret_cast<const char*>(table.data()),
            static_cast<std::streamsize>(table.size() * sizeof(float)));
  out.close();
  if (!out) {
    std::fprintf(stderr, "%s: cannot be written\n", argv[1]);
    return 3;
  }
  return 0;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 4;
}
