// vpe find, and names in place of poses.
#include <cmath>

#include "mars/embedded/data_files.h"
#include "mars/geodesy/sphere.h"
#include "tests/app/support/app_fixture.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/places/named_places.h"
#include "vpe/explore/places/landing_sites.h"

namespace app_test {
namespace {

namespace explore = vpe::explore;
using vpe::app::looks_like_name;
using vpe::app::sight_of;

class Find : public AppTest {
 protected:
  // The file of landing sites, as a value of overlay.names.
  static std::string landings() { return mars::find_data_file(explore::kLandingsFile); }
};

TEST_F(Find, PlacesComeWithWhereTheyAre) {
  const Result result = vpe({"find", "OLYMPUS mons", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto list = parse_json(result.out);
  ASSERT_GE(list.size(), 1U);
  EXPECT_EQ(list[0]["name"], "Olympus Mons");
  EXPECT_NEAR(list[0]["lon_deg"].get<double>(), -133.8, 0.5);
  EXPECT_NEAR(list[0]["lat_deg"].get<double>(), 18.65, 0.5);
  EXPECT_NEAR(list[0]["diameter_m"].get<double>(), 610e3, 30e3);
  EXPECT_FALSE(list[0].contains("elevation_m"));
  // One letter wrong, and accents left out.
  EXPECT_EQ(parse_json(vpe({"find", "olimpus mons", "--json"}).out)[0]["name"], "Olympus Mons");
  const Result many = vpe({"find", "planitia", "--limit", "3"});
  EXPECT_EQ(std::ranges::count(many.out, '\n'), 4) << many.out;  // and a command
}

TEST_F(Find, ElevationsAreThoseOfQuery) {
  const auto found = parse_json(vpe({"find", "gale", planet().string(), "--json", "-q"}).out)[0];
  const std::string place =
      std::to_string(found["lon_deg"].get<double>()) + "," + std::to_string(found["lat_deg"].get<double>());
  const auto there = parse_json(vpe({"query", planet().string(), place, "--json", "-q"}).out)[0];
  EXPECT_NEAR(found["elevation_m"].get<double>(), there["elevation_m"].get<double>(), 1e-3);
}

TEST_F(Find, ItsCommandAndANameDrawTheSameImage) {
  const Result found = vpe({"find", "schiaparelli"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  const auto list = parse_json(vpe({"find", "schiaparelli", "--json"}).out);
  const auto& sight = list[0]["sight"];
  const auto text = [&](const char* key) { return std::to_string(sight[key].get<double>()); };
  const Words size{"--size", "160x90", "-q"};
  const auto draw = [&](Words words, const std::string& output) {
    words.insert(words.begin(), {"render", planet().string()});
    words.insert(words.end(), size.begin(), size.end());
    words.insert(words.end(), {"-o", output, "--json"});
    const Result drawn = vpe(words);
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    return parse_json(drawn.out);
  };
  const auto by_name = draw({"--pose", "Schiaparelli"}, "a.png");
  const auto by_numbers =
      draw({"--pose",
            text("lon_deg") + "," + text("lat_deg") + "," + text("yaw_deg") + "," + text("pitch_deg") + ",0",
            "--height", text("height_m")},
           "b.png");
  EXPECT_NE(found.out.find("vpe render --pose "), std::string::npos);
  EXPECT_NEAR(by_name["certificate"]["shift_bound_px"].get<double>(),
              by_numbers["certificate"]["shift_bound_px"].get<double>(), 0.05);
  const Result same = vpe({"find", "schiaparelli", planet().string(), "-q"});
  EXPECT_NE(same.out.find("vpe render " + planet().string()), std::string::npos) << same.out;
  // From above the place itself.
  draw({"--pose", "Schiaparelli", "--height", "20000"}, "c.png");
}

TEST_F(Find, ALisOfOnesOwnIsSearched) {
  write_text(dir_ / "stations.csv", "name,lon,lat\n\"Ridge, north\",10,20\nCamp,11,21\n");
  const auto list = parse_json(vpe({"find", "ridge", "--places", "stations.csv", "--json"}).out);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0]["name"], "Ridge, north");
  EXPECT_TRUE(list[0]["diameter_m"].is_null());
}

TEST_F(Find, LandingSitesAreFoundWithWhatIsKnownOfThem) {
  const auto list = parse_json(vpe({"find", "curiosity", "--json"}).out);
  ASSERT_GE(list.size(), 1U);
  EXPECT_EQ(list[0]["name"], "Curiosity");
  EXPECT_NEAR(list[0]["lon_deg"].get<double>(), 137.4417, 1e-9);
  EXPECT_NEAR(list[0]["lat_deg"].get<double>(), -4.5895, 1e-9);
  EXPECT_TRUE(list[0]["diameter_m"].is_null());
  const auto& landing = list[0]["landing"];
  EXPECT_EQ(landing["mission"], "Mars Science Laboratory");
  EXPECT_EQ(landing["date"], "2012-08-06");
  EXPECT_EQ(landing["kind"], "landing");
  EXPECT_TRUE(landing["accuracy_m"].is_null());
  EXPECT_NE(landing["source"].get<std::string>().find("Bradbury Landing"), std::string::npos);
  const Result text = vpe({"find", "polar lander"});
  EXPECT_TRUE(
      says(text.out, {"Mars Polar Lander: 165.0000,-76.0000", "target of", "1999-12-03", "accuracy 100000 m"}))
      << text.out;
  // A crater is not the lander of the same name, and a number belongs to a name.
  EXPECT_FALSE(parse_json(vpe({"find", "schiaparelli", "--json"}).out)[0].contains("landing"));
  EXPECT_EQ(parse_json(vpe({"find", "viking 2", "--json"}).out)[0]["name"], "Viking 2");
}

// The camera stands so that a few kilometres are seen.
TEST_F(Find, ALandingSiteIsDrawnByItsName) {
  for (const char* name : {"Curiosity", "Viking 1"}) {
    const Result drawn =
        vpe({"render", planet().string(), "--pose", name, "--size", "64x36", "-q", "-o", "site.png"});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    const auto sight = parse_json(vpe({"find", name, "--json"}).out)[0]["sight"];
    EXPECT_GT(sight["height_m"].get<double>(), 1000);
    EXPECT_LT(sight["height_m"].get<double>(), 6000);
  }
  const Result over =
      vpe({"render", planet().string(), "--pose", "Curiosity", "--set", "overlay.names=" + landings(), "--size",
           "320x180", "-q", "-o", "named.png", "--overlay-layer", "names.png"});
  EXPECT_EQ(over.exit_code, 0) << over.err;
  EXPECT_TRUE(exists("names.png"));
}

TEST_F(Find, BadInputIsReported) {
  expect_failure({"find", "xyzzy"}, 1, {"xyzzy", "list of Mars"});
  expect_failure({"find"}, 2, {"NAME"});
  expect_failure({"find", "gale", "--places", "none.csv"}, 1, {"none.csv"});
  expect_failure({"find", "gale", "--limit", "0"}, 2, {"--limit"});
  expect_failure({"render", planet().string(), "--pose", "Xyzzy", "-o", "x.png"}, 2,
                 {"--pose", "Xyzzy", "vpe find"});
  expect_failure({"render", planet().string(), "--pose", "mons", "-o", "x.png"}, 2,
                 {"--pose", "several names"});
  expect_failure({"render", planet().string(), "--pose", "Gale", "--cull-from", "Gale", "-o", "x.png"}, 2,
                 {"--cull-from", "numbers"});
}

TEST(NamedPlaces, NumbersAndNotationsAreNoNames) {
  for (const char* name : {"Gale", "olympus mons", "\u00c1rgyre"}) EXPECT_TRUE(looks_like_name(name)) << name;
  for (const char* other : {"", "1,2,3", "-5,3,0", "N4.6", "lat 4 lon 5", "Gale,3", " Gale"})
    EXPECT_FALSE(looks_like_name(other)) << other;
}

TEST(NamedPlaces, ATextWithANumberIsANameIfTheListHasIt) {
  for (const char* name : {"Viking 1", "viking-2", "Airy-0", "BEAGLE 2", "Mars 3", "Gale"})
    EXPECT_TRUE(vpe::app::is_name(name)) << name;
  for (const char* other : {"Viking 7", "4.6S,222.6W", "N4.6", "lat 4 lon 5", "137.4", "1,2", ""})
    EXPECT_FALSE(vpe::app::is_name(other)) << other;
  EXPECT_TRUE(vpe::app::is_listed_name("gale"));
  EXPECT_FALSE(vpe::app::is_listed_name("gal"));
}

TEST(NamedPlaces, CoordinatesComeBeforeNames) {
  const auto given = vpe::app::given_place("--at", "137.4417 E 4.5895 S");
  EXPECT_TRUE(given.name.empty());
  EXPECT_NEAR(given.place.lon_deg, 137.4417, 1e-12);
  const auto named = vpe::app::given_place("--at", "curiosity");
  EXPECT_EQ(named.name, "Curiosity");
  EXPECT_NEAR(named.place.lat_deg, -4.5895, 1e-9);
  EXPECT_EQ(named.diameter_m, 0);
  EXPECT_GT(vpe::app::given_place("--at", "Gale").diameter_m, 1e5);
  EXPECT_EQ(vpe::app::given_place("--at", "perseve").name, "Perseverance");  // a part that no other name has
}

TEST(NamedPlaces, ATypingErrorIsOfferedAndNotTaken) {
  for (const auto& [text, words] :
       {std::pair<const char*, std::vector<std::string>>{"olimpus mons", {"Olympus Mons"}},
        {"mons", {"several names"}},
        {"1,2,3", {"LON,LAT"}},
        {"Viking 7", {"name of a place of Mars"}},
        {"xyzzy", {"vpe find"}}}) {
    try {
      (void)vpe::app::given_place("--at", text);
      ADD_FAILURE() << text;
    } catch (const vpe::app::UsageError& e) {
      EXPECT_TRUE(says(e.what(), {"--at", text})) << e.what();
      EXPECT_TRUE(says(e.what(), words)) << e.what();
    }
  }
}

TEST(NamedPlaces, AreThoseOfMars) {
  paging::PlanetMeta meta;
  const auto given = vpe::app::given_place("--at", "Gale");
  EXPECT_EQ(vpe::app::place_on(given, "--at", "planetographic", meta, true).lat_deg, given.place.lat_deg);
  const vpe::app::GivenPlace numbers{{137, 45}, "", 0};
  EXPECT_LT(vpe::app::place_on(numbers, "--at", "planetographic", meta, true).lat_deg, 45);
  EXPECT_EQ(vpe::app::places_on({given, numbers}, "", meta, true).size(), 2U);
  paging::PlanetMeta moon;
  moon.body = "Moon";
  moon.radius_m = 1737400;
  paging::PlanetMeta large;
  large.radius_m = 6371000;
  for (const paging::PlanetMeta& other : {moon, large}) {
    EXPECT_NO_THROW((void)vpe::app::place_on(numbers, "--at", "", other, true));
    try {
      (void)vpe::app::place_on(given, "--at", "", other, true);
      ADD_FAILURE() << other.body;
    } catch (const vpe::app::UsageError& e) {
      EXPECT_TRUE(says(e.what(), {"--at", "Gale", "names of places are those of Mars"})) << e.what();
    }
  }
}

TEST(NamedPlaces, AreSeenWhole) {
  constexpr double kRadius_m = mars::kMarsRadius_m;
  for (const double across_m : {0.0, 500.0, 20e3, 150e3, 600e3, 9e6}) {
    for (const double lat_deg : {-89.0, -5.0, 40.0, 90.0}) {
      const vpe::core::Place place{"Somewhere", 30, lat_deg, across_m};
      const auto sight = sight_of(place, kRadius_m);
      EXPECT_LT(sight.pitch_deg, -30);
      EXPECT_GE(sight.pitch_deg, -90);
      EXPECT_GT(sight.height_m, 0.5 * std::clamp(across_m, 1000.0, 3e6));
      const double way_rad = mars::distance_rad({sight.lon_deg, sight.lat_deg}, {30, lat_deg});
      EXPECT_GT(way_rad * kRadius_m, 0.5 * std::clamp(across_m, 1000.0, 3e6));
      EXPECT_TRUE(std::isfinite(sight.yaw_deg));
      if (std::abs(lat_deg) < 60 && across_m < 1e6) {
        EXPECT_NEAR(std::remainder(sight.yaw_deg, 360), 0, 1e-6);
      }
    }
  }
}

TEST(NamedPlaces, TheListHasThemAndNearNamesAreTold) {
  EXPECT_EQ(vpe::app::place_named("--pose", "gale").name, "Gale");
  EXPECT_GT(vpe::app::read_places_of("").size(), 1000U);
  try {
    (void)vpe::app::place_named("--pose", "mons");
    FAIL() << "a part of many names is no name";
  } catch (const vpe::app::UsageError& e) {
    EXPECT_TRUE(says(e.what(), {"--pose", "mons", "several", "Olympus Mons"})) << e.what();
  }
}

}  // namespace
}  // namespace app_test
