// SPDX-License-Identifier: Apache-2.0
#include "core/base/nearest.h"

#include <gtest/gtest.h>

#include <vector>

namespace spectrace {
namespace {

const std::vector<std::string> kKeys{"name", "type", "roughness", "reflectance", "max_depth", "fov_deg"};

TEST(NearestName, FindsTypingErrors) {
  EXPECT_EQ(nearest_name("roughnes", kKeys), "roughness");
  EXPECT_EQ(nearest_name("relfectance", kKeys), "reflectance");
  EXPECT_EQ(nearest_name("MAX_DEPTH", kKeys), "max_depth");
  EXPECT_EQ(nearest_name("nmae", kKeys), "name");
}

TEST(NearestName, TakesTheOneWithTheFewestEdits) {
  const std::vector<std::string> names{"wall_left", "wall_right", "wall"};
  EXPECT_EQ(nearest_name("wall_rigth", names), "wall_right");
  EXPECT_EQ(nearest_name("walls", names), "wall");
}

TEST(NearestName, FindsNamesThatWereOnlyBegun) {
  EXPECT_EQ(nearest_name("fov", kKeys), "fov_deg");
  EXPECT_EQ(nearest_name("refl", kKeys), "reflectance");
  EXPECT_EQ(nearest_name("fo", kKeys), std::nullopt);
}

TEST(NearestName, SaysNothingWhereNothingIsNear) {
  EXPECT_EQ(nearest_name("emission", kKeys), std::nullopt);
  EXPECT_EQ(nearest_name("x", kKeys), std::nullopt);
  EXPECT_EQ(nearest_name("", kKeys), std::nullopt);
  EXPECT_EQ(nearest_name("name", {}), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(1000, 'n'), kKeys), std::nullopt);
}

TEST(NearestName, SuggestionIsEmptyOrAQuestion) {
  EXPECT_EQ(suggestion("tpye", kKeys), "; did you mean \"type\"?");
  EXPECT_EQ(suggestion("emission", kKeys), "");
}

}  // namespace
}  // namespace spectrace
