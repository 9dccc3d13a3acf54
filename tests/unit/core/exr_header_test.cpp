// SPDX-License-Identifier: Apache-2.0
// Headers of EXR files that announce more, or other, than they have.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/image/image.h"
#include "tests/support/temporary_folder.h"

namespace spectrace::test {
namespace {

std::string little_endian(std::uint32_t x) {
  return {char(x & 255), char(x >> 8 & 255), char(x >> 16 & 255), char(x >> 24 & 255)};
}

class ExrHeader : public ::testing::Test {
 protected:
  static std::string attribute(const std::string& type, std::uint32_t announced, const std::string& value) {
    std::string text = "x";
    text.push_back('\0');
    text.append(type).push_back('\0');
    return text.append(little_endian(announced)).append(value);
  }
  /// What is said of a file with this header, and so many zeros behind it.
  std::string refusal(const std::string& header, std::size_t behind = 1024) const {
    const std::filesystem::path file = folder_ / "x.exr";
    std::string text("\x76\x2f\x31\x01\x02\0\0\0", 8);
    text.append(header).append(behind, '\0');
    write_file_atomically(file, text);
    try {
      (void)read_image(file);
    } catch (const InputError& e) {
      return e.diagnostics().front().text();
    }
    return "";
  }
  TemporaryFolder folder_;
};

TEST_F(ExrHeader, RefusesWhatTheFileCannotHold) {
  EXPECT_NE(refusal(attribute("string", 1U << 31, "abc")).find("announces 2147483648 bytes"),
            std::string::npos);
}

TEST_F(ExrHeader, RefusesSizesThatTheLibraryWouldReadPast) {
  // Each is read by its type, whatever size it announces: what follows would be taken for other attributes.
  EXPECT_NE(refusal(attribute("int", 8, "12345678")).find("announces 8 bytes, it has 4"), std::string::npos);
  std::string channels = "R";
  channels.append(18, '\0');
  EXPECT_EQ(channels.size(), 19U);
  EXPECT_NE(refusal(attribute("chlist", 25, channels + "abcdef")).find("announces 25 bytes, it has 19"),
            std::string::npos);
  EXPECT_NE(refusal(attribute("preview", 8, little_endian(2) + little_endian(3))).find("it has 32"),
            std::string::npos);
  EXPECT_NE(
      refusal(attribute("preview", 8, little_endian(1U << 31) + little_endian(1U << 31))).find("too large"),
      std::string::npos);
  EXPECT_NE(
      refusal(attribute("idmanifest", 8, little_endian(1U << 30) + "abcd")).find("more than it can unpack"),
      std::string::npos);
}

TEST_F(ExrHeader, SaysWhereItEnds) {
  EXPECT_NE(refusal("x", 0).find("EXR header ends too early"), std::string::npos) << "no type";
}

}  // namespace
}  // namespace spectrace::test
