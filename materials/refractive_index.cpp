// SPDX-License-Identifier: Apache-2.0
#include "materials/refractive_index.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/file.h"

namespace spectrace {

namespace {

constexpr std::size_t kMaxBytes = std::size_t(16) << 20;  // the database's largest file has 1.4 MB

std::string place(std::size_t line, std::size_t column) {
  return std::to_string(line) + ":" + std::to_string(column);
}

std::size_t indentation(std::string_view line) { return std::min(line.find_first_not_of(' '), line.size()); }

/// Three numbers separated by blanks; throws with the column of the first fault.
std::array<double, 3> three_numbers(std::string_view line, std::size_t line_number, const std::string& file) {
  std::array<double, 3> numbers{};
  std::size_t at = 0;
  for (double& x : numbers) {
    at = std::min(line.find_first_not_of(" \t", at), line.size());
    const auto [end, error] = std::from_chars(line.data() + at, line.data() + line.size(), x);
    if (error != std::errc() || !std::isfinite(x)) {
      throw InputError(file, place(line_number, at + 1), "expected a wavelength [um], n and k");
    }
    at = static_cast<std::size_t>(end - line.data());
  }
  at = std::min(line.find_first_not_of(" \t", at), line.size());
  if (at != line.size()) throw InputError(file, place(line_number, at + 1), "expected three numbers a line");
  return numbers;
}

}  // namespace

RefractiveIndex read_refractive_index(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_file(file, kMaxBytes);
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::vector<Float> lambda_nm, eta, k;
  std::size_t line_number = 0;
  bool is_nk = false, in_data = false;
  std::size_t data_indentation = 0;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    ++line_number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const std::size_t indent = indentation(line);
    if (indent == line.size()) continue;
    if (in_data) {
      if (indent <= data_indentation) break;
      const auto [um, n, kappa] = three_numbers(line, line_number, file.string());
      const auto nm = static_cast<Float>(um * 1000);
      if (!(n > 0) || kappa < 0 || !(nm > 0) || (!lambda_nm.empty() && nm <= lambda_nm.back())) {
        throw InputError(file.string(), place(line_number, indent + 1),
                         "expected increasing wavelengths > 0 with n > 0 and k >= 0");
      }
      lambda_nm.push_back(nm);
      eta.push_back(static_cast<Float>(n));
      k.push_back(static_cast<Float>(kappa));
    } else if (line.find("type: ") != std::string_view::npos) {
      is_nk = line.ends_with("tabulated nk");
    } else if (is_nk && line.ends_with("data: |")) {
      in_data = true;
      data_indentation = indent;
    }
  }
  if (lambda_nm.empty()) {
    throw InputError(file.string(), "", "expected a refractiveindex.info file with a \"tabulated nk\" block");
  }
  return {TabulatedSpectrum(lambda_nm, eta), TabulatedSpectrum(std::move(lambda_nm), k)};
}

}  // namespace spectrace
