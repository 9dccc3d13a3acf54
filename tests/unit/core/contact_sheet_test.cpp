// SPDX-License-Identifier: Apache-2.0
#include "core/image/contact_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"

namespace spectrace {
namespace {

SheetItem item(int width, int height, float value, std::string caption = "") {
  Image image(width, height, {"R", "G", "B"});
  image.data.assign(image.data.size(), value);
  return {std::move(image), std::move(caption)};
}

std::size_t count(const Image& image, float value) {
  return static_cast<std::size_t>(std::count(image.data.begin(), image.data.end(), value));
}

TEST(ContactSheet, ShowsEveryPixelOfEveryImage) {
  const std::vector<SheetItem> items = {item(40, 30, 0.25f), item(20, 50, 0.5f), item(40, 50, 0.75f)};
  for (const int columns : {0, 1, 2, 3, 9}) {
    const ContactSheet sheet = make_contact_sheet(items, columns, std::nullopt);
    EXPECT_FALSE(sheet.has_captions);
    EXPECT_EQ(count(sheet.image, 0.25f), 40u * 30 * 3) << columns;
    EXPECT_EQ(count(sheet.image, 0.5f), 20u * 50 * 3) << columns;
    EXPECT_EQ(count(sheet.image, 0.75f), 40u * 50 * 3) << columns;
  }
}

TEST(ContactSheet, HasTheAskedColumns) {
  const std::vector<SheetItem> items(5, item(40, 30, 0.25f));
  const auto size = [&](int columns) {
    const ContactSheet sheet = make_contact_sheet(items, columns, std::nullopt);
    return std::pair(sheet.image.width, sheet.image.height);
  };
  // Cells of 40 x 30 with gaps of 8 around each.
  EXPECT_EQ(size(1), std::pair(8 + 48, 8 + 5 * 38));
  EXPECT_EQ(size(2), std::pair(8 + 2 * 48, 8 + 3 * 38));
  EXPECT_EQ(size(0), std::pair(8 + 3 * 48, 8 + 2 * 38));
}

TEST(ContactSheet, DrawsCaptionsBelowTheImages) {
  if (!find_caption_font()) GTEST_SKIP() << "no font found";
  const std::vector<SheetItem> items = {item(100, 20, 0, "diffraction"), item(100, 20, 0, "")};
  const ContactSheet sheet = make_contact_sheet(items, 2);
  ASSERT_TRUE(sheet.has_captions);
  const auto has_ink = [&](int x0, int x1) {
    for (int y = 28; y < sheet.image.height; ++y) {
      for (int x = x0; x < x1; ++x) {
        if (sheet.image.at(x, y, 1) > 0.5f) return true;
      }
    }
    return false;
  };
  EXPECT_TRUE(has_ink(0, 110));
  EXPECT_FALSE(has_ink(110, sheet.image.width)) << "an empty caption";
  EXPECT_EQ(count(sheet.image, 0), 2u * 100 * 20 * 3) << "no ink on the images";
}

TEST(ContactSheet, ReplacesWhatTheFontRendererGetsWrong) {
  if (!find_caption_font()) GTEST_SKIP() << "no font found";
  const ContactSheet accent = make_contact_sheet(std::vector{item(100, 20, 0, "\xc3\xa9 1")});
  const ContactSheet ascii = make_contact_sheet(std::vector{item(100, 20, 0, "? 1")});
  EXPECT_EQ(accent.image.data, ascii.image.data);
}

TEST(ContactSheet, DoesWithoutCaptionsWhereTheFontCannotBeUsed) {
  const ContactSheet sheet = make_contact_sheet(std::vector{item(40, 30, 0.25f, "x")}, 1, "/nonexistent.ttf");
  EXPECT_FALSE(sheet.has_captions);
  EXPECT_EQ(sheet.image.height, 30 + 2 * 8);
}

TEST(ContactSheet, ChecksTheCaller) {
  EXPECT_THROW(make_contact_sheet({}), InternalError);
  EXPECT_THROW(make_contact_sheet(std::vector{SheetItem{Image(2, 2, {"R"}), ""}}), InternalError);
}

}  // namespace
}  // namespace spectrace
