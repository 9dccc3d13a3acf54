// SPDX-License-Identifier: Apache-2.0
// The header of a PLY file, and the file as a stream that knows where it stands: a part of read_ply().
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace spectrace::ply {

/// The file, read once from front to back; it knows where it stands, for messages.
class Source {
 public:
  explicit Source(const std::filesystem::path& file);

  [[nodiscard]] std::uint64_t remaining() const { return size_ > position_ ? size_ - position_ : 0; }

  /// One byte, or nothing at the end.
  std::optional<char> byte() {
    const auto c = buffer_.sbumpc();
    if (c == std::filebuf::traits_type::eof()) return std::nullopt;
    ++position_;
    line_ += c == '\n' ? 1 : 0;
    return std::filebuf::traits_type::to_char_type(c);
  }
  void bytes(std::span<char> into);
  /// Up to the line's end, which is not part of it.
  std::string line();
  /// The next characters between blanks.
  std::string_view word();

  [[noreturn]] void fail_at_byte(std::uint64_t at, std::string problem) const;
  [[noreturn]] void fail_at_line(std::string problem) const;
  [[noreturn]] void fail_at_header_line(std::string problem) const;
  [[noreturn]] void fail_at_word(std::string problem) const;
  [[noreturn]] void fail(std::string problem) const;
  [[nodiscard]] std::uint64_t position() const { return position_; }

 private:
  std::string name_;
  std::filebuf buffer_;
  std::uint64_t size_ = 0, position_ = 0, line_ = 1, line_of_word_ = 1;
  std::array<char, 64> word_{};
};

enum class Encoding : std::uint8_t { kText, kLittleEndian, kBigEndian };
enum class Type : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct Property {
  std::string name;
  Type type = Type::kFloat32;
  std::optional<Type> list_length{};  // of lists: type of the number of their values
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;

  [[nodiscard]] std::optional<std::size_t> find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == property) return i;
    }
    return std::nullopt;
  }
};

struct Header {
  Encoding encoding = Encoding::kText;
  std::vector<Element> elements;

  [[nodiscard]] const Element* find(std::string_view name) const {
    const auto it =
        std::find_if(elements.begin(), elements.end(), [&](const Element& e) { return e.name == name; });
    return it == elements.end() ? nullptr : &*it;
  }
};

[[nodiscard]] std::size_t size_of(Type type);

/// From the file's beginning to behind "end_header". Throws InputError naming the line.
[[nodiscard]] Header read_header(Source& source);

}  // namespace spectrace::ply
