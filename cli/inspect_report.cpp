// SPDX-License-Identifier: Apache-2.0
#include "cli/inspect_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "core/base/json.h"

namespace spectrace::cli {

namespace {

std::string cell_text(const InspectCell& cell) {
  return std::visit(
      [](const auto& x) -> std::string {
        using T = std::decay_t<decltype(x)>;
        if constexpr (std::is_same_v<T, std::string>) {
          // Text from a file must not drive the terminal; its own line breaks are kept, and set apart.
          std::string text;
          for (const char c : x) {
            if (c == '\n') {
              text += "\n    ";
            } else {
              text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
            }
          }
          return text;
        } else if constexpr (std::is_same_v<T, double>) {
          return fmt::format("{:.6g}", x);
        } else if constexpr (std::is_same_v<T, bool>) {
          return x ? "yes" : "no";
        } else {
          return fmt::format("{}", x);
        }
      },
      cell);
}

void print_table(const InspectSection& section, std::string& out) {
  std::vector<std::vector<std::string>> lines = {section.columns};
  for (const auto& row : section.rows) {
    std::vector<std::string> line;
    for (const InspectCell& cell : row) line.push_back(cell_text(cell));
    lines.push_back(std::move(line));
  }
  std::vector<std::size_t> widths(section.columns.size());
  for (const auto& line : lines) {
    for (std::size_t c = 0; c < widths.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  }
  for (std::size_t l = 0; l < lines.size(); ++l) {
    std::string text;
    for (std::size_t c = 0; c < widths.size(); ++c) {
      const bool is_text =
          l > 0 ? std::holds_alternative<std::string>(section.rows[l - 1][c])
                : section.rows.empty() || std::holds_alternative<std::string>(section.rows[0][c]);
      text += is_text ? fmt::format("  {:<{}}", lines[l][c], widths[c])
                      : fmt::format("  {:>{}}", lines[l][c], widths[c]);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    out += text + '\n';
  }
}

void write_cell(JsonWriter& json, const InspectCell& cell) {
  std::visit(
      [&](const auto& x) {
        if constexpr (std::is_same_v<std::decay_t<decltype(x)>, std::string>) {
          json.value(std::string_view(x));
        } else {
          json.value(x);
        }
      },
      cell);
}

}  // namespace

std::string to_text(const InspectReport& report) {
  std::string out;
  for (const InspectSection& section : report) {
    if (section.facts.empty() && section.rows.empty()) continue;
    out += section.title + '\n';
    std::size_t width = 0;
    for (const auto& [name, value] : section.facts) width = std::max(width, name.size());
    for (const auto& [name, value] : section.facts)
      out += fmt::format("  {:<{}}  {}\n", name, width, cell_text(value));
    if (!section.rows.empty()) print_table(section, out);
    out += '\n';
  }
  if (!out.empty()) out.pop_back();
  return out;
}

std::string to_json(const InspectReport& report) {
  JsonWriter json;
  json.begin_object();
  for (const InspectSection& section : report) {
    json.key(section.title);
    const bool has_table = !section.columns.empty();
    if (has_table && section.facts.empty()) {
      json.begin_array();
    } else {
      json.begin_object();
      for (const auto& [name, value] : section.facts) {
        json.key(name);
        write_cell(json, value);
      }
      if (has_table) {
        json.key("rows");
        json.begin_array();
      }
    }
    for (const auto& row : section.rows) {
      json.begin_object();
      for (std::size_t c = 0; c < row.size(); ++c) {
        json.key(section.columns[c]);
        write_cell(json, row[c]);
      }
      json.end_object();
    }
    if (has_table) json.end_array();
    if (!has_table || !section.facts.empty()) json.end_object();
  }
  json.end_object();
  return json.text();
}

ValueStatistics statistics_of(std::span<const float> values, std::size_t first, std::size_t stride) {
  ValueStatistics s;
  s.min = std::numeric_limits<double>::infinity();
  s.max = -std::numeric_limits<double>::infinity();
  double sum = 0;
  for (std::size_t i = first; i < values.size(); i += stride) {
    const double x = values[i];
    ++s.count;
    if (!std::isfinite(x)) {
      ++s.non_finite;
      continue;
    }
    s.min = std::min(s.min, x);
    s.max = std::max(s.max, x);
    sum += x;
    s.negative += x < 0 ? 1 : 0;
    s.zero += x == 0 ? 1 : 0;
  }
  const std::size_t finite = s.count - s.non_finite;
  s.mean = sum / static_cast<double>(finite);
  if (finite == 0) s.min = s.max = std::numeric_limits<double>::quiet_NaN();
  return s;
}

}  // namespace spectrace::cli
