// SPDX-License-Identifier: Apache-2.0
#include "cli/option_values.h"

#include <fmt/format.h>

#include <functional>

namespace spectrace::cli {

namespace {

/// `holds` of a number and nothing that is none.
CLI::Validator number_that(const std::function<bool(double)>& holds, const std::string& is,
                           const std::string& name) {
  const auto check = [holds, is](const std::string& text) {
    double x = 0;
    const bool is_number = CLI::detail::lexical_cast(text, x);
    return is_number && holds(x) ? std::string() : fmt::format("{} is not {}", text, is);
  };
  return CLI::Validator(check, name);
}

}  // namespace

CLI::Validator above_zero(double most) {
  const std::string is = most < std::numeric_limits<double>::max()
                             ? fmt::format("above 0 and at most {:g}", most)
                             : "a number above 0";
  return number_that([most](double x) { return x > 0 && x <= most; }, is, "POSITIVE");
}

CLI::Validator at_least_zero() {
  return number_that([](double x) { return x >= 0 && x <= std::numeric_limits<double>::max(); },
                     "a number of at least 0", "NONNEGATIVE");
}

CLI::Validator from_zero_to_one() {
  return number_that([](double x) { return x >= 0 && x <= 1; }, "in [0, 1]", "in [0, 1]");
}

CLI::Validator seconds_above_zero() { return above_zero(1e9); }

}  // namespace spectrace::cli
