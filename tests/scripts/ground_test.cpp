// Lines of flights that change the ground.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

#include "mars/geodesy/sphere.h"
#include "relief/relief.h"
#include "relief/spec_line.h"
#include "scripts/ground_tracks.h"
#include "scripts/path.h"
#include "tests/support/support.h"

namespace scripts {
namespace {

using relief::ReliefSpec;

constexpr const char* kPit = "relief pit kind=crater lon=137 lat=-5 radius=100 depth=20\n";

std::string in_1_3(const std::string& lines) { return "flight 1.3\nat 0 pose lon=0 lat=0 alt=1\n" + lines; }

Flight flight_of(const std::string& lines) {
  const ParsedFlight parsed = parse_flight(in_1_3(lines), "F.flight");
  if (!parsed.flight) throw std::logic_error(to_string(parsed.errors.at(0)));
  return *parsed.flight;
}

GroundTracks ground_of(const std::string& lines) { return {flight_of(lines), mars::kMarsRadius_m}; }

void expect_error(const std::string& lines, int line, const std::string& part) {
  const ParsedFlight parsed = parse_flight(in_1_3(lines), "F.flight");
  ASSERT_EQ(parsed.errors.size(), 1U) << lines;
  EXPECT_EQ(parsed.errors[0].line, line) << lines;
  EXPECT_NE(parsed.errors[0].expected.find(part), std::string::npos)
      << parsed.errors[0].expected << "\nwanted: " << part;
}

// Returns the only relief at a time.
ReliefSpec only(const GroundTracks& ground, double time_s) {
  const GroundState state = ground.at(time_s);
  if (state.reliefs.size() != 1) throw std::logic_error("expected one relief");
  return state.reliefs[0];
}

TEST(GroundLines, AreReadAndWritten) {
  const Flight flight = flight_of(
      "at 1 relief \"a pit #1\" kind=crater lon=137 lat=-5 radius=100 depth=20\n"
      "at 1 patch \"new strip.tif\" mix=0\n"
      "at 3 relief \"a pit #1\" strength=0.5 show=off   # a comment\n"
      "at 4 patch \"new strip.tif\" mix=1\n");
  const std::vector<ReliefCommand> reliefs{
      {1, "a pit #1", "kind=crater lon=137 lat=-5 radius=100 depth=20", {}},
      {3, "a pit #1", "strength=0.5", false}};
  EXPECT_EQ(flight.reliefs, reliefs);
  EXPECT_EQ(flight.patches, (std::vector<PatchCommand>{{1, "new strip.tif", 0}, {4, "new strip.tif", 1}}));
  EXPECT_EQ(duration_s(flight), 4);
  EXPECT_EQ(version_of(flight), FlightVersion::k1_3);
  EXPECT_EQ(version_line(FlightVersion::k1_3), "flight 1.3\n");
  EXPECT_EQ(to_line(flight.reliefs[1]), "at 3 relief \"a pit #1\" strength=0.5 show=off\n");
  EXPECT_EQ(to_line(flight.patches[1]), "at 4 patch \"new strip.tif\" mix=1\n");
  EXPECT_EQ(parse_flight(to_text(flight), "F").flight, flight);
}

TEST(GroundLines, ThatAreWrongAreRefused) {
  const std::string pit = std::string("at 1 ") + kPit;
  const ParsedFlight old = parse_flight("flight 1.2\nat 0 pose lon=0 lat=0 alt=1\n" + pit, "F");
  ASSERT_EQ(old.errors.size(), 1U);
  EXPECT_NE(old.errors[0].expected.find("\"flight 1.3\" as the first command"), std::string::npos);
  expect_error("at 1 jump\n", 3, "object, relief, patch or end after the time");
  expect_error("at 1 relief\n", 3, "the name of a relief, 1 to 200 bytes");
  expect_error("at 1 relief " + std::string(201, 'a') + " kind=crater lon=1 lat=1 radius=9\n", 3, "the name");
  expect_error("at 1 relief pit radius=100\n", 3, "kind=.. with all keys that it needs");
  expect_error("at 1 relief pit show=off\n", 3, "kind=.. with all keys");
  expect_error("at 1 relief pit kind=crater lon=1 lat=1\n", 3, "radius is missing");
  expect_error("at 1 relief pit kind=crater lon=1 radius=2\n", 3, "lat is missing");
  expect_error("at 1 relief pit kind=crater lon=1 lat=91 radius=2\n", 3,
               "lat: expected a number from -90 to 90");
  expect_error("at 1 relief pit kind=crater lon=1 lat=1 radius=-2\n", 3, "radius_m: expected");
  expect_error("at 1 relief pit kind=crater lon=1 lat=1 radius=nan\n", 3, "radius_m: expected");
  expect_error("at 1 relief pit kind=crater lon=1 lat=1 radius=inf\n", 3, "radius_m: expected");
  expect_error("at 1 relief pit kind=hole lon=1 lat=1 radius=2\n", 3, "kind: expected one of");
  expect_error("at 1 relief pit kind=crater lon=1 lat=1 radius=2 hue=3\n", 3, "unknown key \"hue\"");
  expect_error("at 1 relief pit kind=crater lon=1 lat=1 radius=2 height=3\n", 3, "a crater has no such key");
  expect_error(pit + "at 2 relief pit\n", 4, "keys of a relief, or show=on or show=off");
  expect_error(pit + "at 2 relief pit deep\n", 4, "expected KEY=VALUE");
  expect_error(pit + "at 2 relief pit strength=1.5\n", 4, "strength: expected a number from 0 to 1");
  expect_error(pit + "at 2 relief pit show=no\n", 4, "show=on or show=off, found \"no\"");
  expect_error(pit + "at 2 relief pit show=on show=on\n", 4, "show once");
  expect_error(pit + "at 1 relief pit radius=9\n", 4, "one line of \"pit\" at 1 s, found a second one");
  expect_error(pit + "at 2 relief pit depth=auto\n", 4, "depth_m as a number, or as auto, in both lines");
  expect_error(pit + "at 2 relief pit rim=9\n", 4, "rim_m as a number, or as auto, in both lines");
  expect_error(pit + "at 2 relief pit spacing=3\n", 4, "spacing in the line with kind alone");
  expect_error("at 1 patch\n", 3, "a planet, a raster or a file *.relief.toml");
  expect_error("at 1 patch a.vpe\n", 3, "mix=NUMBER from 0 to 1 after \"a.vpe\"");
  expect_error("at 1 patch a.vpe mix=1.01\n", 3, "mix=NUMBER from 0 to 1, found \"1.01\"");
  expect_error("at 1 patch a.vpe mix=-1\n", 3, "mix=NUMBER from 0 to 1");
  expect_error("at 1 patch a.vpe mix=nan\n", 3, "mix=NUMBER from 0 to 1");
  expect_error("at 1 patch a.vpe mix=1 mix=0\n", 3, "mix once");
  expect_error("at 1 patch a.vpe share=1\n", 3, "mix=NUMBER, found");
  expect_error("at 1 patch a.vpe mix=1\nat 1 patch a.vpe mix=0\n", 4, "one line of \"a.vpe\" at 1 s");
}

TEST(GroundTracks, AReliefIsThereFromItsLineOn) {
  const GroundTracks ground = ground_of(std::string("at 1 ") + kPit + "at 5 end\n");
  EXPECT_TRUE(GroundTracks().empty());
  EXPECT_TRUE(ground_of("at 5 end\n").empty());
  EXPECT_FALSE(ground.empty());
  EXPECT_TRUE(ground.at(0.999).empty());
  for (const double time_s : {1.0, 3.0, 5.0, 99.0}) {
    const ReliefSpec pit = only(ground, time_s);
    EXPECT_EQ(pit.name, "pit");
    EXPECT_EQ(pit.radius_m, 100);
    EXPECT_EQ(pit.depth_m, 20);
  }
  EXPECT_EQ(ground.names(), std::vector<std::string>{"relief pit"});
  EXPECT_EQ(ground.times_s(), std::vector<double>{1});
}

TEST(GroundTracks, NumbersChangeSmoothlyAndNeverBeyondTheirLines) {
  const GroundTracks ground = ground_of(std::string("at 1 ") + kPit +
                                        "at 3 relief pit depth=60\n"
                                        "at 5 relief pit radius=500\n"
                                        "at 9 relief pit strength=0\nat 12 end\n");
  EXPECT_EQ(only(ground, 1).radius_m, 100);
  EXPECT_EQ(only(ground, 5).radius_m, 500);
  EXPECT_EQ(only(ground, 3).depth_m, 60);
  EXPECT_EQ(only(ground, 8).depth_m, 60);
  // A strength that is given once before counts from the first line on.
  EXPECT_LT(only(ground, 2).strength, 1);
  EXPECT_TRUE(ground.at(9).empty());
  double radius_m = 100;
  double depth_m = 20;
  constexpr double kStep_s = 0.01;
  for (double time_s = 1; time_s < 8.9; time_s += kStep_s) {
    const ReliefSpec pit = only(ground, time_s);
    EXPECT_GE(*pit.radius_m, radius_m);
    // Curves of this kind are at most three times as steep as the straight line.
    EXPECT_LE(*pit.radius_m - radius_m, 3 * 400 / 4.0 * kStep_s + 1e-9);
    EXPECT_LE(std::abs(*pit.depth_m - depth_m), 3 * 40 / 2.0 * kStep_s + 1e-9);
    radius_m = *pit.radius_m;
    depth_m = *pit.depth_m;
  }
}

TEST(GroundTracks, AnglesTurnTheShortWay) {
  const GroundTracks ground = ground_of(
      "at 0 relief ridge kind=dune lon=179 lat=1 height=5 azimuth=350\n"
      "at 2 relief ridge lon=-179 azimuth=10\nat 2 end\n");
  EXPECT_EQ(only(ground, 0).azimuth_deg, 350);
  EXPECT_EQ(only(ground, 2).azimuth_deg, 10);
  EXPECT_NEAR(only(ground, 1).azimuth_deg, 0, 1e-9);
  EXPECT_NEAR(std::abs(only(ground, 1).place.lon_deg), 180, 1e-9);
  for (double time_s = 0; time_s <= 2; time_s += 0.05) {
    EXPECT_GE(std::abs(only(ground, time_s).place.lon_deg), 179 - 1e-9);
    EXPECT_LE(std::abs(std::remainder(only(ground, time_s).azimuth_deg, 360)), 10 + 1e-9);
  }
}

TEST(GroundTracks, WordsAndWholeNumbersSwitch) {
  const GroundTracks ground = ground_of(
      "at 0 relief field kind=noise lon=1 lat=1 radius=50 amplitude=2 wavelength=20 seed=3\n"
      "at 2 relief field mode=max seed=9 octaves=6 amplitude=4\nat 2 end\n");
  EXPECT_EQ(only(ground, 1.999).seed, 3);
  EXPECT_EQ(only(ground, 1.999).octaves, 4);
  EXPECT_FALSE(only(ground, 1.999).mode.has_value());
  EXPECT_EQ(only(ground, 2).seed, 9);
  EXPECT_EQ(only(ground, 2).octaves, 6);
  EXPECT_EQ(only(ground, 2).mode, relief::Mode::kMax);
  EXPECT_DOUBLE_EQ(*only(ground, 1).amplitude_m, 3);
}

TEST(GroundTracks, ALineWithKindBeginsAnew) {
  const GroundTracks ground = ground_of(std::string("at 0 ") + kPit +
                                        "at 2 relief pit kind=pad lon=137 lat=-5 radius=30\n"
                                        "at 3 relief pit show=off\nat 4 relief pit show=on\nat 6 end\n");
  EXPECT_EQ(only(ground, 1.9).kind, relief::ReliefKind::kCrater);
  EXPECT_EQ(*only(ground, 1.9).radius_m, 100);
  EXPECT_EQ(only(ground, 2).kind, relief::ReliefKind::kPad);
  EXPECT_FALSE(only(ground, 2).depth_m.has_value());
  EXPECT_TRUE(ground.at(3).empty());
  EXPECT_TRUE(ground.at(3.9).empty());
  EXPECT_EQ(*only(ground, 4).radius_m, 30);
}

TEST(GroundTracks, StatesAreSoundWhileAModeChanges) {
  const GroundTracks ground = ground_of(
      "at 0 relief a kind=noise lon=1 lat=1 radius=50 amplitude=2 wavelength=20\n"
      "at 2 relief a mode=max rise=5\nat 2 end\n");
  for (double time_s = 0; time_s <= 2; time_s += 0.25)
    EXPECT_EQ(relief::problem_of(only(ground, time_s)), "") << time_s;
  EXPECT_EQ(only(ground, 1).rise_m, 0);
  EXPECT_EQ(only(ground, 2).rise_m, 5);
}

TEST(GroundTracks, PostsKeepTheirDistance) {
  const GroundTracks ground = ground_of(std::string("at 0 ") + kPit + "at 4 relief pit radius=150\nat 4 end\n");
  const double spacing_m = only(ground, 0).spacing_m.value();
  const ReliefSpec small = relief::parse_relief_line("kind=crater lon=137 lat=-5 radius=100 depth=20");
  EXPECT_EQ(spacing_m, relief::PlacedRelief(small, mars::kMarsRadius_m).spacing_m());
  EXPECT_EQ(only(ground, 2).spacing_m, spacing_m);
  EXPECT_EQ(only(ground, 4).spacing_m, spacing_m);
  // A relief that begins tiny does not ask for posts without end.
  const GroundTracks tiny = ground_of(
      "at 0 relief pit kind=crater lon=137 lat=-5 radius=0.01\nat 4 relief pit radius=100\nat 4 end\n");
  const ReliefSpec large = relief::parse_relief_line("kind=crater lon=137 lat=-5 radius=100");
  EXPECT_DOUBLE_EQ(only(tiny, 0).spacing_m.value(),
                   relief::PlacedRelief(large, mars::kMarsRadius_m).spacing_m() / 4);
  const GroundTracks own = ground_of(
      "at 0 relief pit kind=crater lon=137 lat=-5 radius=9 spacing=7\nat 4 relief pit radius=100\nat 4 end\n");
  EXPECT_EQ(only(own, 3).spacing_m, 7);
}

TEST(GroundTracks, PatchesAreMixedInFromTheirFirstLineOn) {
  const GroundTracks ground = ground_of(
      "at 1 patch b.vpe mix=0\nat 2 patch a.tif mix=1\nat 3 patch b.vpe mix=1\nat 5 patch b.vpe mix=0\nat 5 end\n");
  EXPECT_EQ(ground.files(), (std::vector<std::string>{"b.vpe", "a.tif"}));
  EXPECT_TRUE(ground.at(1).empty());
  const GroundState both = ground.at(2.5);
  ASSERT_EQ(both.patches.size(), 2U);
  EXPECT_EQ(both.patches[0].file, "b.vpe");
  EXPECT_GT(both.patches[0].mix, 0.5);
  EXPECT_LT(both.patches[0].mix, 1);
  EXPECT_EQ(both.patches[1], (PatchState{"a.tif", 1}));
  EXPECT_EQ(ground.at(3).patches[0].mix, 1);
  EXPECT_EQ(ground.at(5).patches.size(), 1U);
}

TEST(GroundTracks, StatesDoNotDependOnTheOrderOfQuestions) {
  const Flight flight = flight_of(std::string("at 0 ") + kPit +
                                  "at 3 relief pit radius=300 depth=70\nat 4 patch b.vpe mix=0\n"
                                  "at 7 relief pit strength=0.25\nat 9 patch b.vpe mix=0.75\nat 9 end\n");
  const GroundTracks ground(flight, mars::kMarsRadius_m);
  std::vector<GroundState> forwards;
  for (int k = 0; k < 90; ++k) forwards.push_back(ground.at(0.1 * k));
  for (int k = 89; k >= 0; --k) EXPECT_EQ(ground.at(0.1 * k), forwards[static_cast<std::size_t>(k)]);
  const GroundTracks again(*parse_flight(to_text(flight), "F").flight, mars::kMarsRadius_m);
  EXPECT_EQ(again, ground);
  EXPECT_FALSE(again == GroundTracks());
  for (int k = 0; k < 90; ++k)
    EXPECT_EQ(lines_of(again.at(0.1 * k)), lines_of(forwards[static_cast<std::size_t>(k)]));
}

TEST(GroundTracks, LinesNameAllThatChangesTheGround) {
  const GroundTracks ground = ground_of(std::string("at 0 ") + kPit + "at 0 patch b.vpe mix=0.5\nat 1 end\n");
  const std::vector<std::string> lines = lines_of(ground.at(0));
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], "patch b.vpe mix=0.5");
  EXPECT_TRUE(lines[1].starts_with("relief pit kind=crater lon=137 lat=-5 ")) << lines[1];
  EXPECT_NE(lines[1].find(" depth=20"), std::string::npos) << lines[1];
}

// Neighbouring frames differ by no more than the change of the numbers explains, wherever one looks.
TEST(GroundTracks, HeightsDoNotJumpBetweenFrames) {
  const GroundTracks ground = ground_of(
      "at 0 relief pit kind=crater lon=137 lat=-5 radius=200 depth=20 rim=4 floor_ratio=0.1 peak=1\n"
      "at 4 relief pit radius=400 depth=80 rim=16 lon=137.005\n"
      "at 4 end\n");
  constexpr double kStep_s = 1.0 / 30;
  test_support::Random random(5);
  std::vector<glm::dvec3> places;
  for (int n = 0; n < 400; ++n)
    places.push_back(mars::direction({137 + random.uniform(-0.03, 0.03), -5 + random.uniform(-0.03, 0.03)}));
  const auto heights_at = [&](double time_s) {
    const relief::Relief relief = relief::place(ground.at(time_s).reliefs, mars::kMarsRadius_m, {});
    std::vector<double> heights_m;
    for (const glm::dvec3& place : places) heights_m.push_back(relief.height_m(place, 0));
    return heights_m;
  };
  std::vector<double> before_m = heights_at(0);
  ReliefSpec was = only(ground, 0);
  double largest_m = 0;
  for (double time_s = kStep_s; time_s <= 4; time_s += kStep_s) {
    const ReliefSpec is = only(ground, time_s);
    // The height is depth, rim and peak times profiles within 1, whose slopes by the distance over the radius are at most
    // 5, and the place moves by so many metres.
    const double moved_m = mars::distance_rad(was.place, is.place) * mars::kMarsRadius_m;
    const double sizes_m = std::abs(*is.depth_m - *was.depth_m) + std::abs(*is.rim_m - *was.rim_m) +
                           std::abs(*is.peak_m - *was.peak_m);
    const double reach = is.ejecta_ratio;
    const double ratio = (moved_m + reach * std::abs(*is.radius_m - *was.radius_m)) / *was.radius_m;
    const double bound_m = sizes_m + 5 * ratio * (*is.depth_m + *is.rim_m + *is.peak_m);
    const std::vector<double> now_m = heights_at(time_s);
    for (std::size_t n = 0; n < now_m.size(); ++n) {
      EXPECT_LE(std::abs(now_m[n] - before_m[n]), bound_m) << time_s;
      largest_m = std::max(largest_m, std::abs(now_m[n] - before_m[n]));
    }
    before_m = now_m;
    was = is;
  }
  EXPECT_GT(largest_m, 0.1);
}

TEST(GroundTracks, ReliefsThatReachTooFarAreRefused) {
  const Flight flight =
      flight_of("at 1 relief sea kind=pad lon=0 lat=0 radius=9000\nat 2 relief sea radius=9e6\n");
  try {
    GroundTracks(flight, mars::kMarsRadius_m);
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("the relief \"sea\" at 2 s: it reaches"), std::string::npos)
        << e.what();
  }
  Flight bare;
  bare.reliefs = {{1, "x", "radius=3", {}}};
  EXPECT_THROW(GroundTracks(bare, mars::kMarsRadius_m), std::runtime_error);
}

TEST(GroundTracks, BelongToThePath) {
  const Path path(flight_of(std::string("at 1 ") + kPit), mars::kMarsRadius_m, {});
  ASSERT_NE(path.ground(), nullptr);
  EXPECT_EQ(path.ground()->at(1).reliefs.size(), 1U);
  EXPECT_EQ(path.ground_at(1), path.ground()->at(1));
  EXPECT_EQ(Path(flight_of("at 2 end\n"), mars::kMarsRadius_m, {}).ground(), nullptr);
  EXPECT_TRUE(Path(flight_of("at 2 end\n"), mars::kMarsRadius_m, {}).ground_at(1).empty());
  const auto rising = [](mars::LonLat, double exaggeration, double time_s) { return exaggeration * time_s; };
  const Flight flight = flight_of("at 2 end\n");
  const auto lowest = lowest_clearance(Path(flight, mars::kMarsRadius_m, {}), {1, 1}, rising);
  ASSERT_TRUE(lowest.has_value());
  EXPECT_EQ(lowest->time_s, 1);
  EXPECT_EQ(lowest->height_m, 0);
}

}  // namespace
}  // namespace scripts
