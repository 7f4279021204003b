// Every unusable vector file gives one message that names the file, the failure and what to do.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <string>

#include "mars/vector/feature_reader.h"
#include "tests/mars/vector/vector_files.h"
#include "tests/support/support.h"

namespace {

using vector_files::collection;
using vector_files::expect_words;
using vector_files::feature;
using vector_files::read;
using vector_files::read_error;
using vector_files::translate;
using vector_files::write_text;

class VectorErrors : public ::testing::Test {
 protected:
  // Returns the error of a GeoJSON file of one good feature and one with this geometry.
  std::string geometry_error(const std::string& geometry) const {
    const auto path = folder_ / "g.json";
    write_text(path, collection({feature(R"({"type":"Point","coordinates":[1,2]})"), feature(geometry)}));
    return read_error(path);
  }

  std::filesystem::path lines(int count) const {
    std::vector<std::string> features;
    for (int i = 0; i < count; ++i)
      features.push_back(
          feature(R"({"type":"LineString","coordinates":[[0,0],[1,1],[2,0]]})", R"({"name":"abcdefgh"})"));
    write_text(folder_ / "many.geojson", collection(features));
    return folder_ / "many.geojson";
  }

  test_support::TempDir folder_;
};

TEST_F(VectorErrors, Names) {
  expect_words(read_error(folder_ / "none.shp"), {"none.shp", "cannot open", "No such file", "check the name"});
  expect_words(read_error(""), {"cannot open"});
  std::filesystem::create_directory(folder_ / "folder.shp");
  expect_words(read_error(folder_ / "folder.shp"), {"folder.shp", "it is a folder"});
  ASSERT_EQ(mkfifo((folder_ / "pipe.json").c_str(), 0600), 0);
  expect_words(read_error(folder_ / "pipe.json"), {"pipe.json", "no regular file"});
  write_text(folder_ / "a.dxf", "0");
  expect_words(read_error(folder_ / "a.dxf"), {"a.dxf", "extension", ".gpkg"});
  write_text(folder_ / "noextension", "0");
  expect_words(read_error(folder_ / "noextension"), {"noextension", "extension"});
  write_text(folder_ / "locked.json", collection({}));
  EXPECT_TRUE(read(folder_ / "locked.json").empty());
}

TEST_F(VectorErrors, NotOfTheFormat) {
  for (const char* name : {"a.gpkg", "a.geojson", "a.shp", "a.kml", "a.kmz", "a.gpx"}) {
    SCOPED_TRACE(name);
    write_text(folder_ / name, "nothing but words\n");
    expect_words(read_error(folder_ / name), {name});
    write_text(folder_ / name, "");
    expect_words(read_error(folder_ / name), {name});
  }
  write_text(folder_ / "a.csv", "");
  expect_words(read_error(folder_ / "a.csv"), {"a.csv"});
}

TEST_F(VectorErrors, Coordinates) {
  expect_words(geometry_error(R"({"type":"Point","coordinates":[NaN,2]})"),
               {"g.json", "layer 'g'", "feature 1", "finite"});
  expect_words(geometry_error(R"({"type":"Point","coordinates":[1e999,2]})"), {"feature 1"});
  expect_words(geometry_error(R"({"type":"LineString","coordinates":[[1,2],[2,-Infinity]]})"),
               {"feature 1", "finite"});
  expect_words(geometry_error(R"({"type":"Point","coordinates":[1,90.001]})"), {"feature 1", "is no place"});
  expect_words(geometry_error(R"({"type":"Point","coordinates":[1,-91]})"), {"feature 1", "is no place"});
  expect_words(geometry_error(R"({"type":"Point","coordinates":[40000,1]})"), {"feature 1", "is no place"});
  expect_words(geometry_error(R"({"type":"Point","coordinates":["a",2]})"), {"g.json"});
  expect_words(geometry_error(R"({"type":"LineString","coordinates":[[1,2]]})"), {"feature 1", "line"});
  EXPECT_EQ(geometry_error(R"({"type":"Point","coordinates":[400,90]})"), "");
}

TEST_F(VectorErrors, Rings) {
  expect_words(geometry_error(R"({"type":"Polygon","coordinates":[[[1,2],[3,4],[1,2]]]})"),
               {"feature 1", "fewer than 3 places"});
  expect_words(geometry_error(R"({"type":"Polygon","coordinates":[[[1,2],[1,2],[1,2],[1,2],[1,2]]]})"),
               {"feature 1", "fewer than 3 places"});
  expect_words(
      geometry_error(R"({"type":"Polygon","coordinates":[[[0,0],[9,0],[9,9],[0,0]],[[1,1],[2,1],[1,1]]]})"),
      {"feature 1", "fewer than 3 places"});
  // A ring that crosses itself, and one that is not closed.
  EXPECT_EQ(geometry_error(R"({"type":"Polygon","coordinates":[[[0,0],[1,1],[1,0],[0,1],[0,0]]]})"), "");
  EXPECT_EQ(geometry_error(R"({"type":"Polygon","coordinates":[[[0,0],[1,1],[1,0]]]})"), "");
}

TEST_F(VectorErrors, Csv) {
  const auto error = [&](const std::string& text, const mars::FeatureReadOptions& options = {}) {
    write_text(folder_ / "t.csv", text);
    return read_error(folder_ / "t.csv", options);
  };
  expect_words(error("name,east,north\nA,1,2\n"),
               {"t.csv", "no columns of longitude and latitude", "\"east\"", "WKT"});
  expect_words(error("lon,lat\n1,2\n3,x4\n"), {"t.csv", "feature 2", "\"lat\"", "\"x4\"", "expected degrees"});
  expect_words(error("lon;lat\n1,5;2,5\n"), {"feature 1", "\"1,5\""});
  expect_words(error("lon,lat\n1,\n"), {"feature 1", "\"lat\""});
  expect_words(error("lon,lat\nnan,2\n"), {"feature 1", "\"nan\""});
  expect_words(error("lon,lat\n0x10,2\n"), {"feature 1", "\"0x10\""});
  expect_words(error("lon,lat\n1,95\n"), {"feature 1", "is no place"});
  expect_words(error("WKT,a\nPOINT (1),1\n"), {"feature 1", "WKT", "POINT (137.44 -4.59)"});
  expect_words(error("WKT,a\nPOINT (1 2) POINT (3 4),1\n"), {"feature 1", "WKT"});
  expect_words(error("WKT,a\nPOINT (nan 2),1\n"), {"feature 1"});
  mars::FeatureReadOptions options;
  options.lon_column = "east";
  expect_words(error("east,north\n1,2\n", options), {"has no column", "latitudes"});
  options.lat_column = "south";
  expect_words(error("east,north\n1,2\n", options), {"has no column \"south\"", "\"north\""});
}

TEST_F(VectorErrors, Limits) {
  const auto path = lines(100);
  mars::FeatureReadOptions options;
  options.most_vertices = 300;
  EXPECT_EQ(read(path, options).at(0).features.size(), 100U);
  options.most_vertices = 299;
  expect_words(read_error(path, options), {"many.geojson", "feature 99", "299 vertices", "-simplify"});
  options.most_vertices = 20;
  expect_words(read_error(path, options), {"feature 6", "20 vertices"});
  options = {};
  options.most_bytes = 1000;
  expect_words(read_error(path, options), {"many.geojson", "bytes are more than the 1000"});
  // Attributes of a file that is smaller than what is made of it.
  options.most_bytes = std::filesystem::file_size(path);
  EXPECT_EQ(read_error(path, options), "");
  // Rows without places count too.
  std::string rows = "lon,lat\n";
  for (int i = 0; i < 50; ++i) rows += ",\n";
  write_text(folder_ / "rows.csv", rows);
  options = {};
  options.most_vertices = 20;
  expect_words(read_error(folder_ / "rows.csv", options), {"rows.csv", "feature 21", "20 vertices"});
}

TEST_F(VectorErrors, TruncatedFiles) {
  const auto path = lines(200);
  for (const auto& [driver, name] : {std::pair{"GPKG", "t.gpkg"}, std::pair{"ESRI Shapefile", "t.shp"},
                                     std::pair{"LIBKML", "t.kml"}, std::pair{"LIBKML", "t.kmz"}}) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(translate(path, folder_ / name, {"-f", driver}));
    EXPECT_EQ(read_error(folder_ / name), "");
    std::filesystem::resize_file(folder_ / name, std::filesystem::file_size(folder_ / name) / 2);
    expect_words(read_error(folder_ / name), {name});
  }
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  expect_words(read_error(path), {"many.geojson"});
  // A Shapefile without its index.
  ASSERT_TRUE(translate(lines(3), folder_ / "i.shp", {"-f", "ESRI Shapefile"}));
  std::filesystem::remove(folder_ / "i.shx");
  expect_words(read_error(folder_ / "i.shp"), {"i.shp", "shx"});
}

}  // namespace
