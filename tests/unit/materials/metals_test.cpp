// SPDX-License-Identifier: Apache-2.0
#include "materials/metals.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "materials/fresnel.h"
#include "tests/support/test_data.h"

namespace spectrace {
namespace {

TEST(Metals, AreWhatTheDatabaseHolds) {
  const std::map<std::string, std::string> files{{"Ag", "Ag_Johnson"}, {"Al", "Al_Rakic"},
                                                 {"Au", "Au_Johnson"}, {"Cr", "Cr_Johnson"},
                                                 {"Cu", "Cu_Johnson"}, {"Ti", "Ti_Johnson"}};
  ASSERT_EQ(files.size(), kMetalNames.size());
  for (const auto& [name, stem] : files) {
    const auto file = test::data_folder() / "metals" / (stem + ".yml");
    SPECTRACE_SKIP_WITHOUT(file);
    const RefractiveIndex metal = named_metal(name), published = read_refractive_index(file);
    const Float last = name == "Al" ? 2000 : 1937;  // where Johnson & Christy end
    for (Float nm = 200; nm <= last; nm += Float(0.5)) {
      ASSERT_NEAR(metal.eta.at(nm) / published.eta.at(nm), 1, 1e-5) << name << " " << nm;
      ASSERT_NEAR(metal.k.at(nm) / published.k.at(nm), 1, 1e-5) << name << " " << nm;
    }
  }
}

double reflectance(std::string_view name, Float nm) {
  const RefractiveIndex metal = named_metal(name);
  return double(fresnel_conductor(1, metal.eta.at(nm), metal.k.at(nm)));
}

TEST(Metals, LookLikeThemselves) {
  // Silver and aluminium white, gold yellow, copper red, chromium and titanium grey.
  EXPECT_GT(reflectance("Ag", 450), 0.95);
  EXPECT_GT(reflectance("Al", 450), 0.9);
  EXPECT_LT(reflectance("Au", 450), 0.45);
  EXPECT_GT(reflectance("Au", 600), 0.9);
  EXPECT_LT(reflectance("Cu", 500), 0.6);
  EXPECT_GT(reflectance("Cu", 650), 0.9);
  EXPECT_NEAR(reflectance("Cr", 450), reflectance("Cr", 650), 0.1);
  EXPECT_LT(reflectance("Ti", 550), 0.65);
}

}  // namespace
}  // namespace spectrace
