// Tests the rows of vector files and image layers, and the settings that they make.
#include "vpe/explore/layers/layer_rows.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

namespace vpe::explore {
namespace {

std::string text_of(const FileRows& rows) {
  std::string text;
  for (const auto& row : rows)
    text += (text.empty() ? "" : " ") + std::string(row.is_on ? "" : "-") + row.item.path;
  return text;
}
std::string text_of(const ImageRows& rows) {
  std::string text;
  for (const auto& row : rows)
    text += (text.empty() ? "" : " ") + std::string(row.is_on ? "" : "-") + row.item.name;
  return text;
}

TEST(FileRows, ALayerThatIsOffKeepsItsPlace) {
  FileRows rows = rows_of({}, "a.gpkg;b.shp@0.5;c.kml");
  EXPECT_EQ(text_of(rows), "a.gpkg b.shp c.kml");
  rows[1].is_on = false;
  EXPECT_EQ(setting_of(rows), "a.gpkg;c.kml");
  EXPECT_EQ(rows_of(rows, "a.gpkg;c.kml"), rows);
  // A setting from elsewhere, such as a flight's: others are off.
  EXPECT_EQ(text_of(rows_of(rows, "c.kml;d.csv")), "-a.gpkg -b.shp c.kml d.csv");
  EXPECT_EQ(text_of(rows_of(rows, "a.gpkg;b.shp;c.kml")), "a.gpkg b.shp c.kml");
  EXPECT_EQ(text_of(rows_of(rows, "")), "-a.gpkg -b.shp -c.kml");
  EXPECT_EQ(rows_of(rows, "")[1].item.opacity, 0.5);
  EXPECT_EQ(text_of(rows_of({}, "a.gpkg@7")), "");
}

TEST(FileRows, FilesAreAddedMovedAndRefused) {
  FileRows rows = rows_of({}, "a.gpkg");
  EXPECT_EQ(add_file(rows, "b.shp"), "");
  EXPECT_EQ(text_of(rows), "a.gpkg b.shp");
  rows[0].is_on = false;
  EXPECT_EQ(add_file(rows, "a.gpkg"), "");
  EXPECT_EQ(text_of(rows), "a.gpkg b.shp");
  for (const char* bad : {"", "x;y.gpkg", "x@0.5", "x@5"})
    EXPECT_NE(add_file(rows, bad).find("cannot be a layer"), std::string::npos) << bad;
  EXPECT_EQ(add_file(rows, "x@y.gpkg"), "");
  EXPECT_TRUE(move_by_one(rows, 0, true));
  EXPECT_EQ(text_of(rows), "b.shp a.gpkg x@y.gpkg");
  EXPECT_TRUE(move_by_one(rows, 1, false));
  EXPECT_EQ(text_of(rows), "a.gpkg b.shp x@y.gpkg");
  EXPECT_FALSE(move_by_one(rows, 0, false));
  EXPECT_FALSE(move_by_one(rows, 2, true));
  EXPECT_FALSE(move_by_one(rows, 9, true));
}

// Whatever is switched, moved and set: the rows show the setting, and none is lost.
RC_GTEST_PROP(FileRows, ShowTheSettingAndForgetNothing, ()) {
  FileRows rows = rows_of({}, "a;b;c;d");
  for (int n = 0; n < 12; ++n) {
    const auto index = static_cast<std::size_t>(*rc::gen::inRange(0, 4));
    switch (*rc::gen::inRange(0, 3)) {
      case 0: rows[index].is_on = !rows[index].is_on; break;
      case 1: move_by_one(rows, index, *rc::gen::arbitrary<bool>()); break;
      default: {
        std::vector<core::LayerFile> on = items_on(rows);
        if (!on.empty()) std::rotate(on.begin(), on.begin() + 1, on.end());
        const std::string setting = core::layer_list_text(on);
        rows = rows_of(rows, setting);
        RC_ASSERT(setting_of(rows) == setting);
      }
    }
    RC_ASSERT(rows.size() == 4U);
    RC_ASSERT(rows_of(rows, setting_of(rows)) == rows);
  }
}

TEST(ImageRows, ComeFromThePlanetAndTheSetting) {
  const std::vector<std::string> names{"viking", "ctx", "hirise"};
  ImageRows rows = rows_of(ImageRows{}, "", names);
  EXPECT_EQ(text_of(rows), "viking ctx hirise");
  EXPECT_EQ(setting_of(rows), "viking;ctx;hirise");
  EXPECT_EQ(rows_of(rows, "viking;ctx;hirise", names), rows);
  rows[1].item.opacity = 0.6;
  rows[1].item.gamma = 1.4;
  rows[2].is_on = false;
  EXPECT_EQ(setting_of(rows), "viking;ctx@0.6 gamma=1.4");
  EXPECT_EQ(rows_of(rows, setting_of(rows), names), rows);
  EXPECT_EQ(text_of(rows_of(rows, "hirise;other;viking", names)), "hirise viking -ctx");
  EXPECT_EQ(text_of(rows_of(ImageRows{}, "hirise", names)), "-viking -ctx hirise");
  // An empty setting is the imagery as built.
  EXPECT_EQ(rows_of(rows, "", names), rows_of(ImageRows{}, "", names));
  EXPECT_TRUE(rows_of(rows, "viking", {}).empty());
  for (auto& row : rows) row.is_on = false;
  EXPECT_EQ(setting_of(rows), "viking@0");
  EXPECT_EQ(rows_of(rows, "viking@0", names), rows);
  EXPECT_EQ(setting_of(ImageRows{}), "");
}

}  // namespace
}  // namespace vpe::explore
