// Tests of the search of places by name.
#include "vpe/explore/places/place_search.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "mars/embedded/data_files.h"
#include "tests/support/support.h"
#include "vpe/core/view.h"
#include "vpe/explore/places/arrival.h"
#include "vpe/explore/places/landing_sites.h"

namespace vpe::explore {
namespace {

std::vector<std::string> names(const PlaceSearch& search, const std::string& text, std::size_t most = 10) {
  std::vector<std::string> all;
  for (const core::Place* place : search.find(text, most)) all.push_back(place->name);
  return all;
}

PlaceSearch some_places() {
  std::vector<core::Place> places;
  for (const char* name : {"Hellas Planitia", "Argyre Planitia", "Olympus Mons", "Árgyre Rupes",
                           "Olympia Undae", "Mare Acidalium", "Galle", "Gale", "Gale-Ra", "Lomonosov's Crater"})
    places.push_back({name, 0, 0, 1000});
  return PlaceSearch(std::move(places));
}

TEST(PlaceSearch, FoldsCaseAccentsAndPunctuation) {
  EXPECT_EQ(folded("  Árgyre–Planitia "), "argyre\u2013planitia");
  EXPECT_EQ(folded("Árgyre-Planitia"), "argyre planitia");
  EXPECT_EQ(folded("Žižka’s Łódź"), "zizkas lodz");
  EXPECT_EQ(folded("火星 1"), "火星 1");
  EXPECT_EQ(folded("\xff\xfe a\xc3"), "a");
  EXPECT_EQ(folded(""), "");
}

TEST(PlaceSearch, RanksEqualBeforeBeginningBeforeWordsBeforeParts) {
  const PlaceSearch search = some_places();
  EXPECT_EQ(names(search, "gale"), (std::vector<std::string>{"Gale", "Gale-Ra", "Galle"}));
  EXPECT_EQ(names(search, "OLYMP"), (std::vector<std::string>{"Olympus Mons", "Olympia Undae"}));
  EXPECT_EQ(names(search, "plan"), (std::vector<std::string>{"Hellas Planitia", "Argyre Planitia"}));
  EXPECT_EQ(names(search, "argyre"), (std::vector<std::string>{"Argyre Planitia", "Árgyre Rupes"}));
  EXPECT_EQ(names(search, "lomonosovs"), (std::vector<std::string>{"Lomonosov's Crater"}));
  EXPECT_EQ(names(search, "idal"), (std::vector<std::string>{"Mare Acidalium"}));
  EXPECT_TRUE(names(search, "").empty());
  EXPECT_TRUE(names(search, " - ").empty());
  EXPECT_TRUE(names(search, "qqqq").empty());
  EXPECT_EQ(names(search, "planitia", 1).size(), 1U);
}

TEST(PlaceSearch, ForgivesTypingErrors) {
  const PlaceSearch search = some_places();
  EXPECT_EQ(names(search, "olmypus"), (std::vector<std::string>{"Olympus Mons"}));
  EXPECT_EQ(names(search, "helas"), (std::vector<std::string>{"Hellas Planitia"}));
  EXPECT_EQ(names(search, "acidallum"), (std::vector<std::string>{"Mare Acidalium"}));
  EXPECT_TRUE(names(search, "gxx").empty());  // too short for an error
}

TEST(PlaceSearch, FindsByExactNameOnly) {
  const PlaceSearch search = some_places();
  ASSERT_NE(search.named("gale ra"), nullptr);
  EXPECT_EQ(search.named("gale ra")->name, "Gale-Ra");
  EXPECT_EQ(search.named("gal"), nullptr);
}

// The plain recursive definition, as an oracle.
int plain_errors(const std::string& a, const std::string& b) {
  if (a.empty()) return 0;  // what is left of the word does not count
  if (b.empty()) return static_cast<int>(a.size());
  int least = plain_errors(a.substr(1), b.substr(1)) + (a[0] == b[0] ? 0 : 1);
  least = std::min(least, plain_errors(a.substr(1), b) + 1);
  least = std::min(least, plain_errors(a, b.substr(1)) + 1);
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0])
    least = std::min(least, plain_errors(a.substr(2), b.substr(2)) + 1);
  return least;
}

RC_GTEST_PROP(PlaceSearch, TypingErrorsAreThoseOfTheDefinition, ()) {
  const auto word = rc::gen::container<std::string>(rc::gen::elementOf(std::string("abc")));
  const std::string typed = (*word).substr(0, 6);
  const std::string name = (*word).substr(0, 8);
  for (int most = 0; most <= 3; ++most)
    RC_ASSERT(typing_errors(typed, name, most) == std::min(plain_errors(typed, name), most + 1));
}

RC_GTEST_PROP(PlaceSearch, AnyBytesAreSearchedAndFolded, (std::string text)) {
  const PlaceSearch search({{text, 0, 0, 0}, {"Gale", 0, 0, 0}});
  const std::string once = folded(text);
  RC_ASSERT(folded(once) == once);
  if (!once.empty()) RC_ASSERT(search.find(text, 5).front()->name == text || once == "gale");
}

TEST(PlaceSearch, SightsComeFirst) {
  const std::vector<core::Place> places = sights_first(
      {{"Olympus Rupes", 0, 0, 5}, {"Gale", 0, 0, 4}, {"Olympus Mons", 0, 0, 3}, {"Ares", 0, 0, 2}});
  std::vector<std::string> order;
  for (const core::Place& place : places) order.push_back(place.name);
  EXPECT_EQ(order, (std::vector<std::string>{"Olympus Mons", "Gale", "Olympus Rupes", "Ares"}));
}

TEST(PlaceSearch, TheCarriedNamesAreFound) {
  const std::string file = mars::find_data_file("places/mars.csv");
  ASSERT_FALSE(file.empty());
  const PlaceSearch search(core::read_gazetteer(file));
  EXPECT_GT(search.places().size(), 1800U);
  for (const std::string_view name : kSights) EXPECT_NE(search.named(name), nullptr) << name;
  const auto found = search.find("olympus m", 8);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front()->name, "Olympus Mons");
}

TEST(LandingSites, TheCarriedFileHasAllThatAreKnown) {
  const std::string file = mars::find_data_file(kLandingsFile);
  ASSERT_FALSE(file.empty());
  const std::vector<LandingSite> sites = read_landing_sites(file);
  EXPECT_EQ(sites.size(), 15U);
  std::set<std::string> names;
  for (const LandingSite& site : sites) {
    names.insert(site.name);
    EXPECT_LE(std::abs(site.place.lon_deg), 180) << site.name;
    EXPECT_LE(std::abs(site.place.lat_deg), 90) << site.name;
    EXPECT_FALSE(site.mission.empty()) << site.name;
    EXPECT_FALSE(site.source.empty()) << site.name;
    EXPECT_EQ(site.landed.size(), 10U) << site.landed;
    EXPECT_EQ(to_place(site), (core::Place{site.name, site.place.lon_deg, site.place.lat_deg, 0}));
  }
  EXPECT_EQ(names.size(), sites.size());
  for (const char* name : {"Viking 1", "Curiosity", "Perseverance", "Zhurong", "Beagle 2"})
    EXPECT_TRUE(names.contains(name)) << name;
  // The file serves overlay.names, too.
  EXPECT_EQ(core::read_gazetteer(file).size(), sites.size());
}

// Craters of the IAU whose rovers are known to be inside.
TEST(LandingSites, LieInTheCratersThatTheyAreIn) {
  const PlaceSearch search(core::read_gazetteer(mars::find_data_file("places/mars.csv")));
  const std::vector<LandingSite> sites = read_landing_sites(mars::find_data_file(kLandingsFile));
  for (const auto& [lander, crater] :
       {std::pair{"Curiosity", "Gale"}, {"Perseverance", "Jezero"}, {"Spirit", "Gusev"}}) {
    const auto site = std::ranges::find(sites, lander, &LandingSite::name);
    const core::Place* around = search.named(crater);
    ASSERT_NE(site, sites.end());
    ASSERT_NE(around, nullptr);
    EXPECT_LT(mars::distance_rad(site->place, {around->lon_deg, around->lat_deg}) * mars::kMarsRadius_m,
              around->diameter_m / 2)
        << lander;
  }
}

TEST(LandingSites, AreDescribed) {
  const LandingSite site{"L", {1, 2}, "M", "2000-01-02", "landing", {}, "S"};
  EXPECT_EQ(describe(site), "landing of M, 2000-01-02, accuracy unknown");
  EXPECT_EQ(describe({"L", {1, 2}, "M", "2000-01-02", "predicted", 1500, "S"}),
            "predicted landing of M, 2000-01-02, accuracy 1500 m");
}

TEST(LandingSites, BadFilesAreRefused) {
  const test_support::TempDir folder;
  const std::string file = (folder / "sites.csv").string();
  const auto error_of = [&](const std::string& text) {
    std::ofstream(file) << text;
    try {
      (void)read_landing_sites(file);
    } catch (const std::exception& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string head = "name,lon,lat,mission,landed,kind,accuracy_m,source\n";
  EXPECT_EQ(error_of(head + "a,1,2,m,2000-01-01,landing,5,s\n"), "");
  EXPECT_EQ(error_of(head + "a,1,2,m,2000-01-01,landing,unknown,s\nb,1,2,m,2000-01-01,impact,7.5,s\n"), "");
  for (const auto& [text, word] :
       {std::pair<std::string, const char*>{head + "a,1,2,m,d,flight,5,s\n", "flight"},
        {head + "a,1,2,m,d,landing,near,s\n", "near"},
        {head + "a,1,2,m,d,landing,-1,s\n", "-1"},
        {head + ",1,2,m,d,landing,1,s\n", "a name"},
        {head + "a,1,95,m,d,landing,1,s\n", "95"},
        {"name,lon,lat\na,1,2\n", "mission"}}) {
    const std::string error = error_of(text);
    EXPECT_NE(error.find(word), std::string::npos) << error;
    EXPECT_NE(error.find("sites.csv"), std::string::npos) << error;
  }
  EXPECT_THROW((void)read_landing_sites((folder / "none.csv").string()), std::exception);
}

// The outline of a place, seen from where one arrives, lies in the image and fills it.
TEST(Arrival, ShowsThePlaceAtItsSize) {
  const TerrainQuery ground = ball(mars::kMarsRadius_m);
  for (const Screen& screen : {Screen{1280, 720, 50}, Screen{400, 900, 60}, Screen{640, 400, 30}}) {
    for (const double diameter_m : {500.0, 20e3, 154e3, 610e3, 2300e3}) {
      for (const mars::LonLat at : {mars::LonLat{137.8, -5.4}, mars::LonLat{-180, 88}, mars::LonLat{0, -90}}) {
        const mars::Pose pose = arrival({"x", at.lon_deg, at.lat_deg, diameter_m}, screen, ground);
        const core::View view = view_of(pose, screen, ground.radius_m);
        const auto middle = core::project(view, mars::direction(at) * ground.radius_m);
        EXPECT_NEAR(middle.xy.x, screen.width / 2.0, 0.01);
        EXPECT_NEAR(middle.xy.y, screen.height / 2.0, 0.01);
        double widest_px = 0;
        for (int n = 0; n < 36; ++n) {
          const mars::LonLat rim = mars::destination(at, 10.0 * n, diameter_m / 2 / ground.radius_m);
          const auto p = core::project(view, mars::direction(rim) * ground.radius_m);
          ASSERT_FALSE(p.behind);
          EXPECT_GT(p.xy.x, -0.1 * screen.width);
          EXPECT_LT(p.xy.x, 1.1 * screen.width);
          EXPECT_GT(p.xy.y, 0);
          EXPECT_LT(p.xy.y, screen.height);
          widest_px = std::max(widest_px, std::abs(p.xy.x - middle.xy.x));
        }
        const double shorter_px = std::min(screen.width, screen.height);
        EXPECT_GT(widest_px, 0.25 * shorter_px) << diameter_m;
        EXPECT_LT(widest_px, 0.55 * shorter_px) << diameter_m;
      }
    }
  }
}

TEST(Arrival, StaysAboveTheGround) {
  TerrainQuery wall = ball(mars::kMarsRadius_m);
  wall.height_m = [](const glm::dvec3& d) { return mars::lon_lat(d).lat_deg < -0.001 ? 5000.0 : 0.0; };
  const mars::Pose pose = arrival({"x", 0, 0, 1000}, {}, wall);
  EXPECT_GT(pose.alt_m, wall.height_m(mars::direction({pose.lon_deg, pose.lat_deg})));
  EXPECT_NEAR(pose.pitch_deg, ArrivalLimits::kTilt_deg, 0.1);
}

}  // namespace
}  // namespace vpe::explore
