// Tests of the bookmarks of a project.
#include "vpe/explore/drawing/bookmark_list.h"

#include <gtest/gtest.h>

namespace vpe::explore {
namespace {

Bookmark bookmark(int key, const std::string& name) { return {key, {{10, 20, 1e5, 0, -30, 0}, 50}, name}; }

TEST(BookmarkList, RenamesWithUndo) {
  BookmarkList list;
  ASSERT_EQ(list.put(bookmark(3, "three")), "");
  ASSERT_EQ(list.put(bookmark(0, "crater")), "");
  const std::uint64_t revision = list.revision();
  EXPECT_EQ(list.rename(1, "  rim "), "");
  EXPECT_EQ(list.all()[1].name, "rim");
  EXPECT_EQ(list.all()[1].view.pose.lon_deg, 10);
  EXPECT_EQ(list.all()[0].name, "three");
  EXPECT_GT(list.revision(), revision);
  EXPECT_EQ(list.undo_text(), "rename bookmark 'crater'");
  EXPECT_TRUE(list.undo());
  EXPECT_EQ(list.all()[1].name, "crater");
}

TEST(BookmarkList, RefusesNamesThatItCannotKeep) {
  BookmarkList list;
  ASSERT_EQ(list.put(bookmark(0, "a")), "");
  ASSERT_EQ(list.put(bookmark(0, "b")), "");
  const std::uint64_t revision = list.revision();
  EXPECT_NE(list.rename(1, "a").find("another bookmark"), std::string::npos);
  EXPECT_NE(list.rename(1, "  "), "");
  EXPECT_NE(list.rename(1, "two\nlines"), "");
  EXPECT_NE(list.rename(2, "c"), "");
  EXPECT_EQ(list.rename(1, "b"), "");  // as it was
  EXPECT_EQ(list.revision(), revision);
}

}  // namespace
}  // namespace vpe::explore
