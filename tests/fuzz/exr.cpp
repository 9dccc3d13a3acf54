// SPDX-License-Identifier: Apache-2.0
// EXR images, textures and environments among them.
#include "core/image/image.h"
#include "tests/fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spectrace;
  return test::accept_or_refuse(data, size, [](std::span<const std::byte> bytes) {
    constexpr std::size_t kMostPixels = 1 << 20;
    const test::InputFile file(bytes, ".exr");
    (void)read_image(file.path(), kMostPixels);
    (void)read_metadata(file.path());
  });
}
