// Tests vector files read for drawing, and their colours.
#include "vpe/overlay/layer_files.h"

#include <gtest/gtest.h>

#include <string_view>

#include "mars/sources/source.h"
#include "mars/vector/vector_file.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace overlay_test {
namespace {

using vpe::overlay::LayerFeatures;
using vpe::overlay::read_layer_file;

TEST(LayerFiles, LayersHaveDifferentColoursByNumber) {
  const test_support::TempDir folder;
  vpe::base::write_file(folder / "a.csv", std::string_view("name,lon,lat\nA,10,20\nB,11,21\n"));
  const std::string path = (folder / "a.csv").string();
  const LayerFeatures first = read_layer_file(path, 3396190, 0);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0]->layer().features.size(), 2U);
  const LayerFeatures second = read_layer_file(path, 3396190, 1);
  EXPECT_NE(first[0]->style(0).marker->rgb, second[0]->style(0).marker->rgb);
  EXPECT_EQ(first[0]->style(0).marker->rgb, read_layer_file(path, 3396190, 7)[0]->style(0).marker->rgb);
  EXPECT_THROW(read_layer_file((folder / "none.csv").string(), 3396190, 0), mars::SourceError);
}

TEST(LayerFiles, ExtensionsNameFormats) {
  for (const char* path :
       {"a.gpkg", "b.GeoJSON", "c.json", "d.shp", "e.kml", "f.KMZ", "g.gpx", "h.csv", "i.tsv"})
    EXPECT_TRUE(mars::has_vector_extension(path)) << path;
  for (const char* path : {"", "a", "gpkg", "a.gpkg.zip", "b.tif", "c.vpe"})
    EXPECT_FALSE(mars::has_vector_extension(path)) << path;
}

}  // namespace
}  // namespace overlay_test
