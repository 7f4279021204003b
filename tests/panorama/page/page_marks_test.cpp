#include "panorama/page/page_marks.h"

#include "tests/panorama/page/page_fixture.h"

namespace {

using page_test::message_of;
using panorama::read_page_marks;

TEST(PageMarks, AreReadFromTheJson) {
  const panorama::PageMarks marks = read_page_marks(R"({"projection": "cylinder",
    "names": [{"name": "Mount Sharp", "azimuth_deg": 171.2, "elevation_deg": 3.1, "range_m": 14000},
              {"name": "Ä", "azimuth_deg": -10, "elevation_deg": 0}],
    "hotspots": [{"name": "Rim", "azimuth_deg": 5, "elevation_deg": -1, "page": "../rim%20a/index.html"}]})");
  ASSERT_EQ(marks.names.size(), 2U);
  EXPECT_EQ(marks.names[0].text, "Mount Sharp");
  EXPECT_EQ(marks.names[0].direction.azimuth_deg, 171.2);
  EXPECT_EQ(marks.names[0].range_m, 14000.0);
  EXPECT_FALSE(marks.names[1].range_m);
  ASSERT_EQ(marks.hotspots.size(), 1U);
  EXPECT_EQ(marks.hotspots[0].page, "../rim%20a/index.html");
  EXPECT_TRUE(read_page_marks("{}").names.empty());
}

TEST(PageMarks, WrongOnesAreNamed) {
  const auto message = [](const std::string& mark, const char* key = "names") {
    return message_of([&] { read_page_marks("{\"" + std::string(key) + "\": [" + mark + "]}"); });
  };
  EXPECT_NE(message("3").find("names, entry 1"), std::string::npos);
  EXPECT_NE(message(R"({"azimuth_deg": 1, "elevation_deg": 2})").find("name"), std::string::npos);
  EXPECT_NE(message(R"({"name": "a", "azimuth_deg": "x", "elevation_deg": 2})").find("azimuth_deg"),
            std::string::npos);
  EXPECT_NE(message(R"({"name": "a", "azimuth_deg": 1, "elevation_deg": 91})").find("elevation_deg"),
            std::string::npos);
  EXPECT_NE(message(R"({"name": "a", "azimuth_deg": 1, "elevation_deg": 2, "range_m": -1})").find("range_m"),
            std::string::npos);
  EXPECT_NE(message_of([] { read_page_marks("[1]"); }).find("object"), std::string::npos);
  EXPECT_NE(message_of([] { read_page_marks("{"); }).find("JSON"), std::string::npos);
  // Only addresses that lead to a file beside this one.
  for (const char* page : {"javascript:alert(1)", "https://example.org/", "//example.org", "/etc", " a", "",
                           "a b", "data:text/html,x", "JaVaScRiPt:x"}) {
    const std::string mark =
        std::string(R"({"name": "a", "azimuth_deg": 1, "elevation_deg": 2, "page": ")") + page + "\"}";
    EXPECT_NE(message(mark, "hotspots").find("relative address"), std::string::npos) << page;
  }
  const std::string good =
      R"({"name": "a", "azimuth_deg": 1, "elevation_deg": 2, "page": "b/c:d.html#view=1,2"})";
  EXPECT_EQ(message(good, "hotspots"), "");
}

TEST(PageMarks, AddressesAreRelativeAndEncoded) {
  EXPECT_EQ(panorama::address_of("/x/rim a/index.html", "/x/gale"), "../rim%20a/index.html");
  EXPECT_EQ(panorama::address_of("/x/Süd/index.html", "/x/gale/"), "../S%C3%BCd/index.html");
}

TEST(PageMarks, OtherCamerasAreSeenOnStraightLines) {
  constexpr double kRadius_m = 3396000;
  panorama::RecordedViewpoint here;
  here.lon_deg = 10;
  here.lat_deg = 0;
  here.alt_m = 100;
  panorama::RecordedViewpoint there = here;
  there.alt_m = 600;
  const auto above = panorama::seen_from(here, there, kRadius_m);
  ASSERT_TRUE(above);
  EXPECT_NEAR(above->direction.elevation_deg, 90, 1e-6);
  EXPECT_NEAR(*above->range_m, 500, 1e-6);
  there = here;
  there.lon_deg = 11;
  const auto east = panorama::seen_from(here, there, kRadius_m);
  ASSERT_TRUE(east);
  EXPECT_NEAR(east->direction.azimuth_deg, 90, 1e-9);
  // Half of the angle between both verticals below the horizon.
  EXPECT_NEAR(east->direction.elevation_deg, -0.5, 1e-9);
  there.lon_deg = 10;
  there.lat_deg = 1;
  EXPECT_NEAR(panorama::seen_from(here, there, kRadius_m)->direction.azimuth_deg, 0, 1e-9);
  EXPECT_FALSE(panorama::seen_from(here, here, kRadius_m));
  there.alt_m.reset();
  EXPECT_FALSE(panorama::seen_from(here, there, kRadius_m));
}

}  // namespace
