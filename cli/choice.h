// SPDX-License-Identifier: Apache-2.0
// Options whose values are names of an enumeration.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace spectrace::cli {

/// Lets `option` take one of `names`, which help and errors then list. CLI11's own transformer of maps prints
/// the numbers behind the names as well.
template <typename Value>
CLI::Option* take_one_of(CLI::Option* option, const std::map<std::string, Value>& names) {
  std::string listed;
  for (const auto& [name, value] : names) listed += (listed.empty() ? "" : "|") + name;
  option->transform(CLI::Transformer(names).description(""));
  option->transform(CLI::IsMember(names).description(""));  // what is added last looks first
  return option->type_name(listed);
}

}  // namespace spectrace::cli
