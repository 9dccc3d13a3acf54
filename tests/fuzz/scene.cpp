// SPDX-License-Identifier: Apache-2.0
// Scenes: the JSON, and what is built of one that names no file.
#include "renderer/scene.h"

#include "core/base/progress.h"
#include "tests/fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spectrace;
  return test::accept_or_refuse(data, size, [](std::span<const std::byte> bytes) {
    SilentProgress progress;
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    (void)build_scene(parse_scene(text, "input.json"), progress);
  });
}
