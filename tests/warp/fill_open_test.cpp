// Open pixels that nothing can draw are filled from behind.
#include "vpe/warp/fill_open.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

#include "tests/support/support.h"

namespace vpe::warp {
namespace {

constexpr float kSky = std::numeric_limits<float>::infinity();

// Makes an image of rows of letters: o is open, s sky, others ground whose range is the letter's place in the alphabet.
CarriedImage image_of(const std::vector<std::string>& rows) {
  CarriedImage image;
  image.width = static_cast<int>(rows.front().size());
  image.height = static_cast<int>(rows.size());
  for (const std::string& row : rows) {
    for (const char c : row) {
      const Origin origin = c == 'o' ? Origin::kOpen : c == 's' ? Origin::kSky : Origin::kCarried;
      image.origin.push_back(origin);
      image.range_m.push_back(c == 'o' ? 0.0F : c == 's' ? kSky : static_cast<float>(c - 'a' + 1));
      const auto level = static_cast<std::uint8_t>(c == 'o' ? 0 : c);
      image.colour.push_back({level, level, level});
      ++image.pixels[static_cast<std::size_t>(origin)];
    }
  }
  return image;
}

std::vector<std::string> rows_of(const CarriedImage& image) {
  std::vector<std::string> rows;
  for (int y = 0; y < image.height; ++y) {
    std::string row;
    for (int x = 0; x < image.width; ++x)
      row += static_cast<char>(image.colour[static_cast<std::size_t>(y * image.width + x)].r);
    rows.push_back(row);
  }
  return rows;
}

TEST(FillOpen, RunsTakeTheFartherSide) {
  CarriedImage image = image_of({"booda", "doooe", "ooocc", "ccooo", "sooba", "aoosb"});
  EXPECT_EQ(fill_open(image), 15);
  EXPECT_EQ(rows_of(image), (std::vector<std::string>{"bddda", "deeee", "ccccc", "ccccc", "sssba", "asssb"}));
  EXPECT_EQ(image.range_m[1], 4);
  EXPECT_EQ(image.range_m[4 * 5 + 1], kSky);
  // They still can be told from what was carried.
  EXPECT_EQ(std::ranges::count(image.origin, Origin::kOpen), 15);
}

TEST(FillOpen, OpenRowsTakeTheRowAboveOrTheFirstBelow) {
  CarriedImage image = image_of({"ooo", "ooo", "abc", "ooo", "dod"});
  EXPECT_EQ(fill_open(image), 10);
  EXPECT_EQ(rows_of(image), (std::vector<std::string>{"abc", "abc", "abc", "abc", "ddd"}));
  CarriedImage open = image_of({"oo", "oo"});
  EXPECT_EQ(fill_open(open), 4);
  EXPECT_EQ(open.range_m, std::vector<float>(4, 0.0F));
  CarriedImage none;
  EXPECT_EQ(fill_open(none), 0);
}

TEST(FillOpen, LeavesTheRestAndNeedsNoColours) {
  test_support::Random random(7);
  for (int n = 0; n < 200; ++n) {
    std::vector<std::string> rows;
    const int width = random.integer(1, 12);
    for (int y = random.integer(1, 6); y > 0; --y) {
      std::string row;
      for (int x = 0; x < width; ++x) row += "abcdesooo"[random.integer(0, 8)];
      rows.push_back(row);
    }
    const CarriedImage before = image_of(rows);
    CarriedImage after = before;
    CarriedImage without = before;
    without.colour.clear();
    EXPECT_EQ(fill_open(after), before.count(Origin::kOpen));
    EXPECT_EQ(fill_open(without), before.count(Origin::kOpen));
    EXPECT_EQ(without.range_m, after.range_m);
    const bool has_any = before.count(Origin::kOpen) < static_cast<std::int64_t>(before.origin.size());
    for (std::size_t k = 0; k < after.origin.size(); ++k) {
      if (before.origin[k] != Origin::kOpen) {
        EXPECT_EQ(after.colour[k], before.colour[k]);
        EXPECT_EQ(after.range_m[k], before.range_m[k]);
      } else if (has_any) {
        EXPECT_GT(after.range_m[k], 0);
      }
    }
  }
}

}  // namespace
}  // namespace vpe::warp
