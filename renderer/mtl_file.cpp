// SPDX-License-Identifier: Apache-2.0
// Read by code of our own: tinyobjloader's reader tells neither which
// statements a material has nor what is wrong with them and where.
#include "renderer/mtl_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <limits>

#include "core/base/error.h"
#include "core/base/json.h"
#include "renderer/trimmed.h"

namespace spectrace {

namespace {

/// Takes the first word off `text`.
std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text = trimmed(text.substr(word.size()));
  return word;
}

std::optional<double> to_number(std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file) {}

  std::vector<MtlMaterial> read() {
    std::ifstream stream(file_);
    if (!stream) throw InputError(file_.string(), "", "cannot be opened");
    for (std::string line; std::getline(stream, line);) {
      ++line_;
      std::string_view rest = line;
      const std::string_view keyword = take_word(rest);
      if (!keyword.empty() && keyword[0] != '#') statement(keyword, rest);
    }
    if (!wrong_.empty()) throw InputError(wrong_);
    return std::move(materials_);
  }

 private:
  void statement(std::string_view keyword, std::string_view rest) {
    if (keyword == "newmtl") {
      if (rest.empty()) wrong("expected a name behind newmtl");
      materials_.emplace_back().name = rest;
      return;
    }
    if (materials_.empty()) {
      wrong(fmt::format("\"{}\" before the first newmtl", keyword));
      return;
    }
    if (!colour(keyword, rest) && !number(keyword, rest) && !map(keyword, rest)) ignore(keyword);
  }

  bool colour(std::string_view keyword, std::string_view rest) {
    MtlMaterial& m = materials_.back();
    const bool is_emission = keyword == "Ke";
    if (!is_emission && keyword != "Kd" && keyword != "Ks") return false;
    if (rest.starts_with("spectral") || rest.starts_with("xyz")) return false;
    const NumberRange range{.min = 0, .max = is_emission ? std::numeric_limits<float>::max() : 1};
    Rgb rgb{};
    std::size_t count = 0;
    bool good = true;
    while (!rest.empty() && count < 3) {
      const std::optional<double> value = to_number(take_word(rest));
      good = good && value && range.contains(*value);
      rgb[count++] = value.value_or(0);
    }
    if (count == 1) rgb[1] = rgb[2] = rgb[0];  // one number is a grey
    if (!good || !rest.empty() || (count != 1 && count != 3)) {
      wrong(fmt::format("{}: expected three numbers {}", keyword, range.text()));
      return true;
    }
    (is_emission ? m.emission : keyword == "Kd" ? m.diffuse : m.specular) = rgb;
    return true;
  }

  bool number(std::string_view keyword, std::string_view rest) {
    MtlMaterial& m = materials_.back();
    const auto take = [&](NumberRange range) -> std::optional<double> {
      const std::optional<double> value = to_number(rest);
      if (value && range.contains(*value)) return value;
      wrong(fmt::format("{}: expected a number {}", keyword, range.text()));
      return std::nullopt;
    };
    if (keyword == "Ns") {
      m.exponent = take(kNonNegative);
    } else if (keyword == "Pr") {
      m.roughness = take(kUnitInterval);
    } else if (keyword == "Pm") {
      m.metallic = take(kUnitInterval);
    } else if (keyword == "Ni") {
      m.refractive_index = take(kPositive);
    } else if (keyword == "d") {
      if (rest.starts_with("-halo")) return false;
      m.opacity = take(kUnitInterval);
      has_d_ = materials_.size();
    } else if (keyword == "Tr") {
      const std::optional<double> value = take(kUnitInterval);
      if (value && has_d_ != materials_.size()) m.opacity = 1 - *value;  // d is the standard's
    } else if (keyword == "illum") {
      m.illumination = static_cast<int>(take({.min = 0, .max = 10}).value_or(2));
    } else {
      return false;
    }
    return true;
  }

  bool map(std::string_view keyword, std::string_view rest) {
    MtlMaterial& m = materials_.back();
    std::filesystem::path* const target = keyword == "map_Kd"                          ? &m.diffuse_map
                                          : keyword == "map_d"                         ? &m.opacity_map
                                          : keyword == "norm" || keyword == "map_Norm" ? &m.normal_map
                                                                                       : nullptr;
    if (target == nullptr) return false;
    if (rest.starts_with('-')) {
      // Options scale, shift, clamp or filter; the name is the last word.
      ignore(fmt::format("{} {}", keyword, rest.substr(0, rest.find_first_of(kBlanks))));
      rest = rest.substr(rest.find_last_of(kBlanks) + 1);
    }
    std::string name(rest);
    std::replace(name.begin(), name.end(), '\\', '/');
    const std::filesystem::path file = file_.parent_path() / name;
    std::error_code failed;
    if (name.empty() || !std::filesystem::is_regular_file(file, failed)) {
      wrong(fmt::format("{}: there is no file \"{}\"", keyword, file.lexically_normal().string()));
      return true;
    }
    *target = file;
    return true;
  }

  void ignore(std::string_view statement) {
    // Ambient light is what a path tracer computes.
    if (statement == "Ka" || statement == "map_Ka") return;
    auto& list = materials_.back().without_effect;
    if (std::find(list.begin(), list.end(), statement) == list.end()) list.emplace_back(statement);
  }

  void wrong(std::string problem) {
    wrong_.push_back({file_.string(), fmt::format("line {}", line_), std::move(problem)});
  }

  std::filesystem::path file_;
  std::size_t line_ = 0, has_d_ = 0;
  std::vector<MtlMaterial> materials_;
  std::vector<Diagnostic> wrong_;
};

}  // namespace

std::vector<MtlMaterial> read_mtl(const std::filesystem::path& file) { return Reader(file).read(); }

}  // namespace spectrace
