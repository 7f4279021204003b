// Options and arguments that take places, given by names.
#include <filesystem>

#include "tests/app/support/app_fixture.h"
#include "vpe/app/map/box_option.h"
#include "vpe/app/places/named_places.h"

namespace app_test {
namespace {

namespace app = vpe::app;

class PlacesByName : public AppTest {
 protected:
  // Runs a command with a place as NAME, and as LON,LAT in its stead; returns both answers.
  std::pair<Result, Result> both(const Words& before, const std::string& numbers, const std::string& name,
                                 const Words& after) {
    const auto run = [&](const std::string& place) {
      Words words = before;
      words.push_back(place);
      words.insert(words.end(), after.begin(), after.end());
      return vpe(words);
    };
    return {run(numbers), run(name)};
  }
  void expect_equal(const std::pair<Result, Result>& results) {
    EXPECT_EQ(results.first.exit_code, 0) << results.first.err;
    EXPECT_EQ(results.second.exit_code, 0) << results.second.err;
    EXPECT_EQ(results.first.out, results.second.out);
  }
  std::string p() const { return planet().string(); }
};

constexpr const char* kCuriosity = "137.4417,-4.5895";
constexpr const char* kViking = "134.29,47.64";

TEST_F(PlacesByName, EveryAnswerIsThatOfTheCoordinates) {
  expect_equal(both({"query", p()}, kCuriosity, "Curiosity", {"--json", "-q"}));
  expect_equal(both({"query", p(), "1,2"}, kViking, "viking 2", {"-q"}));
  expect_equal(both({"profile", p(), "137,-4"}, kCuriosity, "curiosity", {"--step", "5000", "-q"}));
  expect_equal(
      both({"sun", p(), "--at"}, kCuriosity, "Curiosity", {"--date", "2026-11-27T12:00Z", "--json", "-q"}));
  expect_equal(both({"sight", p(), "--to", "137.5,-4.5", "--from"}, kCuriosity, "Curiosity",
                    {"--from-height", "100", "--json", "-q"}));
  expect_equal(both({"sight", p(), "--from", "137.5,-4.5", "--to"}, kCuriosity, "Curiosity",
                    {"--from-height", "100", "--json", "-q"}));
  expect_equal(both({"measure", p(), "137,-4", "138,-4"}, kCuriosity, "Curiosity", {"--json", "-q"}));
}

TEST_F(PlacesByName, EveryFileIsThatOfTheCoordinates) {
  const auto compare = [&](const Words& before, const std::string& numbers, const std::string& name,
                           Words after, const std::string& file) {
    after.insert(after.end(), {"-o", path(file), "-q"});
    const auto results = both(before, numbers, name, after);
    EXPECT_EQ(results.first.exit_code, 0) << results.first.err;
    EXPECT_EQ(results.second.exit_code, 0) << results.second.err;
    EXPECT_EQ(results.first.out, results.second.out) << file;
  };
  compare({"viewshed", p(), "--at"}, kCuriosity, "Curiosity",
          {"--radius", "20000", "--spacing", "1000", "--json"}, "seen.tif");
  compare({"horizon", p(), "--at"}, kCuriosity, "Curiosity", {"--height", "100", "--step", "5"}, "skyline.csv");
  compare({"route", p(), "--max-slope", "45", "--spacing", "2000", "--to", "137.6,-4.6", "--from"}, kCuriosity,
          "Curiosity", {"--json"}, "way.geojson");
  compare({"route", p(), "--max-slope", "45", "--spacing", "2000", "--from", "137.6,-4.6", "--to"}, kCuriosity,
          "Curiosity", {"--json"}, "way.geojson");
  const Result panorama = vpe(
      {"panorama", p(), "--at", "Curiosity", "--height", "100", "--width", "256", "-q", "-o", "around.png"});
  EXPECT_EQ(panorama.exit_code, 0) << panorama.err;
  const auto sidecar = parse_json(read_text(path("around.json")));
  EXPECT_NE(sidecar.dump().find("137.4417"), std::string::npos);
}

TEST_F(PlacesByName, AFeatureIsABoxForMapsAndContours) {
  const Result mapped =
      vpe({"map", p(), "--box", "Gale", "--spacing", "20000", "-o", "gale.tif", "--json", "-q"});
  ASSERT_EQ(mapped.exit_code, 0) << mapped.err;
  const auto map = parse_json(mapped.out);
  // 154 km are some 8 pixels.
  EXPECT_GE(map["columns"].get<int>(), 7);
  EXPECT_LE(map["columns"].get<int>(), 10);
  const Result lines = vpe({"contour", p(), "--box", "Gale", "--interval", "500", "-o", "gale.geojson", "-q"});
  EXPECT_EQ(lines.exit_code, 0) << lines.err;
  expect_failure({"map", p(), "--box", "Curiosity", "--spacing", "20000", "-o", "x.tif"}, 2,
                 {"--box", "Curiosity", "no diameter", "137.4417,-4.5895"});
  expect_failure({"map", p(), "--box", "Xyzzy", "--spacing", "20000", "-o", "x.tif"}, 2, {"--box", "Xyzzy"});
}

TEST(BoxAround, TouchesTheCircle) {
  for (const double lat_deg : {-80.0, -5.4, 0.0, 60.0}) {
    const mars::LonLat middle{170, lat_deg};
    const vpe::map::PlaceBox box = app::box_around(middle, 800e3, mars::kMarsRadius_m);
    double west_deg = 1e9;
    double east_deg = -1e9;
    double south_deg = 90;
    double north_deg = -90;
    for (int n = 0; n < 3600; ++n) {
      const mars::LonLat rim = mars::destination(middle, 0.1 * n, 400e3 / mars::kMarsRadius_m);
      const double lon_deg = 170 + std::remainder(rim.lon_deg - 170, 360);
      west_deg = std::min(west_deg, lon_deg);
      east_deg = std::max(east_deg, lon_deg);
      south_deg = std::min(south_deg, rim.lat_deg);
      north_deg = std::max(north_deg, rim.lat_deg);
    }
    EXPECT_NEAR(box.west_deg, west_deg, 1e-4);
    EXPECT_NEAR(box.east_deg, east_deg, 1e-4);
    EXPECT_NEAR(box.south_deg, south_deg, 1e-9);
    EXPECT_NEAR(box.north_deg, north_deg, 1e-9);
  }
  const vpe::map::PlaceBox pole = app::box_around({10, 88}, 400e3, mars::kMarsRadius_m);
  EXPECT_EQ(pole.west_deg, -180);
  EXPECT_EQ(pole.east_deg, 180);
  EXPECT_EQ(pole.north_deg, 90);
  EXPECT_NEAR(pole.south_deg, 88 - 200e3 / mars::kMarsRadius_m / mars::kRadiansPerDegree, 1e-9);
}

TEST_F(PlacesByName, TheFirstArgumentIsAPlaceIfItIsAWholeName) {
  // The planet is then the embedded Mars, as for coordinates.
  const app::PlanetAndPlaces named = app::split_places({"Gale", "viking 2"});
  EXPECT_EQ(named.planet, "");
  ASSERT_EQ(named.places.size(), 2U);
  EXPECT_EQ(named.places[0].name, "Gale");
  EXPECT_EQ(named.places[1].name, "Viking 2");
  const app::PlanetAndPlaces part = app::split_places({"olymp", "Olympus M"});
  EXPECT_EQ(part.planet, "olymp");
  EXPECT_EQ(app::split_places({"1,2"}).places.size(), 1U);
  // A file of that name is a planet.
  std::filesystem::copy_file(planet(), path("gale"));
  EXPECT_EQ(vpe({"query", "gale", "1,2", "-q"}).exit_code, 0);
  expect_failure({"query", "olymp", "1,2"}, 1, {"olymp"});
}

TEST_F(PlacesByName, OtherPlanetsAndWrongNamesAreRefused) {
  Dem dem;
  dem.radius_m = 1737400;
  write_dem(dir_ / "moon.tif", dem);
  const Result built =
      vpe({"build", "moon.tif", "-o", "moon.vpe", "--body", "Moon", "--base-spacing", "300000", "-q"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  expect_failure({"query", "moon.vpe", "Gale"}, 2, {"Gale", "those of Mars", "Moon"});
  expect_failure({"horizon", "moon.vpe", "--at", "Gale", "--height", "2", "-o", "s.csv"}, 2,
                 {"--at", "those of Mars"});
  expect_failure({"panorama", "moon.vpe", "--at", "Gale", "--height", "2", "--width", "64", "-o", "s.png"}, 2,
                 {"--at", "those of Mars"});
  expect_failure({"map", "moon.vpe", "--box", "Gale", "--spacing", "20000", "-o", "x.tif"}, 2,
                 {"--box", "those of Mars"});
  expect_failure({"render", "moon.vpe", "--pose", "Gale", "-o", "x.png"}, 2, {"Gale", "those of Mars"});
  expect_failure({"query", p(), "Xyzzy"}, 2, {"Xyzzy", "vpe find"});
  expect_failure({"query", p(), "olimpus mons"}, 2, {"olimpus mons", "Olympus Mons"});
  expect_failure({"sun", p(), "--at", "mons", "--date", "2026-11-27"}, 2, {"--at", "several names"});
  expect_failure({"route", p(), "--from", "Xyzzy", "--to", "1,2", "--max-slope", "20", "-o", "w.geojson"}, 2,
                 {"--from", "Xyzzy"});
  expect_failure({"match", "thin.png", p(), "--near", "Xyzzy"}, 2, {"--near", "Xyzzy"});
}

// A name keeps its place whatever the kind of latitudes of coordinates.
TEST_F(PlacesByName, LatitudesOfNamesAreNotConverted) {
  const auto lat_deg = [&](const Words& more) {
    Words words{"query", p(), "Viking 2", "--json", "-q"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = vpe(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out)[0]["lat_deg"].get<double>();
  };
  EXPECT_EQ(lat_deg({}), lat_deg({"--latitude", "planetographic:3396190,3376200"}));
}

}  // namespace
}  // namespace app_test
