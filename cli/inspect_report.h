// SPDX-License-Identifier: Apache-2.0
// What `spectrace inspect` found, before it is printed as text or as JSON.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace spectrace::cli {

using InspectCell = std::variant<std::string, double, std::int64_t, bool>;

/// Named facts, then a table.
struct InspectSection {
  std::string title;
  std::vector<std::pair<std::string, InspectCell>> facts;
  std::vector<std::string> columns;
  std::vector<std::vector<InspectCell>> rows;

  /// Names carry units: "last_measured_elevation_deg".
  void add(std::string name, const char* text) { facts.emplace_back(std::move(name), std::string(text)); }
  void add(std::string name, std::string text) { facts.emplace_back(std::move(name), std::move(text)); }
  void add(std::string name, double x) { facts.emplace_back(std::move(name), x); }
  void add(std::string name, bool x) { facts.emplace_back(std::move(name), x); }
  void add(std::string name, std::int64_t x) { facts.emplace_back(std::move(name), x); }
  void add(std::string name, int x) { add(std::move(name), std::int64_t(x)); }
  void add(std::string name, std::size_t x) { add(std::move(name), static_cast<std::int64_t>(x)); }
};
using InspectReport = std::vector<InspectSection>;

[[nodiscard]] std::string to_text(const InspectReport& report);
[[nodiscard]] std::string to_json(const InspectReport& report);

/// Range, mean and oddities of values; the range is over finite ones.
struct ValueStatistics {
  double min = 0, max = 0, mean = 0;
  std::size_t count = 0, non_finite = 0, negative = 0, zero = 0;
};
[[nodiscard]] ValueStatistics statistics_of(std::span<const float> values, std::size_t first = 0,
                                            std::size_t stride = 1);

/// One a kind of file; all throw InputError. Each file is told apart by its content, see inspect.cpp.
[[nodiscard]] InspectReport inspect_image(const std::filesystem::path& file);
[[nodiscard]] InspectReport inspect_tensors(const std::filesystem::path& file);
[[nodiscard]] InspectReport inspect_measured(const std::filesystem::path& file);  ///< of other layouts
[[nodiscard]] InspectReport inspect_scene(const std::filesystem::path& file);
[[nodiscard]] InspectReport inspect_material(const std::filesystem::path& file);
/// Whether this JSON file is meant as a single material rather than as a scene.
[[nodiscard]] bool is_material(const std::filesystem::path& file);

}  // namespace spectrace::cli
