// SPDX-License-Identifier: Apache-2.0
// Measurements: the EPFL layout, Cornell's scattered text, MERL's binary, told apart by content; and what is
// built of them.
#include "materials/measured_brdf.h"
#include "materials/measured_tables.h"
#include "tests/fuzz/fuzz_target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace spectrace;
  return test::accept_or_refuse(data, size, [](std::span<const std::byte> bytes) {
    const MeasuredBrdf brdf(measured_from_bytes(bytes, "input.bsdf"));
  });
}
