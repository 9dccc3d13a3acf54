// SPDX-License-Identifier: Apache-2.0
#include "separation/fill_grid.h"

#include <gtest/gtest.h>

namespace spectrace {
namespace {

constexpr HalfDifferenceGrid kGrid{.n_theta_h = 6, .n_theta_d = 2, .n_phi_d = 4};

/// The column at theta_d node 1 and phi_d node 2 after filling, all else being 1.
std::vector<float> filled(const std::vector<float>& column) {
  std::vector<float> table(kGrid.size(), 1);
  for (int h = 0; h < kGrid.n_theta_h; ++h) {
    for (int p = 0; p < kGrid.n_phi_d; ++p) table[kGrid.index(h, 1, p)] = column[std::size_t(h)];
  }
  fill_unmeasured(kGrid, table);
  std::vector<float> out;
  for (int h = 0; h < kGrid.n_theta_h; ++h) out.push_back(table[kGrid.index(h, 1, 2)]);
  return out;
}

TEST(FillGrid, ARowWithoutAValueTakesTheNearestOfThetaH) {
  constexpr float kNone = kNoValue;
  EXPECT_EQ(filled({2, 3, kNone, kNone, kNone, 7}), (std::vector<float>{2, 3, 3, 3, 7, 7}));
  EXPECT_EQ(filled({2, 3, 4, 5, kNone, kNone}), (std::vector<float>{2, 3, 4, 5, 5, 5}));
  EXPECT_EQ(filled({kNone, kNone, 4, 5, 6, 7}), (std::vector<float>{4, 4, 4, 5, 6, 7}));
  EXPECT_EQ(filled(std::vector<float>(6, kNone)), std::vector<float>(6, 0));
}

TEST(FillGrid, ANodeWithoutAValueTakesItsNeighboursInPhiD) {
  std::vector<float> table(kGrid.size(), 1);
  float* const row = &table[kGrid.index(3, 1, 0)];
  row[0] = 2, row[1] = kNoValue, row[2] = 4, row[3] = kNoValue;
  fill_unmeasured(kGrid, table);
  EXPECT_EQ(row[1], 3);
  EXPECT_EQ(row[3], 3);  // phi_d wraps around
}

TEST(FillGrid, ThePolesHoldOneValueEach) {
  std::vector<float> table(kGrid.size(), 1);
  for (int p = 0; p < kGrid.n_phi_d; ++p)
    table[kGrid.index(0, 1, p)] = table[kGrid.index(3, 0, p)] = float(p);
  fill_unmeasured(kGrid, table);
  for (int p = 0; p < kGrid.n_phi_d; ++p) {
    EXPECT_EQ(table[kGrid.index(0, 1, p)], 1.5F);
    EXPECT_EQ(table[kGrid.index(3, 0, p)], 1.5F);
  }
}

}  // namespace
}  // namespace spectrace
