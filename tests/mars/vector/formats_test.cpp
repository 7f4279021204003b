// Every format gives the same features, whoever wrote it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "mars/vector/feature_reader.h"
#include "tests/mars/vector/vector_files.h"
#include "tests/support/support.h"

namespace {

using mars::Feature;
using mars::FeatureLayer;
using mars::ShapeKind;
using vector_files::collection;
using vector_files::feature;
using vector_files::read;
using vector_files::translate;
using vector_files::write_text;

const std::string kPoint = R"({"type":"Point","coordinates":[137.4417,-4.5895,-4500]})";
const std::string kLine = R"({"type":"LineString","coordinates":[[137.1,-4.1],[137.2,-4.2],[137.35,-4.25]]})";
const std::string kHole =
    R"({"type":"Polygon","coordinates":[[[10,10],[20,10],[20,20],[10,20],[10,10]],[[12,12],[12,14],[14,14],[12,12]]]})";
const std::string kMulti = R"({"type":"MultiPoint","coordinates":[[1,2],[3,4]]})";

class VectorFormats : public ::testing::Test {
 protected:
  test_support::TempDir folder_;

  // The one feature of the one layer that a file has.
  static Feature only(const std::filesystem::path& path) {
    const auto layers = read(path);
    if (layers.size() != 1 || layers[0].features.size() != 1) {
      ADD_FAILURE() << path << " has " << layers.size() << " layers";
      return {};
    }
    return layers[0].features[0];
  }

  std::filesystem::path geojson(const std::string& geometry) const {
    const auto path = folder_ / "in.geojson";
    write_text(path, collection({feature(geometry, R"({"name":"Yellowknife","depth":2.5,"sol":124})")}));
    return path;
  }
};

void expect_near(const std::vector<glm::dvec2>& ring, const std::vector<glm::dvec2>& expected) {
  ASSERT_EQ(ring.size(), expected.size());
  for (std::size_t i = 0; i < ring.size(); ++i) {
    EXPECT_NEAR(ring[i].x, expected[i].x, 1e-9);
    EXPECT_NEAR(ring[i].y, expected[i].y, 1e-9);
  }
}

TEST_F(VectorFormats, GeoJsonKinds) {
  const auto path = folder_ / "kinds.json";
  write_text(path, collection({feature(kPoint), feature(kLine), feature(kHole), feature(kMulti),
                               feature(R"({"type":"GeometryCollection","geometries":[)" + kPoint + "," +
                                       kMulti + "," + kLine + "]}"),
                               feature("null")}));
  const auto layers = read(path);
  ASSERT_EQ(layers.size(), 1U);
  const auto& features = layers[0].features;
  ASSERT_EQ(features.size(), 6U);
  EXPECT_EQ(layers[0].name, "kinds");
  expect_near(features[0].shapes.at(0).rings.at(0), {{137.4417, -4.5895}});
  EXPECT_EQ(features[0].shapes[0].kind, ShapeKind::point);
  EXPECT_EQ(features[1].shapes.at(0).kind, ShapeKind::line);
  expect_near(features[1].shapes[0].rings.at(0), {{137.1, -4.1}, {137.2, -4.2}, {137.35, -4.25}});
  EXPECT_EQ(features[2].shapes.at(0).kind, ShapeKind::polygon);
  ASSERT_EQ(features[2].shapes[0].rings.size(), 2U);
  expect_near(features[2].shapes[0].rings[1], {{12, 12}, {12, 14}, {14, 14}, {12, 12}});
  EXPECT_EQ(features[3].shapes.size(), 2U);
  EXPECT_EQ(features[4].shapes.size(), 4U);
  EXPECT_TRUE(features[5].shapes.empty());
}

TEST_F(VectorFormats, GdalWritesAllFormats) {
  struct Case {
    std::string driver;
    std::string file;
    std::string geometry;
  };
  const std::vector<Case> cases{{"GPKG", "a.gpkg", kPoint},
                                {"GPKG", "b.gpkg", kLine},
                                {"GPKG", "c.gpkg", kHole},
                                {"ESRI Shapefile", "a.shp", kPoint},
                                {"ESRI Shapefile", "b.shp", kLine},
                                {"ESRI Shapefile", "c.shp", kHole},
                                {"LIBKML", "a.kml", kPoint},
                                {"LIBKML", "b.kml", kLine},
                                {"LIBKML", "c.kml", kHole},
                                {"LIBKML", "a.kmz", kHole},
                                {"KML", "d.kml", kHole},
                                {"GeoJSON", "a.geojson", kHole},
                                {"GeoJSON", "B.JSON", kLine}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.driver + " " + c.file);
    const auto in = geojson(c.geometry);
    const Feature expected = only(in);
    ASSERT_TRUE(translate(in, folder_ / c.file, {"-f", c.driver}));
    const Feature got = only(folder_ / c.file);
    ASSERT_EQ(got.shapes.size(), 1U);
    ASSERT_EQ(got.shapes[0].rings.size(), expected.shapes[0].rings.size());
    EXPECT_EQ(got.shapes[0].kind, expected.shapes[0].kind);
    for (std::size_t i = 0; i < got.shapes[0].rings.size(); ++i) {
      std::vector<glm::dvec2> ring = got.shapes[0].rings[i];
      const auto& wanted = expected.shapes[0].rings[i];
      // Shapefile and KML have directions of their own.
      if (ring.size() > 2 && std::abs(ring[1].x - wanted[1].x) + std::abs(ring[1].y - wanted[1].y) > 1e-9)
        std::reverse(ring.begin(), ring.end());
      expect_near(ring, wanted);
    }
  }
}

TEST_F(VectorFormats, FieldsAndValues) {
  for (const auto& [driver, file] : {std::pair{"GPKG", "v.gpkg"}, std::pair{"ESRI Shapefile", "v.shp"}}) {
    SCOPED_TRACE(driver);
    ASSERT_TRUE(translate(geojson(kPoint), folder_ / file, {"-f", driver}));
    const auto layers = read(folder_ / file);
    ASSERT_EQ(layers.size(), 1U);
    ASSERT_EQ(layers[0].fields, (std::vector<std::string>{"name", "depth", "sol"}));
    const auto& values = layers[0].features.at(0).values;
    EXPECT_EQ(std::get<std::string>(values.at(0)), "Yellowknife");
    EXPECT_EQ(std::get<double>(values.at(1)), 2.5);
    EXPECT_EQ(std::get<std::int64_t>(values.at(2)), 124);
  }
}

TEST_F(VectorFormats, ValuesWithoutNumbers) {
  const auto path = folder_ / "nan.json";
  write_text(path, collection({feature(kPoint, R"({"a":NaN,"b":null,"c":true,"d":[1,2],"e":"2012-08-06"})")}));
  const auto layer = read(path).at(0);
  const auto& values = layer.features.at(0).values;
  ASSERT_EQ(values.size(), layer.fields.size());
  EXPECT_TRUE(std::holds_alternative<std::monostate>(values[0]));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(values[1]));
  EXPECT_EQ(std::get<std::int64_t>(values[2]), 1);
  EXPECT_TRUE(std::holds_alternative<std::string>(values[3]));
  EXPECT_TRUE(std::holds_alternative<std::string>(values[4]));
}

TEST_F(VectorFormats, Gpx) {
  const auto path = folder_ / "way.gpx";
  write_text(
      path,
      "<?xml version=\"1.0\"?>\n<!-- a < in a comment --><gpx version=\"1.1\" "
      "xmlns=\"http://www.topografix.com/GPX/1/1\"><wpt lat=\"-4.5\" lon=\"137.4\"><name>Landing</name></wpt>"
      "<rte><rtept lat=\"1\" lon=\"2\"/><rtept lat=\"3\" lon=\"4\"/></rte><trk><name>day</name><trkseg><trkpt "
      "lat=\"1\" lon=\"179\"/><trkpt lat=\"2\" lon=\"-179\"/></trkseg></trk></gpx>");
  const auto layers = read(path);
  ASSERT_EQ(layers.size(), 3U);
  EXPECT_EQ(layers[0].name, "waypoints");
  expect_near(layers[0].features.at(0).shapes.at(0).rings.at(0), {{137.4, -4.5}});
  EXPECT_EQ(layers[1].name, "routes");
  EXPECT_EQ(layers[2].name, "tracks");
  expect_near(layers[2].features.at(0).shapes.at(0).rings.at(0), {{179, 1}, {181, 2}});
  mars::FeatureReadOptions options;
  options.layer = "track_points";
  EXPECT_EQ(read(path, options).at(0).features.size(), 2U);
}

TEST_F(VectorFormats, CsvColumns) {
  struct Case {
    std::string header;
    std::string row;
  };
  const std::vector<Case> cases{{"name,lon,lat", "A,137.4,-4.5"},
                                {"Latitude,Longitude,name", "-4.5,137.4,A"},
                                {"X;Y;name", "137.4;-4.5;A"},
                                {"name\tlon\tlat", "A\t 137.4\t-4.5"},
                                {"name,Center_Latitude,Center_Longitude", "A,-4.5,137.4"},
                                {"name,WKT", "A,POINT (137.4 -4.5)"},
                                {"\xef\xbb\xbflon,lat,name", "137.4,-4.5,A"}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.header);
    write_text(folder_ / "t.csv", c.header + "\n" + c.row + "\r\n");
    expect_near(only(folder_ / "t.csv").shapes.at(0).rings.at(0), {{137.4, -4.5}});
  }
  write_text(folder_ / "t.tsv", "lat\tlon\n-4.5\t137.4\n");
  expect_near(only(folder_ / "t.tsv").shapes.at(0).rings.at(0), {{137.4, -4.5}});
}

TEST_F(VectorFormats, CsvNamedColumnsAndTypes) {
  const auto path = folder_ / "t.csv";
  write_text(path, "east,north,code,count,share,note\n1,2,007,3,0.5,\n3,4,012,-4,2,x\n,,1,0,1,y\n");
  mars::FeatureReadOptions options;
  options.lon_column = "East";
  options.lat_column = "north";
  const auto layer = read(path, options).at(0);
  ASSERT_EQ(layer.features.size(), 3U);
  EXPECT_TRUE(layer.features[2].shapes.empty());
  EXPECT_EQ(std::get<std::string>(layer.features[0].values[2]), "007");
  EXPECT_EQ(std::get<std::int64_t>(layer.features[1].values[3]), -4);
  EXPECT_EQ(std::get<double>(layer.features[1].values[4]), 2.0);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(layer.features[0].values[5]));
}

TEST_F(VectorFormats, NamesOfLayersAndFilesBeside) {
  write_text(folder_ / "sites.csv", "lon,lat,n\n1,2,3\n");
  write_text(folder_ / "sites.csvt", "String,Integer,String\n");
  EXPECT_EQ(read(folder_ / "sites.csv").at(0).name, "sites");
  expect_near(only(folder_ / "sites.csv").shapes.at(0).rings.at(0), {{1, 2}});
  write_text(
      folder_ / "way.kml",
      "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Placemark><Point><coordinates>1,2</coordinates></Point>"
      "</Placemark></kml>");
  EXPECT_EQ(read(folder_ / "way.kml").at(0).name, "way");
}

TEST_F(VectorFormats, CsvOfShapes) {
  const auto path = folder_ / "t.csv";
  write_text(path,
             "WKT,v\n\"POLYGON ((0 0,1 0,1 1))\",1\n\"CIRCULARSTRING (0 0,1 1,2 0)\",2\n"
             "\"LINESTRING Z (1 2 3,4 5 6)\",3\n\"TIN (((0 0,1 0,1 1,0 0)),((0 0,1 1,0 1,0 0)))\",4\n,5\n");
  const auto layer = read(path).at(0);
  ASSERT_EQ(layer.features.size(), 5U);
  expect_near(layer.features[0].shapes.at(0).rings.at(0), {{0, 0}, {1, 0}, {1, 1}, {0, 0}});
  const auto& arc = layer.features[1].shapes.at(0).rings.at(0);
  ASSERT_GT(arc.size(), 40U);
  for (const glm::dvec2 p : arc) EXPECT_NEAR(std::hypot(p.x - 1, p.y), 1, 1e-9);
  expect_near(layer.features[2].shapes.at(0).rings.at(0), {{1, 2}, {4, 5}});
  EXPECT_EQ(layer.features[3].shapes.size(), 2U);
  EXPECT_TRUE(layer.features[4].shapes.empty());
}

TEST_F(VectorFormats, KmlStylesAndFolders) {
  const auto path = folder_ / "s.kml";
  write_text(path, R"(<?xml version="1.0"?><kml xmlns="http://www.opengis.net/kml/2.2"><Document><name>d</name>
<Style id="s1"><LineStyle><color>7f0000ff</color><width>4</width></LineStyle></Style>
<Folder><name>One</name><Placemark><name>P</name><styleUrl>#s1</styleUrl>
<description><![CDATA[<!DOCTYPE html><b>x</b>]]></description>
<LineString><coordinates>1,2,3 4,5,6</coordinates></LineString></Placemark></Folder>
<Folder><name>Two</name><Placemark><name>Q</name><Point><coordinates>7,8</coordinates></Point></Placemark></Folder>
</Document></kml>)");
  const auto layers = read(path);
  ASSERT_EQ(layers.size(), 2U);
  EXPECT_EQ(layers[0].name, "One");
  EXPECT_NE(layers[0].features.at(0).style.find("PEN(c:#FF00007F"), std::string::npos)
      << layers[0].features[0].style;
  mars::FeatureReadOptions options;
  options.layer = "Two";
  const auto two = read(path, options);
  ASSERT_EQ(two.size(), 1U);
  expect_near(two[0].features.at(0).shapes.at(0).rings.at(0), {{7, 8}});
}

TEST_F(VectorFormats, KmzTakesTheDocument) {
  const auto kml = [](double lon) {
    return "<kml xmlns=\"http://www.opengis.net/kml/2.2\"><Placemark><Point><coordinates>" +
           std::to_string(lon) + ",2</coordinates></Point></Placemark></kml>";
  };
  vector_files::write_zip(folder_ / "a.kmz", {{"other.kml", kml(5)}, {"doc.kml", kml(1)}});
  expect_near(only(folder_ / "a.kmz").shapes.at(0).rings.at(0), {{1, 2}});
  vector_files::write_zip(folder_ / "b.kmz", {{"images/x.png", "x"}, {"files/first.kml", kml(3)}});
  expect_near(only(folder_ / "b.kmz").shapes.at(0).rings.at(0), {{3, 2}});
}

TEST_F(VectorFormats, SeveralLayersOfAGeoPackage) {
  ASSERT_TRUE(translate(geojson(kPoint), folder_ / "two.gpkg", {"-f", "GPKG", "-nln", "points"}));
  ASSERT_TRUE(translate(geojson(kLine), folder_ / "line.json", {"-f", "GeoJSON"}));
  ASSERT_TRUE(
      translate(geojson(kPoint), folder_ / "table.gpkg", {"-f", "GPKG", "-nlt", "NONE", "-nln", "table"}));
  EXPECT_TRUE(read(folder_ / "table.gpkg").empty());
  mars::FeatureReadOptions options;
  options.layer = "table";
  const auto table = read(folder_ / "table.gpkg", options);
  ASSERT_EQ(table.size(), 1U);
  EXPECT_TRUE(table[0].features.at(0).shapes.empty());
  options.layer = "missing";
  vector_files::expect_words(vector_files::read_error(folder_ / "two.gpkg", options),
                             {"two.gpkg", "has no layer 'missing'", "'points'"});
}

TEST_F(VectorFormats, RealGazetteer) {
  VPE_NEED_SHARED(path, "gazetteer/mars_features_usgs.csv");
  const auto layers = read(path);
  ASSERT_EQ(layers.size(), 1U);
  EXPECT_GT(layers[0].features.size(), 1000U);
  for (const glm::dvec2 p : vector_files::vertices(layers[0])) {
    EXPECT_LE(std::abs(p.x), 180);
    EXPECT_LE(std::abs(p.y), 90);
  }
}

}  // namespace
