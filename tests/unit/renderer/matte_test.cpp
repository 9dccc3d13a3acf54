// SPDX-License-Identifier: Apache-2.0
#include "renderer/matte.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "core/base/json.h"
#include "core/base/murmur_hash.h"
#include "renderer/aovs.h"

namespace spectrace::test {
namespace {

/// As other programs' images and tests have them.
TEST(Matte, NamesHaveTheIdsOfOtherPrograms) {
  EXPECT_EQ(matte_id("bunny"), 0x13851a76U);
  EXPECT_EQ(matte_id("default"), 0x42c9679fU);
  const std::uint32_t head = matte_id("/GAFFERBOT/C_torso_GRP/C_head_GRP/C_head_CPT/C_head001_REN");
  EXPECT_EQ(head, 4226998693U);
  EXPECT_FLOAT_EQ(std::bit_cast<float>(head), -2.52222490915e+36F);
}

TEST(Matte, IdsAreNormalFloats) {
  // Found by trial: exponents 0 and 255 as hashed.
  ASSERT_EQ(murmur_hash3_32("object 259"), 0x0069b367U);
  EXPECT_EQ(matte_id("object 259"), 0x00e9b367U);
  ASSERT_EQ(murmur_hash3_32("object 858"), 0xff868043U);
  EXPECT_EQ(matte_id("object 858"), 0xff068043U);
  for (int i = 0; i < 10000; ++i) {
    const std::string name = "object " + std::to_string(i);
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(matte_id(name)))) << name;
  }
}

TEST(Matte, CountsAddUpInAnyOrder) {
  const MatteCounts a{{0, 5, 3}, {0, 9, 1}, {2, 1, 4}}, b{{0, 9, 2}, {1, 5, 7}, {2, 0, 1}, {2, 1, 1}};
  const MatteCounts both{{0, 5, 3}, {0, 9, 3}, {1, 5, 7}, {2, 0, 1}, {2, 1, 5}};
  EXPECT_EQ(sum_of(a, b), both);
  EXPECT_EQ(sum_of(b, a), both);
  EXPECT_EQ(sum_of(a, {}), a);
  PixelMatte pixel;
  for (const std::uint32_t id : {9U, 5U, 9U}) pixel.add(id);
  MatteCounts counts;
  pixel.move_to(3, counts);
  pixel.move_to(4, counts);
  EXPECT_EQ(counts, (MatteCounts{{3, 5, 1}, {3, 9, 2}})) << "each pixel begins anew";
}

TEST(Matte, RanksGoByCoverageThenId) {
  const MatteCounts counts{{0, 10, 1}, {0, 11, 4}, {0, 12, 2}, {0, 13, 2},
                           {0, 14, 1}, {0, 15, 1}, {0, 16, 1}};
  std::vector<float> ranks(2 * kMatteRanks, -1.0F);
  write_ranks(counts, 16, ranks);
  const std::vector<std::pair<std::uint32_t, float>> expected{{11, 0.25F},   {12, 0.125F},  {13, 0.125F},
                                                              {10, 0.0625F}, {14, 0.0625F}, {15, 0.0625F}};
  for (std::size_t i = 0; i < kMatteRanks; ++i) {
    EXPECT_EQ(std::bit_cast<std::uint32_t>(ranks[2 * i]), expected[i].first) << i;
    EXPECT_EQ(ranks[2 * i + 1], expected[i].second) << i;
  }
  write_ranks({}, 16, ranks);
  EXPECT_EQ(ranks, std::vector<float>(2 * kMatteRanks, 0.0F));
}

TEST(Matte, HeaderSaysWhatTheSpecificationAsksFor) {
  const MatteNames names{.names = {{{"bunny", "a \"quoted\" name", "bunny"}, {"default"}}},
                         .id_of_shape = {},
                         .id_of_instance = {},
                         .id_of_material = {}};
  Metadata metadata;
  add_matte_metadata(names, kDenoiseAovs, metadata);
  EXPECT_TRUE(metadata.empty()) << "not asked for";
  add_matte_metadata(names, kAllAovs, metadata);
  EXPECT_EQ(metadata.size(), 8U);
  const auto text = [&](const std::string& key) { return std::get<std::string>(metadata.at(key)); };
  EXPECT_EQ(text("cryptomatte/f834d0a/name"), "crypto_object") << "the key that other programs have for it";
  EXPECT_EQ(text("cryptomatte/bda530a/name"), "crypto_material");
  EXPECT_EQ(text("cryptomatte/f834d0a/hash"), "MurmurHash3_32");
  EXPECT_EQ(text("cryptomatte/f834d0a/conversion"), "uint32_to_float32");
  JsonDocument manifest = JsonDocument::parse(text("cryptomatte/f834d0a/manifest"), "manifest");
  EXPECT_EQ(manifest.root().keys(), (std::vector<std::string>{"a \"quoted\" name", "bunny"}));
  EXPECT_EQ(manifest.root().require("bunny").string(), "13851a76");
  EXPECT_EQ(text("cryptomatte/bda530a/manifest"), R"({"default":"42c9679f"})");
  for (const auto& entry : metadata) EXPECT_TRUE(is_matte_metadata(entry.first));
  EXPECT_FALSE(is_matte_metadata("spectrace:spp"));
}

}  // namespace
}  // namespace spectrace::test
