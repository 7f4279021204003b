// The line between two planets: where it is taken, how far it goes.
#include "vpe/window/swipe_line.h"

#include <gtest/gtest.h>

namespace vpe::window {
namespace {

constexpr ViewArea kArea{100, 50, 400, 300};

TEST(SwipeLine, IsTakenNearItselfAndFollowsTheCursor) {
  SwipeLine line;
  EXPECT_FALSE(line.is_on());
  EXPECT_FALSE(line.press(kArea, {300, 200}, 1));
  line.set_on(true);
  EXPECT_EQ(line.x_px(kArea), 300);
  EXPECT_FALSE(line.press(kArea, {309, 200}, 1));
  EXPECT_FALSE(line.press(kArea, {300, 20}, 1));  // above the view
  EXPECT_TRUE(line.press(kArea, {309, 200}, 2));
  EXPECT_TRUE(line.release());
  EXPECT_FALSE(line.drag(kArea, {200, 200}));
  ASSERT_TRUE(line.press(kArea, {305, 200}, 1));
  // It keeps its distance from the cursor.
  EXPECT_TRUE(line.drag(kArea, {205, 90}));
  EXPECT_EQ(line.x_px(kArea), 200);
  EXPECT_EQ(line.share(), 0.25);
  EXPECT_TRUE(line.is_at(kArea, {450, 200}, 1));  // held
  EXPECT_TRUE(line.release());
  EXPECT_FALSE(line.release());
  EXPECT_FALSE(line.is_at(kArea, {450, 200}, 1));
}

TEST(SwipeLine, StaysInTheView) {
  SwipeLine line;
  line.set_on(true);
  ASSERT_TRUE(line.press(kArea, {300, 200}, 1));
  line.drag(kArea, {-1000, 200});
  EXPECT_EQ(line.share(), SwipeLine::kMargin);
  line.drag(kArea, {1e6, 200});
  EXPECT_EQ(line.share(), 1 - SwipeLine::kMargin);
  line.release();
  for (int n = 0; n < 100; ++n) line.move_by(-SwipeLine::kStep);
  EXPECT_EQ(line.share(), SwipeLine::kMargin);
  line.move_by(SwipeLine::kStep);
  EXPECT_DOUBLE_EQ(line.share(), SwipeLine::kMargin + SwipeLine::kStep);
}

TEST(SwipeLine, IsLetGoWhenSwitchedOff) {
  SwipeLine line;
  line.set_on(true);
  ASSERT_TRUE(line.press(kArea, {300, 200}, 1));
  line.set_on(false);
  EXPECT_FALSE(line.drag(kArea, {200, 200}));
  EXPECT_FALSE(line.is_at(kArea, {300, 200}, 1));
}

}  // namespace
}  // namespace vpe::window
