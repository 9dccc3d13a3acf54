// SPDX-License-Identifier: Apache-2.0
// The reader of scattered samples: names the line and column of whatever is wrong.
#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/math/math.h"
#include "materials/scattered_brdf.h"

namespace spectrace {
namespace {

constexpr std::size_t kAngles = 4;
constexpr std::size_t kMaxWavelengths = 4096;
// Six decimals of a right angle, as the Cornell files have, and converted degrees.
constexpr double kThetaTolerance = 1e-4;

struct Token {
  std::string_view text;
  std::size_t line = 0, column = 0;  // from 1, in bytes
};

/// Line by line; comments are nothing.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  /// The tokens of the next line that has any; empty at the end.
  std::vector<Token> next() {
    std::vector<Token> tokens;
    while (tokens.empty() && !rest_.empty()) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      ++line_;
      split(rest_.substr(0, end), tokens);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
    }
    return tokens;
  }
  [[nodiscard]] std::size_t line() const { return line_; }

 private:
  void split(std::string_view line, std::vector<Token>& tokens) const {
    constexpr std::string_view kSpace = " \t\r,";
    line = line.substr(0, line.find('#'));
    for (std::size_t begin = line.find_first_not_of(kSpace); begin != line.npos;) {
      const std::size_t end = std::min(line.find_first_of(kSpace, begin), line.size());
      tokens.push_back({line.substr(begin, end - begin), line_, begin + 1});
      begin = line.find_first_not_of(kSpace, end);
    }
  }

  std::string_view rest_;
  std::size_t line_ = 0;
};

class Reader {
 public:
  Reader(std::string_view text, const std::string& file_name) : lines_(text), file_(file_name) {}

  ScatteredSamples read() {
    read_wavelengths();
    for (std::vector<Token> row = lines_.next(); !row.empty(); row = lines_.next()) read_sample(row);
    // The fit at a direction takes the nearest ones and one more.
    if (samples_.directions.size() <= ScatteredBrdf::kNeighbours) {
      throw InputError(file_, fmt::format("{}:1", lines_.line()),
                       fmt::format("{} samples, expected more than {}", samples_.directions.size(),
                                   ScatteredBrdf::kNeighbours));
    }
    return std::move(samples_);
  }

 private:
  [[noreturn]] void fail(const Token& at, std::string problem) const {
    throw InputError(file_, fmt::format("{}:{}", at.line, at.column), std::move(problem));
  }
  [[nodiscard]] double number(const Token& token) const {
    double x = 0;
    const char* const end = token.text.data() + token.text.size();
    const char* begin = token.text.data();
    if (token.text.size() > 1 && token.text[0] == '+' && token.text[1] != '-') ++begin;
    const auto [stop, status] = std::from_chars(begin, end, x);
    // As stored: 1e300 is a number, but no float.
    if (status != std::errc() || stop != end || !std::isfinite(static_cast<float>(x))) {
      fail(token, fmt::format("expected a finite number, got \"{}\"", token.text.substr(0, 40)));
    }
    return x;
  }

  void read_wavelengths() {
    std::vector<Token> row = lines_.next();
    if (row.empty()) throw InputError(file_, "1:1", "expected the number of wavelengths, got nothing");
    const double count = number(row[0]);
    if (!(count >= 1 && count <= kMaxWavelengths && count == std::floor(count))) {
      fail(row[0], fmt::format("expected the number of wavelengths, an integer in [1, {}], got \"{}\"",
                               kMaxWavelengths, row[0].text.substr(0, 40)));
    }
    row.erase(row.begin());
    const auto wanted = static_cast<std::size_t>(count);
    while (samples_.lambda_nm.size() < wanted) {
      if (row.empty()) row = lines_.next();
      if (row.empty()) {
        throw InputError(file_, fmt::format("{}:1", lines_.line()),
                         fmt::format("{} wavelengths, expected {}", samples_.lambda_nm.size(), wanted));
      }
      for (const Token& token : row) add_wavelength(token, wanted);
      row.clear();
    }
  }
  void add_wavelength(const Token& token, std::size_t wanted) {
    if (samples_.lambda_nm.size() == wanted) {
      fail(token, fmt::format("expected {} wavelengths, got one more", wanted));
    }
    const auto lambda_nm = static_cast<float>(number(token));
    if (!(lambda_nm > 0)) fail(token, fmt::format("expected a wavelength above 0 nm, got {}", lambda_nm));
    if (!samples_.lambda_nm.empty() && lambda_nm <= samples_.lambda_nm.back()) {
      fail(token, fmt::format("wavelengths must increase: {} nm follows {} nm", lambda_nm,
                              samples_.lambda_nm.back()));
    }
    samples_.lambda_nm.push_back(lambda_nm);
  }

  [[nodiscard]] double elevation(const Token& token, std::string_view name) const {
    const double theta = number(token);
    if (!(theta >= 0 && theta <= kPi64 / 2 + kThetaTolerance)) {
      fail(token, fmt::format("{} is {}, expected radians in [0, pi/2]", name, theta));
    }
    return std::min(theta, kPi64 / 2);
  }

  void read_sample(const std::vector<Token>& row) {
    const std::size_t expected = kAngles + samples_.lambda_nm.size();
    if (row.size() != expected) {
      fail(row.size() > expected ? row[expected] : row.back(),
           fmt::format("{} numbers on the line of a sample, expected {}: 4 angles and {} values", row.size(),
                       expected, samples_.lambda_nm.size()));
    }
    samples_.directions.push_back({.theta_i = elevation(row[0], "theta_i"),
                                   .phi_i = number(row[1]),
                                   .theta_o = elevation(row[2], "theta_o"),
                                   .phi_o = number(row[3])});
    for (std::size_t k = kAngles; k < row.size(); ++k) {
      const auto f = static_cast<float>(number(row[k]));
      if (f < 0) ++samples_.negative_values;
      samples_.f.push_back(std::max(f, 0.0F));
    }
  }

  Lines lines_;
  std::string file_;
  ScatteredSamples samples_;
};

}  // namespace

bool is_scattered_text(std::string_view text) {
  const std::vector<Token> row = Lines(text).next();
  if (row.empty()) return false;
  const std::string_view first = row[0].text;
  return first.find_first_not_of("0123456789+-.eE") == first.npos;
}

ScatteredSamples parse_scattered(std::string_view text, const std::string& file_name) {
  return Reader(text, file_name).read();
}

}  // namespace spectrace
