// Ways of vector files that GDAL writes.
#include "vpe/explore/traverse/way_file.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

#include "mars/sources/source.h"
#include "tests/support/support.h"

namespace vpe::explore {
namespace {

using Dataset = std::unique_ptr<GDALDataset, decltype(&GDALClose)>;

Dataset create(const char* driver, const std::string& path, bool extends = false) {
  GDALAllRegister();
  const char* options[] = {extends ? "GPX_USE_EXTENSIONS=YES" : nullptr, nullptr};
  return {GetGDALDriverManager()->GetDriverByName(driver)->Create(path.c_str(), 0, 0, 0, GDT_Unknown,
                                                                  const_cast<char**>(options)),
          GDALClose};
}

void add_field(OGRLayer& layer, const char* name, OGRFieldType type) {
  OGRFieldDefn field(name, type);
  ASSERT_EQ(layer.CreateField(&field), OGRERR_NONE) << name;
}

void add(OGRLayer& layer, const char* wkt,
         const std::vector<std::pair<const char*, std::string>>& values = {}) {
  OGRFeature feature(layer.GetLayerDefn());
  for (const auto& [name, value] : values) feature.SetField(name, value.c_str());
  OGRGeometry* geometry = nullptr;
  ASSERT_EQ(OGRGeometryFactory::createFromWkt(wkt, nullptr, &geometry), OGRERR_NONE);
  feature.SetGeometryDirectly(geometry);
  ASSERT_EQ(layer.CreateFeature(&feature), OGRERR_NONE);
}

void expect_point(const WayPoint& point, const WayPoint& expected) {
  EXPECT_NEAR(point.place.lon_deg, expected.place.lon_deg, 1e-9);
  EXPECT_NEAR(point.place.lat_deg, expected.place.lat_deg, 1e-9);
  EXPECT_EQ(point.time_s, expected.time_s);
  EXPECT_EQ(point.yaw_deg, expected.yaw_deg);
  EXPECT_EQ(point.pitch_deg, expected.pitch_deg);
  EXPECT_EQ(point.roll_deg, expected.roll_deg);
}

class WayFile : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::vector<FileWay> read(const std::string& name, const std::string& layer = "") const {
    return read_ways(path(name), layer, mars::kMarsRadius_m);
  }
  std::string error_of(const std::string& name, const std::string& layer = "") const {
    try {
      (void)read(name, layer);
    } catch (const std::exception& e) {
      return e.what();
    }
    return {};
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }

  test_support::TempDir folder_;
};

TEST_F(WayFile, TracksOfGpxHaveTimesAndExtensions) {
  {
    const Dataset file = create("GPX", path("track.gpx"), true);
    ASSERT_NE(file, nullptr);
    OGRLayer* points = file->CreateLayer("track_points", nullptr, wkbPoint, nullptr);
    ASSERT_NE(points, nullptr);
    add_field(*points, "yaw", OFTReal);
    const auto point = [&](const char* wkt, const char* segment, const char* time, const char* yaw) {
      add(*points, wkt, {{"track_fid", "0"}, {"track_seg_id", segment}, {"time", time}, {"yaw", yaw}});
    };
    point("POINT (10 -5)", "0", "2026/11/27 12:00:00+00", "90");
    point("POINT (10.01 -5)", "0", "2026/11/27 12:10:00+00", "80.5");
    point("POINT (10.01 -4.99)", "1", "2026/11/27 13:10:00+01", "-10");
  }
  const std::vector<FileWay> ways = read("track.gpx");
  ASSERT_EQ(ways.size(), 2U);
  ASSERT_EQ(ways[0].points.size(), 2U);
  ASSERT_EQ(ways[1].points.size(), 1U);
  const WayPoint& first = ways[0].points[0];
  const WayPoint& second = ways[0].points[1];
  EXPECT_NEAR(first.place.lon_deg, 10, 1e-9);
  EXPECT_NEAR(first.place.lat_deg, -5, 1e-9);
  EXPECT_EQ(*second.time_s - *first.time_s, 600);
  EXPECT_EQ(*ways[1].points[0].time_s, *second.time_s);  // in another zone
  EXPECT_EQ(*first.yaw_deg, 90);
  EXPECT_EQ(*second.yaw_deg, 80.5);
  EXPECT_FALSE(second.pitch_deg);
  const std::vector<FileWay> tracks = read("track.gpx", "tracks");
  ASSERT_EQ(tracks.size(), 2U);
  expect_point(tracks[1].points[0], ways[1].points[0]);
}

TEST_F(WayFile, RoutesAndWaypointsOfGpx) {
  write("route.gpx",
        "<gpx version='1.1' xmlns='http://www.topografix.com/GPX/1/1'><wpt lat='1' lon='2'/>"
        "<rte><rtept lat='-5' lon='10'/><rtept lat='-5' lon='11'/></rte></gpx>");
  const std::vector<FileWay> ways = read("route.gpx");
  ASSERT_EQ(ways.size(), 1U);
  EXPECT_EQ(ways[0].points.size(), 2U);
  EXPECT_FALSE(ways[0].points[0].time_s);
  const std::vector<FileWay> marks = read("route.gpx", "waypoints");
  ASSERT_EQ(marks.size(), 1U);
  EXPECT_EQ(marks[0].points[0].place.lon_deg, 2);
}

TEST_F(WayFile, LinesOfEveryFormatAreOneWay) {
  const char* line = "LINESTRING (10 -5, 10.01 -5, 10.01 -4.99)";
  for (const auto& [driver, name] :
       {std::pair{"GPKG", "way.gpkg"}, {"GeoJSON", "way.geojson"}, {"ESRI Shapefile", "way.shp"}}) {
    {
      const Dataset file = create(driver, path(name));
      ASSERT_NE(file, nullptr) << driver;
      OGRLayer* layer = file->CreateLayer("way", nullptr, wkbLineString, nullptr);
      ASSERT_NE(layer, nullptr) << driver;
      add_field(*layer, "yaw", OFTReal);
      add(*layer, line, {{"yaw", "5"}});
    }
    const std::vector<FileWay> ways = read(name);
    ASSERT_EQ(ways.size(), 1U) << driver;
    EXPECT_EQ(ways[0].kind, "line");
    ASSERT_EQ(ways[0].points.size(), 3U) << driver;
    EXPECT_NEAR(ways[0].points[2].place.lat_deg, -4.99, 1e-9) << driver;
    EXPECT_FALSE(ways[0].points[0].yaw_deg);  // of the line, and not of its vertices
  }
}

TEST_F(WayFile, PointsHaveTheAttitudeOfTheirFields) {
  {
    const Dataset file = create("GPKG", path("stations.gpkg"));
    ASSERT_NE(file, nullptr);
    OGRLayer* layer = file->CreateLayer("stations", nullptr, wkbPoint, nullptr);
    OGRLayer* other = file->CreateLayer("others", nullptr, wkbPoint, nullptr);
    for (const char* name : {"Heading_deg", "PITCH", "roll"}) add_field(*layer, name, OFTReal);
    add_field(*layer, "time_s", OFTInteger);
    add(*layer, "POINT (-170 3)", {{"Heading_deg", "350"}, {"PITCH", "-4"}, {"roll", "2"}, {"time_s", "5"}});
    add(*layer, "POINT (190 4)", {{"time_s", "9"}});
    add(*other, "POINT (1 1)");
  }
  const std::vector<FileWay> ways = read("stations.gpkg", "stations");
  ASSERT_EQ(ways.size(), 1U);
  expect_point(ways[0].points[0], {{-170, 3}, 5, 350, -4, 2});
  expect_point(ways[0].points[1], {{-170, 4}, 9, {}, {}, {}});
  EXPECT_EQ(read("stations.gpkg").size(), 2U);
  EXPECT_NE(error_of("stations.gpkg", "none").find("others"), std::string::npos);
}

TEST_F(WayFile, BadInputNamesItsPlace) {
  const auto has = [](const std::string& text, const std::string& word) {
    return text.find(word) != std::string::npos;
  };
  EXPECT_TRUE(has(error_of("missing.gpx"), "missing.gpx"));
  write("empty.geojson", R"({"type": "FeatureCollection", "features": []})");
  EXPECT_TRUE(has(error_of("empty.geojson"), "lines or points")) << error_of("empty.geojson");
  const auto point = [&](const std::string& fields) {
    write("bad.geojson", R"({"type": "FeatureCollection", "features": [{"type": "Feature", "properties": {)" +
                             fields + R"(}, "geometry": {"type": "Point", "coordinates": [1, 2]}}]})");
    return error_of("bad.geojson");
  };
  EXPECT_EQ(point(R"("yaw": 30, "time": "2026-11-27T12:00:00Z")"), "");
  for (const auto& [fields, word] : {std::pair{R"("yaw": "north")", "north"},
                                     {R"("pitch": 91)", "-90 to 90"},
                                     {R"("roll": -181)", "-180 to 180"},
                                     {R"("heading": 361)", "-360 to 360"},
                                     {R"("time": "noon")", "noon"}}) {
    const std::string error = point(fields);
    EXPECT_TRUE(has(error, word) && has(error, "bad.geojson") && has(error, "feature")) << error;
  }
}

TEST(TimeStamp, DatesAndNumbers) {
  EXPECT_EQ(parse_time_stamp("12.5"), 12.5);
  EXPECT_EQ(parse_time_stamp("1970-01-01T00:00:00Z"), 0);
  EXPECT_EQ(parse_time_stamp("2000/03/01 00:00:00"), 951868800);
  EXPECT_EQ(parse_time_stamp("2000-03-01T01:30:00+01:30"), 951868800);
  EXPECT_EQ(parse_time_stamp("2000-02-29T23:00:00-01"), 951868800);
  EXPECT_EQ(parse_time_stamp("2000-03-01T00:00"), 951868800);
  EXPECT_NEAR(*parse_time_stamp("2000-03-01T00:00:00.25+0000"), 951868800.25, 1e-6);
  for (const char* text : {"", "noon", "2000-02-30T00:00:00Z", "2000-13-01T00:00:00Z", "2000-03-01",
                           "2000-03-01T24:00:00Z", "2000-03-01T00:60:00Z", "2000-03-01T00:00:00X",
                           "2000-03-01T00:00:00Zx", "2000-03-01T00:00:00+1", "20000-03-01T00:00:00Z", "nan"})
    EXPECT_FALSE(parse_time_stamp(text)) << text;
}

}  // namespace
}  // namespace vpe::explore
