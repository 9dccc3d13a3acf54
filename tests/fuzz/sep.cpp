// SPDX-License-Identifier: Apache-2.0
// Separated materials, plain and compact.
#include "materials/separated_lookup.h"
#include "materials/tensor_file.h"
#include "tests/fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spectrace;
  return test::accept_or_refuse(data, size, [](std::span<const std::byte> bytes) {
    (void)separated_source(TensorFile::parse(bytes, "input.sep"));
  });
}
