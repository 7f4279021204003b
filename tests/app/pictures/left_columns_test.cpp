// The columns of a left eye that are kept for strips of the right one.
#include <gtest/gtest.h>

#include "tests/support/support.h"
#include "vpe/app/panorama/carried_eye.h"

namespace app_test {
namespace {

using panorama::Strip;
using vpe::app::LeftColumns;
using vpe::core::Frame;

constexpr int kHeight = 3;

// Draws an image whose pixels tell their column and row, and counts how often each column is drawn.
class Drawer {
 public:
  Frame operator()(const Strip& strip) {
    Frame frame{strip.width, kHeight, {}, {}};
    for (int y = 0; y < kHeight; ++y)
      for (int n = 0; n < strip.width; ++n) {
        const auto x = static_cast<std::size_t>(strip.x + n);
        frame.colour.push_back({static_cast<std::uint8_t>(x % 251), static_cast<std::uint8_t>(y), 7});
        frame.range_m.push_back(static_cast<float>(x * 10 + static_cast<std::size_t>(y)));
        if (y > 0) continue;
        if (drawn.size() <= x) drawn.resize(x + 1);
        ++drawn[x];
      }
    return frame;
  }
  std::vector<int> drawn;
};

void expect_columns(const Frame& frame, const std::vector<Strip>& strips) {
  ASSERT_EQ(frame.height, kHeight);
  int at = 0;
  for (const Strip& strip : strips) {
    for (int n = 0; n < strip.width; ++n, ++at)
      for (int y = 0; y < kHeight; ++y) {
        const auto k = static_cast<std::size_t>(y * frame.width + at);
        ASSERT_EQ(frame.range_m.at(k), static_cast<float>((strip.x + n) * 10 + y));
        ASSERT_EQ(frame.colour.at(k).r, (strip.x + n) % 251);
      }
  }
  EXPECT_EQ(frame.width, at);
}

TEST(LeftColumns, EachColumnIsDrawnOnceWhileItIsKept) {
  LeftColumns columns;
  Drawer drawer;
  const auto draw = [&](const Strip& strip) { return drawer(strip); };
  const auto expect_join = [&](const std::vector<Strip>& strips) {
    expect_columns(columns.join(strips, draw), strips);
  };
  expect_join({{0, 40}});
  expect_join({{100, 20}});
  EXPECT_EQ(columns.kept(), 60);
  expect_join({{30, 100}, {0, 5}});  // 40 to 99 and 120 to 129 are missing
  EXPECT_EQ(columns.kept(), 130);
  EXPECT_EQ(drawer.drawn, std::vector<int>(130, 1));
  columns.keep({{0, 2}, {125, 300}});
  EXPECT_EQ(columns.kept(), 40 + 10);
  expect_join({{0, 41}});
  EXPECT_EQ(drawer.drawn[40], 2);
  EXPECT_EQ(drawer.drawn[39], 1);
  columns.keep({});
  EXPECT_EQ(columns.kept(), 0);
}

TEST(LeftColumns, AnyStripsGiveTheirColumns) {
  test_support::Random random(20261127);
  LeftColumns columns;
  Drawer drawer;
  for (int n = 0; n < 300; ++n) {
    const std::vector<Strip> strips{{random.integer(0, 200), random.integer(1, 60)},
                                    {random.integer(300, 400), random.integer(1, 60)}};
    expect_columns(columns.join(strips, [&](const Strip& strip) { return drawer(strip); }), strips);
    if (n % 3 == 0) columns.keep({{random.integer(0, 400), random.integer(1, 100)}});
  }
}

}  // namespace
}  // namespace app_test
