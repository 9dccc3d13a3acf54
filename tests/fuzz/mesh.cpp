// SPDX-License-Identifier: Apache-2.0
// PLY and OBJ meshes.
#include <algorithm>
#include <string_view>

#include "renderer/obj_file.h"
#include "renderer/ply_file.h"
#include "tests/fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spectrace;
  return test::accept_or_refuse(data, size, [](std::span<const std::byte> bytes) {
    const std::string_view magic(reinterpret_cast<const char*>(bytes.data()),
                                 std::min<std::size_t>(3, bytes.size()));
    if (magic == "ply") {
      (void)read_ply(test::InputFile(bytes, ".ply").path());
    } else {
      (void)read_obj(test::InputFile(bytes, ".obj").path());
    }
  });
}
