// SPDX-License-Identifier: Apache-2.0
#include "core/base/murmur_hash.h"

#include <gtest/gtest.h>

#include <string>

namespace spectrace::test {
namespace {

using namespace std::string_literals;

/// Values that other implementations publish and agree on.
TEST(MurmurHash, GivesThePublishedValues) {
  EXPECT_EQ(murmur_hash3_32(""), 0U);
  EXPECT_EQ(murmur_hash3_32("", 1), 0x514e28b7U);
  EXPECT_EQ(murmur_hash3_32("", 0xffffffff), 0x81f16f39U);
  EXPECT_EQ(murmur_hash3_32("\xff\xff\xff\xff"), 0x76293b50U);
  EXPECT_EQ(murmur_hash3_32("\x21\x43\x65\x87"), 0xf55b516bU);
  EXPECT_EQ(murmur_hash3_32("\x21\x43\x65\x87", 0x5082edee), 0x2362f9deU);
  EXPECT_EQ(murmur_hash3_32("\x21\x43\x65"), 0x7e4a8634U);
  EXPECT_EQ(murmur_hash3_32("\x21\x43"), 0xa0f7b07aU);
  EXPECT_EQ(murmur_hash3_32("\x21"), 0x72661cf4U);
  EXPECT_EQ(murmur_hash3_32("\0\0\0\0"s), 0x2362f9deU);
  EXPECT_EQ(murmur_hash3_32("\0"s), 0x514e28b7U);
  EXPECT_EQ(murmur_hash3_32("aaaa", 0x9747b28c), 0x5a97808aU);
  EXPECT_EQ(murmur_hash3_32("Hello, world!", 0x9747b28c), 0x24884cbaU);
  EXPECT_EQ(murmur_hash3_32("The quick brown fox jumps over the lazy dog", 0x9747b28c), 0x2fa826cdU);
}

}  // namespace
}  // namespace spectrace::test
