#include "vpe/core/appearance/gazetteer.h"

#include <algorithm>

#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace vpe::core {
namespace {

std::string fault(const std::string& text) {
  try {
    (void)parse_gazetteer(text, "F");
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

void expect_fault(const std::string& text, const std::string& begin, const std::string& part) {
  const std::string found = fault(text);
  EXPECT_TRUE(found.starts_with(begin + ": expected ")) << found;
  EXPECT_NE(found.find(part), std::string::npos) << found;
}

TEST(Gazetteer, ReadsPlainColumnsInAnyOrder) {
  EXPECT_EQ(parse_gazetteer("name,lon,lat\nA,1,2\nB,-3.5,-4\n", "F"),
            (std::vector<Place>{{"A", 1, 2, 0}, {"B", -3.5, -4, 0}}));
  EXPECT_EQ(
      parse_gazetteer("\xef\xbb\xbf Lat , diameter_km,NAME,other,Lon\r\n2,3.5,A,x,1\r\n\r\n4,,B,,359", "F"),
      (std::vector<Place>{{"A", 1, 2, 3500}, {"B", 359, 4, 0}}));
}

TEST(Gazetteer, LargerPlacesComeFirst) {
  const auto places =
      parse_gazetteer("name,lon,lat,diameter_km\na,1,1,5\nb,1,1,\nc,1,1,9\nd,1,1,5\ne,1,1,\n", "F");
  std::string order;
  for (const Place& p : places) order += p.name;
  EXPECT_EQ(order, "cadbe");
}

TEST(Gazetteer, QuotesHoldCommasLineEndsAndQuotes) {
  const auto places = parse_gazetteer("name,lon,lat\n\"A, \"\"b\"\"\nc\",1,2\n\"D\",\"3\",4\r\n", "F");
  EXPECT_EQ(places, (std::vector<Place>{{"A, \"b\"\nc", 1, 2, 0}, {"D", 3, 4, 0}}));
}

TEST(Gazetteer, ReadsTheColumnsOfTheIau) {
  const auto places = parse_gazetteer(
      "Feature_ID,Feature_Name,Target,Diameter,Center_Latitude,Center_Longitude,Coordinate_System\n"
      "1,Gale,Mars,154.1,-5.37,137.81,Planetocentric  +East  0 - 360\n"
      "2,Else,Moon,10,1,20,\"Planetographic, +West, 0 - 360\"\n",
      "F");
  EXPECT_EQ(places, (std::vector<Place>{{"Gale", 137.81, -5.37, 154100}, {"Else", -20, 1, 10000}}));
}

TEST(Gazetteer, FaultsNameFileLineAndWhatWasExpected) {
  expect_fault("", "F:1", "an empty file");
  expect_fault("\n\n", "F:2", "an empty file");
  expect_fault("name,lon\nA,1\n", "F:1", "no column for the latitude");
  expect_fault("lon,lat\n", "F:1", "no column for the name");
  expect_fault("name,lon,lat\nA,1,2\nB,east,2\n", "F:3",
               "a longitude in degrees from -360 to 360, found \"east\"");
  expect_fault("name,lon,lat\nA,1,91\n", "F:2", "a latitude in degrees from -90 to 90, found \"91\"");
  expect_fault("name,lon,lat\nA,1\n", "F:2", "a latitude");
  expect_fault("name,lon,lat\n,1,2\n", "F:2", "a name, found none");
  expect_fault("name,lon,lat,diameter\nA,1,2,-3\n", "F:2", "a diameter in kilometres");
  expect_fault("name,lon,lat\n\"A\nb\",1,2\nC,x,1\n", "F:4", "\"x\"");
  expect_fault("name,lon,lat\n\"A,1,2\nB,1,2\n", "F:2", "a closing quote, found the end");
  expect_fault("name,lon,lat\n\"A\"b,1,2\n", "F:2", "after a closing quote, found \"b,1,2?\"");
  expect_fault("name,lon,lat\nA,\x1b[2J,2\n", "F:2", "found \"?[2J\"");
}

TEST(Gazetteer, AnyBytesGivePlacesOrAFault) {
  test_support::Random random(4);
  for (int n = 0; n < 3000; ++n) {
    std::string text = "name,lon,lat\nA,1,2\n\"B \"\"x\"\"\",3,4\r\nC,5,6\n";
    for (int edits = random.integer(1, 4); edits > 0; --edits) {
      const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(text.size()) - 1));
      text[at] = random.integer(0, 1) == 0 ? static_cast<char>(random.integer(0, 255))
                                           : ",\"\n\r"[random.integer(0, 3)];
    }
    try {
      EXPECT_LE(parse_gazetteer(text, "F").size(), 12U);
    } catch (const std::runtime_error& e) {
      EXPECT_TRUE(std::string(e.what()).starts_with("F:")) << e.what();
    }
  }
}

TEST(Gazetteer, FilesThatCannotBeReadAreNamed) {
  const test_support::TempDir dir;
  EXPECT_EQ(gazetteer_problem(""), "");
  EXPECT_NE(gazetteer_problem((dir / "none.csv").string()).find("No such file"), std::string::npos);
  EXPECT_EQ(gazetteer_problem(dir.path().string()), "it is a folder");
  base::write_file(dir / "some.csv", std::string_view("name,lon,lat\nA,1,2\n"));
  EXPECT_EQ(gazetteer_problem((dir / "some.csv").string()), "");
  EXPECT_EQ(read_gazetteer(dir / "some.csv").size(), 1U);
  EXPECT_THROW(read_gazetteer(dir / "none.csv"), base::FileError);
}

TEST(Gazetteer, ReadsTheGazetteerOfMars) {
  VPE_NEED_SHARED(file, "gazetteer/mars_features_usgs.csv");
  const std::vector<Place> places = read_gazetteer(file);
  EXPECT_GT(places.size(), 1800U);
  const auto olympus =
      std::find_if(places.begin(), places.end(), [](const Place& p) { return p.name == "Olympus Mons"; });
  ASSERT_NE(olympus, places.end());
  EXPECT_NEAR(olympus->lon_deg, 226.2, 0.3);
  EXPECT_NEAR(olympus->lat_deg, 18.65, 0.3);
  EXPECT_NEAR(olympus->diameter_m, 610e3, 30e3);
}

}  // namespace
}  // namespace vpe::core
