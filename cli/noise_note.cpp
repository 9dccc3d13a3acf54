// SPDX-License-Identifier: Apache-2.0
#include "cli/noise_note.h"

#include <fmt/format.h>

#include <cstdint>

namespace spectrace::cli {

std::string noise_note(const Metadata& of_reference, const Metadata& of_test) {
  if (!of_reference.contains("spectrace:seed") || !of_test.contains("spectrace:seed")) return {};
  for (const char* key : {"spectrace:seed", "spectrace:spp"}) {
    const auto in_reference = of_reference.find(key), in_test = of_test.find(key);
    if (in_test == of_test.end() || in_reference == of_reference.end()) return {};
    if (in_reference->second != in_test->second) {
      return fmt::format("{} differs between the pictures: their noise is part of these figures", key);
    }
  }
  const auto is_paired = [](const Metadata& metadata) {
    const auto paired = metadata.find("spectrace:paired");
    return paired != metadata.end() && paired->second == decltype(paired->second)(std::int64_t(1));
  };
  if (is_paired(of_reference) && is_paired(of_test)) return {};
  const auto model_of = [](const Metadata& metadata) {
    const auto separation = metadata.find("spectrace:separation");
    return separation == metadata.end() ? Metadata::mapped_type(std::string()) : separation->second;
  };
  if (model_of(of_reference) == model_of(of_test)) return {};
  return "of different models and not both rendered with --paired: their noise is part of these figures";
}

}  // namespace spectrace::cli
