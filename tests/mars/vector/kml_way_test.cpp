#include "mars/geodesy/kml_way.h"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

namespace mars {
namespace {

std::string kml(const std::string& body) {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\" "
         "xmlns:gx=\"http://www.google.com/kml/ext/2.2\"><Document><name>x</name>" +
         body + "</Document></kml>";
}
std::string line(const std::string& coordinates) {
  return kml("<Placemark><LineString><tessellate>1</tessellate><coordinates>" + coordinates +
             "</coordinates></LineString></Placemark>");
}
std::string tour(const std::string& views) {
  return kml("<gx:Tour><name>t</name><gx:Playlist>" + views + "</gx:Playlist></gx:Tour>");
}

// Expects an error that has every part.
void refuses(const std::string& text, const std::vector<std::string>& parts) {
  try {
    (void)parse_kml(text, "way.kml");
    ADD_FAILURE() << "accepted: " << text.substr(0, 300);
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("way.kml: "), std::string::npos) << e.what();
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    for (const std::string& part : parts)
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << part << " in: " << e.what();
  }
}

void expect_point(const KmlPoint& p, double lon_deg, double lat_deg, double altitude_m) {
  EXPECT_DOUBLE_EQ(p.place.lon_deg, lon_deg);
  EXPECT_EQ(p.place.lat_deg, lat_deg);
  EXPECT_EQ(p.altitude_m, altitude_m);
  EXPECT_FALSE(p.is_absolute);
}

TEST(KmlWay, ReadsLines) {
  const auto ways = parse_kml(line("\n 137.1,-4.5,10\t137.2,-4.6\r\n -222.5,4e0,-1.5 "), "way.kml");
  ASSERT_EQ(ways.size(), 1U);
  EXPECT_EQ(ways[0].kind, KmlWay::Kind::kLineString);
  const auto& p = ways[0].points;
  ASSERT_EQ(p.size(), 3U);
  expect_point(p[0], 137.1, -4.5, 10);
  expect_point(p[1], 137.2, -4.6, 0);
  expect_point(p[2], 137.5, 4, -1.5);
}

TEST(KmlWay, ReadsTracks) {
  const auto ways =
      parse_kml(kml("<Placemark><gx:Track><when>2015-07-21T00:00:00Z</when><gx:coord>1 2 3</gx:coord>"
                    "<when>2015-07-22T00:00:00Z</when><gx:coord> 4\n5 </gx:coord></gx:Track></Placemark>"),
                "way.kml");
  ASSERT_EQ(ways.size(), 1U);
  EXPECT_EQ(ways[0].kind, KmlWay::Kind::kTrack);
  ASSERT_EQ(ways[0].points.size(), 2U);
  expect_point(ways[0].points[0], 1, 2, 3);
  expect_point(ways[0].points[1], 4, 5, 0);
}

TEST(KmlWay, ReadsToursWithCamerasAndLookAts) {
  const auto ways = parse_kml(
      tour(
          "<gx:FlyTo><gx:duration>2.5</gx:duration><gx:flyToMode>smooth</gx:flyToMode><Camera><longitude>10</longitude>"
          "<latitude>20</latitude><altitude>300</altitude><heading>45</heading><tilt>80</tilt><roll>-5</roll>"
          "<gx:altitudeMode>relativeToGround</gx:altitudeMode></Camera></gx:FlyTo>"
          "<gx:Wait><gx:duration>1</gx:duration></gx:Wait>"
          "<gx:FlyTo><LookAt><longitude>11</longitude><latitude>21</latitude><range>5000</range><tilt>60</tilt>"
          "<altitude>77</altitude></LookAt></gx:FlyTo>"),
      "way.kml");
  ASSERT_EQ(ways.size(), 1U);
  EXPECT_EQ(ways[0].kind, KmlWay::Kind::kTour);
  const auto& p = ways[0].points;
  ASSERT_EQ(p.size(), 2U);
  expect_point(p[0], 10, 20, 300);
  EXPECT_EQ(p[0].view, (KmlView{45, 80, -5, std::nullopt, 2.5}));
  // Without a mode the view is clamped to the ground, and its altitude does not count.
  expect_point(p[1], 11, 21, 0);
  EXPECT_EQ(p[1].view, (KmlView{0, 60, 0, 5000, std::nullopt}));
}

TEST(KmlWay, KeepsTheOrderOfTheFileAndSkipsTheRest) {
  const auto ways = parse_kml(
      kml("<Placemark><Point><coordinates>99,9</coordinates></Point></Placemark><Folder><Placemark>"
          "<MultiGeometry><LineString><coordinates>1,1 2,2</coordinates></LineString><LineString>"
          "<coordinates>3,3 4,4</coordinates></LineString></MultiGeometry></Placemark></Folder><Placemark>"
          "<gx:Track><gx:coord>5 5 0</gx:coord></gx:Track></Placemark>"),
      "way.kml");
  ASSERT_EQ(ways.size(), 3U);
  EXPECT_EQ(ways[0].points[0].place.lon_deg, 1);
  EXPECT_EQ(ways[1].points[0].place.lon_deg, 3);
  EXPECT_EQ(ways[2].points[0].place.lon_deg, 5);
}

TEST(KmlWay, BadInputIsNamed) {
  refuses("", {"not a KML file"});
  refuses("lon,lat\n1,2\n", {"not a KML file"});
  refuses("<kml><Document>", {"not a KML file"});
  refuses("<kml><a></b></kml>", {"not a KML file"});
  refuses(std::string("PK\x03\x04zzzz", 8), {"KMZ", "extract"});
  refuses(std::string("<kml>\0</kml>", 12), {"zero bytes"});
  refuses(kml(""), {"no way"});
  refuses(kml("<Placemark><Point><coordinates>1,2</coordinates></Point></Placemark>"),
          {"no way", "LineString"});
  refuses(line(""), {"LineString (way 1)", "no points"});
  refuses(kml("<LineString/>"), {"<coordinates>"});
  refuses(line("1,2 3"), {"point 2", "'3'", "longitude, latitude"});
  refuses(line("1,2,3,4"), {"point 1"});
  refuses(line("1,2 x,4"), {"point 2", "'x' is no longitude", "-360"});
  refuses(line("1,91"), {"'91' is no latitude", "90"});
  refuses(line("361,0"), {"longitude"});
  refuses(line("nan,0"), {"longitude"});
  refuses(line("1,inf"), {"latitude"});
  refuses(line("1,2,1e11"), {"altitude"});
  refuses(line("1;2"), {"point 1"});
  refuses(line(std::string(100000, '7') + ",1"), {"longitude", "..."});
  refuses(kml("<gx:Track></gx:Track>"), {"gx:Track", "no points"});
  refuses(kml("<gx:Track><gx:coord>1</gx:coord></gx:Track>"), {"point 1"});
  refuses(tour(""), {"gx:Tour", "no points"});
  refuses(tour("<gx:FlyTo></gx:FlyTo>"), {"point 1", "<Camera> or <LookAt>"});
  refuses(tour("<gx:FlyTo><Camera><latitude>1</latitude></Camera></gx:FlyTo>"), {"<longitude> in <Camera>"});
  refuses(tour("<gx:FlyTo><LookAt><longitude>1</longitude><latitude>1</latitude></LookAt></gx:FlyTo>"),
          {"<range>"});
  refuses(
      tour(
          "<gx:FlyTo><gx:duration>-1</gx:duration><Camera><longitude>1</longitude><latitude>1</latitude></Camera>"
          "</gx:FlyTo>"),
      {"duration"});
  refuses(
      tour(
          "<gx:FlyTo><Camera><longitude>1</longitude><latitude>1</latitude><tilt>181</tilt></Camera></gx:FlyTo>"),
      {"tilt"});
}

TEST(KmlWay, DeepNestingIsHarmless) {
  std::string deep;
  for (int n = 0; n < 9000; ++n) deep += "<Folder>";
  deep += "<LineString><coordinates>1,2 3,4</coordinates></LineString>";
  for (int n = 0; n < 9000; ++n) deep += "</Folder>";
  try {
    EXPECT_EQ(parse_kml(deep, "way.kml").size(), 1U);
  } catch (const std::runtime_error& e) {
    // The library may refuse so many levels.
    EXPECT_NE(std::string(e.what()).find("way.kml: not a KML file"), std::string::npos) << e.what();
  }
}

// Damaged files are read or refused, whatever is damaged.
TEST(KmlWay, DamagedFilesAreReadOrRefused) {
  const std::string whole = kml(
      "<Placemark><LineString><coordinates>1,1,5 2,2</coordinates></LineString></Placemark><gx:Track>"
      "<gx:coord>5 5 0</gx:coord></gx:Track><gx:Tour><gx:Playlist><gx:FlyTo><Camera><longitude>10</longitude>"
      "<latitude>20</latitude><tilt>80</tilt></Camera></gx:FlyTo></gx:Playlist></gx:Tour>");
  ASSERT_EQ(parse_kml(whole, "w").size(), 3U);
  std::mt19937 random(5);
  int read = 0;
  int refused = 0;
  for (int n = 0; n < 20'000; ++n) {
    std::string text = whole;
    const std::size_t changes = 1 + random() % 4;
    for (std::size_t k = 0; k < changes; ++k) {
      const std::size_t at = random() % text.size();
      const std::size_t length = std::min<std::size_t>(random() % 12, text.size() - at);
      switch (random() % 3) {
        case 0: text[at] = static_cast<char>(random() % 256); break;
        case 1: text.erase(at, length); break;
        default: text.insert(at, text.substr(random() % text.size(), length)); break;
      }
    }
    try {
      for (const KmlWay& way : parse_kml(text, "w")) {
        ASSERT_FALSE(way.points.empty());
        for (const KmlPoint& p : way.points) ASSERT_TRUE(is_valid(p.place));
      }
      ++read;
    } catch (const std::runtime_error& e) {
      ASSERT_TRUE(std::string(e.what()).starts_with("w: ")) << e.what();
      ++refused;
    }
  }
  EXPECT_GT(read, 1000);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace mars
