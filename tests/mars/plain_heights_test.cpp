// Grids of heights that lie nowhere on a planet.
#include "mars/raster/elevation/plain_heights.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mars/sources/source.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace mars {
namespace {

class PlainHeightsTest : public ::testing::Test {
 protected:
  std::string write(const source_files::Raster& raster, const std::string& name = "a.tif") const {
    return source_files::write(dir_ / name, raster);
  }
  static std::string error_of(const std::string& path) {
    try {
      (void)read_plain_heights(path);
    } catch (const SourceError& e) {
      return e.what();
    }
    return "";
  }
  test_support::TempDir dir_;
};

source_files::Raster plain(int width, int height) {
  source_files::Raster raster;
  raster.width = width;
  raster.height = height;
  raster.crs = "";
  raster.value = [](int, int column, int row) { return 10.0 * row + column; };
  return raster;
}

TEST_F(PlainHeightsTest, NeedNoGeoreference) {
  const PlainHeights heights = read_plain_heights(write(plain(4, 3)));
  ASSERT_EQ(heights.columns, 4);
  ASSERT_EQ(heights.rows, 3);
  EXPECT_EQ(heights.heights_m, (std::vector<float>{0, 1, 2, 3, 10, 11, 12, 13, 20, 21, 22, 23}));
}

TEST_F(PlainHeightsTest, HaveScaleOffsetAndUnit) {
  source_files::Raster raster = plain(3, 2);
  raster.type = GDT_Int16;
  raster.scale = 0.5;
  raster.offset = 2;
  raster.unit = "km";
  const PlainHeights heights = read_plain_heights(write(raster));
  EXPECT_EQ(heights.heights_m, (std::vector<float>{2000, 2500, 3000, 7000, 7500, 8000}));
}

TEST_F(PlainHeightsTest, NodataIsNotANumber) {
  source_files::Raster raster = plain(3, 2);
  raster.nodata = 11;
  raster.value = [](int, int column, int row) { return row == 0 && column == 0 ? NAN : 10.0 * row + column; };
  const PlainHeights heights = read_plain_heights(write(raster));
  for (std::size_t n = 0; n < heights.heights_m.size(); ++n)
    EXPECT_EQ(std::isnan(heights.heights_m[n]), n == 0 || n == 4) << n;
}

TEST_F(PlainHeightsTest, RefuseWhatIsNoRasterOfHeights) {
  EXPECT_NE(error_of((dir_ / "none.tif").string()).find("none.tif"), std::string::npos);
  source_files::write_text(dir_ / "text.tif", "no raster");
  EXPECT_NE(error_of((dir_ / "text.tif").string()).find("text.tif"), std::string::npos);
  source_files::Raster colours = plain(4, 4);
  colours.bands = 3;
  colours.type = GDT_Byte;
  colours.colours = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
  EXPECT_NE(error_of(write(colours, "c.tif")).find("is a colour image, not elevation"), std::string::npos);
}

}  // namespace
}  // namespace mars
