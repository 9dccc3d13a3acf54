// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/spectra/spectrum.h"

namespace spectrace {
namespace {

// A wavelength and a few values: real files have 5 to 20 kB. Anything larger is another kind of file.
constexpr std::size_t kMaxBytes = std::size_t(64) << 20;

struct Field {
  std::string_view text;
  std::size_t column = 0;  // from 1, in bytes
};

std::vector<Field> split(std::string_view line) {
  constexpr std::string_view kSeparators = " \t,\r";
  std::vector<Field> fields;
  for (std::size_t begin = 0;;) {
    begin = line.find_first_not_of(kSeparators, begin);
    if (begin == std::string_view::npos || line[begin] == '#') return fields;
    const std::size_t end = std::min(line.find_first_of(" \t,\r#", begin), line.size());
    fields.push_back({line.substr(begin, end - begin), begin + 1});
    begin = end;
  }
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, std::size_t column) : file_(file.string()), column_(column) {}

  TabulatedSpectrum read() {
    const std::vector<std::byte> bytes = read_file(file_, kMaxBytes);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      ++line_;
      read_line(split(text.substr(begin, end - begin)), end - begin);
      begin = end + 1;
    }
    if (lambda_nm_.empty()) throw InputError(file_, "", "holds no wavelength");
    return {std::move(lambda_nm_), std::move(values_)};
  }

 private:
  void read_line(const std::vector<Field>& fields, std::size_t line_length) {
    if (fields.empty()) return;
    const double lambda_nm = number(fields[0]);
    if (!(lambda_nm > 0))
      fail(fields[0].column, fmt::format("expected a wavelength above 0 nm, got {}", lambda_nm));
    // Compared as stored: two wavelengths that a Float cannot tell apart are duplicates.
    if (!lambda_nm_.empty() && !(static_cast<Float>(lambda_nm) > lambda_nm_.back())) {
      fail(fields[0].column,
           fmt::format("wavelengths must increase: {} nm follows {} nm", lambda_nm, lambda_nm_.back()));
    }
    if (fields.size() <= column_) {
      fail(line_length + 1,
           fmt::format("expected a wavelength and {} value{}, got {} column{}", column_,
                       column_ == 1 ? "" : "s", fields.size(), fields.size() == 1 ? "" : "s"));
    }
    lambda_nm_.push_back(static_cast<Float>(lambda_nm));
    values_.push_back(static_cast<Float>(number(fields[column_])));
  }

  [[nodiscard]] double number(const Field& field) const {
    double x = 0;
    const char* const end = field.text.data() + field.text.size();
    const char* begin = field.text.data();
    if (field.text.size() > 1 && field.text[0] == '+' && field.text[1] != '-')
      ++begin;  // from_chars takes none
    const auto [stop, status] = std::from_chars(begin, end, x);
    // As stored: 1e300 is a number, but no Float.
    if (status != std::errc() || stop != end || !std::isfinite(static_cast<Float>(x))) {
      fail(field.column, fmt::format("expected a finite number, got \"{}\"", field.text.substr(0, 40)));
    }
    return x;
  }

  [[noreturn]] void fail(std::size_t column, std::string problem) const {
    throw InputError(file_, fmt::format("{}:{}", line_, column), std::move(problem));
  }

  std::string file_;
  std::size_t column_;
  std::size_t line_ = 0;
  std::vector<Float> lambda_nm_, values_;
};

}  // namespace

TabulatedSpectrum read_spd(const std::filesystem::path& file, int column) {
  SPECTRACE_CHECK(column >= 1);
  return Reader(file, static_cast<std::size_t>(column)).read();
}

}  // namespace spectrace
