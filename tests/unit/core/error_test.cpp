// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"

#include <gtest/gtest.h>

namespace spectrace {
namespace {

TEST(InputError, IsOneLineADiagnostic) {
  const InputError error(
      {{"scenes/cornell.json", "41:18: /materials/2/roughness", "expected a number in (0, 1]"},
       {"x.bsdf", "", "not a tensor file"}});
  EXPECT_STREQ(error.what(),
               "scenes/cornell.json:41:18: /materials/2/roughness: expected a number in (0, 1]\n"
               "x.bsdf: not a tensor file");
  EXPECT_EQ(error.diagnostics().size(), 2u);
}

TEST(InputError, KeepsAHostileNameOnOneLine) {
  const InputError error("a\nb", "1:1", "key \"x\r\x1b[2J\"");
  EXPECT_STREQ(error.what(), "a b:1:1: key \"x  [2J\"");
}

TEST(InputError, QuotesTheEndsOfWhatIsTooLongInWholeCharacters) {
  std::string name;
  for (int i = 0; i < 1000; ++i) name += "\xe2\x82\xac";  // a character of three bytes
  for (const char* shift : {"", "x", "xx"}) {
    const std::string text = InputError("a", "", shift + name).what();
    EXPECT_LT(text.size(), 500U);
    EXPECT_NE(text.find("bytes) ..."), std::string::npos) << text;
    std::size_t bytes_of_name = 0;
    for (const char c : text) bytes_of_name += static_cast<unsigned char>(c) >= 0x80 ? 1 : 0;
    EXPECT_EQ(bytes_of_name % 3, 0U) << text;
  }
}

TEST(InputError, NeedsADiagnostic) { EXPECT_THROW(InputError(std::vector<Diagnostic>{}), InternalError); }

TEST(Check, ThrowsWithExpressionFileAndLine) {
  SPECTRACE_CHECK(true);
  try {
    SPECTRACE_CHECK(1 + 1 == 3);
    FAIL() << "a false check passed";
  } catch (const InternalError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("1 + 1 == 3"), std::string::npos) << text;
    EXPECT_NE(text.find("error_test.cpp:"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace spectrace
