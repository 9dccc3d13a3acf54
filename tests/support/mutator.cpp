// SPDX-License-Identifier: Apache-2.0
#include "tests/support/mutator.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace spectrace::test {

namespace {

/// Where a number, a word or any other single character begins and ends.
struct Token {
  std::size_t begin = 0, length = 0;
  bool is_number = false;
};

bool belongs_to_number(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '+' || c == 'e';
}

std::vector<Token> numbers_of(std::string_view text) {
  std::vector<Token> tokens;
  for (std::size_t i = 0; i < text.size();) {
    const bool begins_word = i == 0 || std::isalnum(static_cast<unsigned char>(text[i - 1])) == 0;
    if (begins_word && (std::isdigit(static_cast<unsigned char>(text[i])) != 0 || text[i] == '-')) {
      std::size_t end = i;
      while (end < text.size() && belongs_to_number(text[end])) ++end;
      tokens.push_back({i, end - i, true});
      i = end;
    } else {
      ++i;
    }
  }
  return tokens;
}

/// Lines, or what stands between commas where a file is one long line.
Token stretch_around(std::string_view text, std::size_t at, char border) {
  const std::size_t before = at == 0 ? std::string_view::npos : text.rfind(border, at - 1);
  const std::size_t begin = before == std::string_view::npos ? 0 : before + 1;
  const std::size_t end = std::min(text.find(border, at), text.size() - 1) + 1;
  return {begin, end - begin, false};
}

constexpr std::size_t kHeaderBytes = 1024;
constexpr std::size_t kLongestStretch = 256;
constexpr std::size_t kNesting = 100'000;

}  // namespace

std::size_t Mutator::below(std::size_t bound) {
  return std::min(static_cast<std::size_t>(double(random_.uniform()) * double(bound)), bound - 1);
}

void Mutator::flip_bits(std::string& bytes, std::size_t range) {
  for (std::size_t i = 0, n = 1 + below(4); i < n; ++i) {
    char& c = bytes[below(range)];
    c = static_cast<char>(static_cast<unsigned char>(c) ^ (1U << below(8)));
  }
}

void Mutator::replace_number(std::string& text) {
  static constexpr const char* kNumbers[] = {
      "1e400",      "-1",    "NaN",        "nan",  "inf", "-1e400", "0",    "-0",  "1e-50", "1e38",
      "2147483648", "1e999", "4294967296", "0x10", "1,5", "\"1\"",  "null", "1e9", "--1",   ""};
  const std::vector<Token> numbers = numbers_of(text);
  if (numbers.empty()) return;
  const Token& number = numbers[below(numbers.size())];
  text.replace(number.begin, number.length, one_of(kNumbers));
}

void Mutator::move_stretch(std::string& bytes, std::size_t begin, std::size_t length) {
  const std::string stretch = bytes.substr(begin, length);
  switch (below(3)) {
    case 0:
      bytes.erase(begin, length);
      break;
    case 1:
      bytes.insert(begin, stretch);
      break;
    default:
      bytes.erase(begin, length);
      bytes.insert(below(bytes.size() + 1), stretch);
  }
}

void Mutator::mutate_text_once(std::string& text) {
  static constexpr const char* kInvalidUtf8[] = {"\xff", "\xc3\x28", "\xed\xa0\x80", "\xf5\x80\x80\x80",
                                                 "\xc0\xaf"};
  static constexpr const char* kBrackets[] = {"[", "{\"a\":", "(", "]"};
  const std::size_t at = below(text.size());
  switch (below(10)) {
    case 0:
      return flip_bits(text, text.size());
    case 1:
      return text.resize(at);
    case 2:
    case 3:
    case 4:
      return replace_number(text);
    case 5: {
      const Token line = stretch_around(text, at, '\n');
      return move_stretch(text, line.begin, line.length);
    }
    case 6:
    case 7: {
      const Token member = stretch_around(text, at, ',');
      return move_stretch(text, member.begin, std::min(member.length, kLongestStretch));
    }
    case 8:
      text.insert(at, one_of(kInvalidUtf8));
      return;
    default: {
      const char* bracket = one_of(kBrackets);
      std::string nest;
      for (std::size_t i = 0, depth = below(2) == 0 ? 1 : kNesting; i < depth; ++i) nest += bracket;
      text.insert(at, nest);
    }
  }
}

void Mutator::mutate_binary_once(std::string& bytes) {
  const std::size_t range = below(2) == 0 ? std::min(kHeaderBytes, bytes.size()) : bytes.size();
  const std::size_t at = below(range);
  switch (below(4)) {
    case 0:
      return flip_bits(bytes, range);
    case 1:
      return bytes.resize(at);
    case 2: {
      // As numbers of single and double precision: NaN, both infinities, -1, the largest; as integers: -1,
      // the ends.
      static constexpr std::string_view kWords[] = {
          {"\x00\x00\xc0\x7f", 4},
          {"\x00\x00\x80\x7f", 4},
          {"\x00\x00\x80\xff", 4},
          {"\x00\x00\x80\xbf", 4},
          {"\xff\xff\x7f\x7f", 4},
          {"\x00\x00\x00\x00\x00\x00\xf8\x7f", 8},
          {"\xff\xff\xff\xff\xff\xff\xff\xff", 8},
          {"\xff\xff\xff\xff\xff\xff\xff\x7f", 8},
          {"\x00\x00\x00\x80", 4},
          {"\x00\x00\x00\x00\x00\x00\x00\x00", 8},
          {"\xff\xff", 2},
          {"\x00", 1},
      };
      const std::string_view word = one_of(kWords);
      const std::size_t aligned = at - at % word.size();
      bytes.replace(aligned, word.size(), word);
      return;
    }
    default:
      return move_stretch(bytes, at, std::min(1 + below(kLongestStretch), bytes.size() - at));
  }
}

template <typename Mutation>
std::string Mutator::several(std::string bytes, const Mutation& mutation) {
  for (std::size_t i = 0, n = 1 + below(3); i < n && !bytes.empty(); ++i) mutation(bytes);
  return bytes;
}

std::string Mutator::mutate_text(std::string text) {
  return several(std::move(text), [this](std::string& t) { mutate_text_once(t); });
}
std::string Mutator::mutate_binary(std::string bytes) {
  return several(std::move(bytes), [this](std::string& b) { mutate_binary_once(b); });
}

}  // namespace spectrace::test
