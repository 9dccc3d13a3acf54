// SPDX-License-Identifier: Apache-2.0
// What options may be: names of an enumeration, numbers within bounds.
#pragma once

#include <CLI/CLI.hpp>
#include <limits>
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

// Of numbers. CLI11's own checks let NaN pass, and print the largest double digit by digit.
CLI::Validator above_zero(double most = std::numeric_limits<double>::max());
CLI::Validator at_least_zero();
CLI::Validator from_zero_to_one();
/// At most 31 years: clocks count their ticks in 64 bits.
CLI::Validator seconds_above_zero();

}  // namespace spectrace::cli
