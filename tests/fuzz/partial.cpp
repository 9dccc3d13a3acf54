// SPDX-License-Identifier: Apache-2.0
// Checkpoints and parts of images.
#include "renderer/partial_render.h"
#include "tests/fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spectrace;
  return test::accept_or_refuse(data, size, [](std::span<const std::byte> bytes) {
    (void)read_partial(test::InputFile(bytes, ".partial").path());
  });
}
