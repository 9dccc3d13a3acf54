// SPDX-License-Identifier: Apache-2.0
#include "core/image/channel_groups.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace spectrace {
namespace {

using Names = std::vector<std::string>;

std::vector<ChannelGroup> groups_of(Names channels) {
  return channel_groups(Image(1, 1, std::move(channels)), "f");
}
Names names_of(const std::vector<ChannelGroup>& groups) {
  Names names;
  for (const ChannelGroup& group : groups) names.push_back(group.name);
  return names;
}

TEST(ChannelGroups, AreTheLayersOfAnImage) {
  const auto groups =
      groups_of({"R", "G", "B", "A", "Z", "a.b.R", "a.b.G", "a.b.B", "depth.Z", "normal.X", "normal.Y",
                 "normal.Z", "diffuse.R", "diffuse.G", "diffuse.B", "diffuse.A", "half.R"});
  EXPECT_EQ(names_of(groups), (Names{"beauty", "A", "Z", "a.b", "depth", "normal", "diffuse", "half"}));
  EXPECT_EQ(find_group(groups, "beauty")->kind, GroupKind::kColour);
  EXPECT_EQ(find_group(groups, "normal")->kind, GroupKind::kNumbers);
  EXPECT_EQ(find_group(groups, "normal")->channels, (Names{"normal.X", "normal.Y", "normal.Z"}));
  EXPECT_EQ(find_group(groups, "diffuse")->indices, (std::vector<std::size_t>{12, 13, 14}))
      << "without alpha";
  EXPECT_EQ(find_group(groups, "half")->kind, GroupKind::kNumbers) << "R alone is no colour";
  EXPECT_EQ(find_group(groups, "none"), nullptr);
}

TEST(ChannelGroups, PutWavelengthsInOrder) {
  const auto groups =
      groups_of({"R", "G", "B", "S0.1000,5nm", "S0.400,000000nm", "S0.50,5E1nm", "T.1um", "T.600nm"});
  EXPECT_EQ(names_of(groups), (Names{"beauty", "S0", "T"}));
  EXPECT_EQ(groups[1].kind, GroupKind::kSpectrum);
  EXPECT_EQ(groups[1].lambda_nm, (std::vector<double>{400, 505, 1000.5}));
  EXPECT_EQ(groups[1].indices, (std::vector<std::size_t>{4, 5, 3}));
  EXPECT_THROW(groups_of({"S0.5x0nm", "S0.400nm"}), InputError);
}

TEST(ChannelGroups, KnowTheStatisticsOfALayer) {
  const auto groups = groups_of({"R", "G", "B", "beauty_variance.R", "beauty_variance.G", "beauty_variance.B",
                                 "diffuse_a.Z", "diffuse_b.Z", "diffuse.Z", "vitamin_a.Z"});
  const auto is = [&](const char* name) { return is_statistic(*find_group(groups, name), groups); };
  EXPECT_TRUE(is("beauty_variance") && is("diffuse_a") && is("diffuse_b"));
  EXPECT_FALSE(is("beauty") || is("diffuse") || is("vitamin_a"));
  EXPECT_EQ(variance_of("beauty"), "beauty_variance");
}

TEST(ChannelGroups, BecomeImages) {
  Image image(2, 1, {"a.Y", "R", "G", "B"});
  image.data = {1, 2, 3, 4, 5, 6, 7, 8};
  const Image rgb = group_image(image, *find_group(channel_groups(image, "f"), "beauty"));
  EXPECT_EQ(rgb.channels, (Names{"R", "G", "B"}));
  EXPECT_EQ(rgb.data, (std::vector<float>{2, 3, 4, 6, 7, 8}));
}

}  // namespace
}  // namespace spectrace
