// SPDX-License-Identifier: Apache-2.0
// Cornell's and MERL's formats by their extensions: what a .bsdf's content never reaches.
#include "materials/measured_tables.h"
#include "tests/fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spectrace;
  return test::accept_or_refuse(data, size, [](std::span<const std::byte> bytes) {
    for (const char* name : {"input.brdf", "input.binary"}) {
      test::accept_or_refuse(
          reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(),
          [&](std::span<const std::byte> again) { (void)measured_from_bytes(again, name); });
    }
  });
}
