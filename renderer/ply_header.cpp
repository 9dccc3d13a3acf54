// SPDX-License-Identifier: Apache-2.0
#include "renderer/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/base/error.h"

namespace spectrace::ply {

Source::Source(const std::filesystem::path& file) : name_(file.string()) {
  std::error_code failed;
  size_ = std::filesystem::file_size(file, failed);
  if (failed || buffer_.open(file, std::ios::in | std::ios::binary) == nullptr) {
    throw InputError(name_, "", "cannot be opened");
  }
}

void Source::bytes(std::span<char> into) {
  const std::uint64_t begin = position_;
  const auto got = buffer_.sgetn(into.data(), std::streamsize(into.size()));
  if (got != std::streamsize(into.size())) fail_at_byte(begin, "the file ends within its data");
  position_ += into.size();
}

std::string Source::line() {
  constexpr std::size_t kLongest = 4096;  // of a header; only comments come near
  std::string text;
  while (const auto c = byte()) {
    if (*c == '\n') {
      if (text.ends_with('\r')) text.pop_back();
      return text;
    }
    if (text.size() == kLongest) fail_at_line("a header line this long is no PLY file's");
    text += *c;
  }
  fail_at_line("the file ends within its header");
}

std::string_view Source::word() {
  std::size_t length = 0;
  std::uint64_t line_of_word = line_;
  while (const auto c = byte()) {
    if (*c == ' ' || *c == '\t' || *c == '\n' || *c == '\r') {
      if (length > 0) break;
      line_of_word = line_;
      continue;
    }
    if (length == word_.size()) fail_at_line("expected a number, got something much longer");
    word_[length++] = *c;
  }
  line_of_word_ = line_of_word;
  if (length == 0) fail_at_line("the file ends within its data");
  return {word_.data(), length};
}

void Source::fail_at_byte(std::uint64_t at, std::string problem) const {
  throw InputError(name_, fmt::format("byte {}", at), std::move(problem));
}

void Source::fail_at_line(std::string problem) const {
  throw InputError(name_, fmt::format("line {}", line_), std::move(problem));
}

void Source::fail_at_header_line(std::string problem) const {  // the one just read
  throw InputError(name_, fmt::format("line {}", line_ - 1), std::move(problem));
}

void Source::fail_at_word(std::string problem) const {
  throw InputError(name_, fmt::format("line {}", line_of_word_), std::move(problem));
}

void Source::fail(std::string problem) const { throw InputError(name_, "", std::move(problem)); }

std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

namespace {

std::optional<Type> type_named(std::string_view name) {
  // The names of the original description, and those with widths.
  constexpr std::array<std::array<std::string_view, 2>, 8> kNames{{{"char", "int8"},
                                                                   {"uchar", "uint8"},
                                                                   {"short", "int16"},
                                                                   {"ushort", "uint16"},
                                                                   {"int", "int32"},
                                                                   {"uint", "uint32"},
                                                                   {"float", "float32"},
                                                                   {"double", "float64"}}};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (name == kNames[i][0] || name == kNames[i][1]) return static_cast<Type>(i);
  }
  return std::nullopt;
}

std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < line.size();) {
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    if (end > begin) words.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

Encoding parse_format(const std::vector<std::string>& words, const Source& source) {
  if (words.size() == 3 && words[2] == "1.0") {
    if (words[1] == "ascii") return Encoding::kText;
    if (words[1] == "binary_little_endian") return Encoding::kLittleEndian;
    if (words[1] == "binary_big_endian") return Encoding::kBigEndian;
  }
  source.fail_at_header_line(
      "expected \"format\", one of ascii, binary_little_endian, binary_big_endian, and \"1.0\"");
}

Element parse_element(const std::vector<std::string>& words, const Header& header, const Source& source) {
  Element element;
  if (words.size() != 3) source.fail_at_header_line("expected \"element\", a name and a count");
  element.name = words[1];
  const std::string& count = words[2];
  const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (error != std::errc() || end != count.data() + count.size()) {
    source.fail_at_header_line(fmt::format("expected a count of elements, got \"{}\"", count));
  }
  if (header.find(element.name) != nullptr) {
    source.fail_at_header_line(fmt::format("a second element \"{}\"", element.name));
  }
  return element;
}

Type parse_type(const std::string& name, const Source& source) {
  const std::optional<Type> type = type_named(name);
  if (!type) source.fail_at_header_line(fmt::format("there is no type \"{}\"", name));
  return *type;
}

Property parse_property(const std::vector<std::string>& words, const Header& header, const Source& source) {
  if (header.elements.empty()) source.fail_at_header_line("a property before the first element");
  const bool is_list = words.size() == 5 && words[1] == "list";
  if (!is_list && words.size() != 3) {
    source.fail_at_header_line(
        "expected \"property\", a type and a name, or \"property list\", two types and a name");
  }
  Property property{.name = words.back(), .type = parse_type(words[words.size() - 2], source)};
  if (is_list) property.list_length = parse_type(words[2], source);
  if (header.elements.back().find(property.name)) {
    source.fail_at_header_line(fmt::format("a second property \"{}\"", property.name));
  }
  return property;
}

}  // namespace

Header read_header(Source& source) {
  Header header;
  if (source.line() != "ply") source.fail_at_header_line("is not a PLY file: it does not begin with \"ply\"");
  header.encoding = parse_format(words_of(source.line()), source);
  while (true) {
    const std::vector<std::string> words = words_of(source.line());
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") return header;
    if (words[0] == "element") {
      header.elements.push_back(parse_element(words, header, source));
    } else if (words[0] == "property") {
      Property property = parse_property(words, header, source);  // throws where there is no element yet
      header.elements.back().properties.push_back(std::move(property));
    } else {
      source.fail_at_header_line(
          fmt::format("expected element, property, comment or end_header, got \"{}\"", words[0]));
    }
  }
}

}  // namespace spectrace::ply
