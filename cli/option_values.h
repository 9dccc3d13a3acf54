// SPDX-License-Identifier: Apache-2.0
// What options may be: names of an enumeration, numbers within bounds.
#pragma once

#include <fmt/format.h>

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

/// `holds` of a number and nothing that is none. CLI11's own checks let NaN pass, and print the largest
/// double digit by digit.
template <typename Condition>
CLI::Validator number_that(Condition holds, const std::string& is, const std::string& name) {
  const auto check = [holds, is](const std::string& text) {
    double x = 0;
    const bool is_number = CLI::detail::lexical_cast(text, x);
    return is_number && holds(x) ? std::string() : fmt::format("{} is not {}", text, is);
  };
  return CLI::Validator(check, name);
}

inline CLI::Validator above_zero(double most = std::numeric_limits<double>::max()) {
  const std::string is = most < std::numeric_limits<double>::max()
                             ? fmt::format("above 0 and at most {:g}", most)
                             : "a number above 0";
  return number_that([most](double x) { return x > 0 && x <= most; }, is, "POSITIVE");
}

inline CLI::Validator at_least_zero() {
  return number_that([](double x) { return x >= 0 && x <= std::numeric_limits<double>::max(); },
                     "a number of at least 0", "NONNEGATIVE");
}

inline CLI::Validator from_zero_to_one() {
  return number_that([](double x) { return x >= 0 && x <= 1; }, "in [0, 1]", "in [0, 1]");
}

/// 31 years: clocks count their ticks in 64 bits.
inline CLI::Validator seconds_above_zero() { return above_zero(1e9); }

}  // namespace spectrace::cli
