#include "vpe/explore/files/hotspots.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <fstream>

#include "tests/support/support.h"
#include "vpe/base/file.h"

namespace vpe::explore {
namespace {

std::string fault_of(const std::string& text, int line) {
  const ParsedHotspots parsed = parse_hotspots(text, "/a/S");
  EXPECT_TRUE(parsed.hotspots.empty()) << text;
  EXPECT_EQ(parsed.errors.size(), 1U) << text;
  if (parsed.errors.empty()) return "";
  EXPECT_EQ(parsed.errors[0].line, line) << text;
  return to_string(parsed.errors[0]);
}

TEST(Hotspots, AreReadWithPathsRelativeToTheFile) {
  const ParsedHotspots parsed = parse_hotspots(
      "\xef\xbb\xbf# spots\r\n"
      "spot \"Glen Torridon\" 137.39 -4.72 2 ../panoramas/torridon.json  # with layers\r\n"
      "\n"
      "spot \"A \\\"rim\\\" #1\" 0 0 1.5 \"/abs/my pano.png\"\n"
      "spot Rim 360 -90 0 rim.tif",
      "/home/u/mars/spots");
  ASSERT_TRUE(parsed.errors.empty()) << to_string(parsed.errors[0]);
  ASSERT_EQ(parsed.hotspots.size(), 3U);
  EXPECT_EQ(parsed.hotspots[0].name, "Glen Torridon");
  EXPECT_EQ(parsed.hotspots[0].place.lon_deg, 137.39);
  EXPECT_EQ(parsed.hotspots[0].place.lat_deg, -4.72);
  EXPECT_EQ(parsed.hotspots[0].height_m, 2);
  EXPECT_EQ(parsed.hotspots[0].panorama, "/home/u/panoramas/torridon.json");
  EXPECT_EQ(parsed.hotspots[1].name, "A \"rim\" #1");
  EXPECT_EQ(parsed.hotspots[1].panorama, "/abs/my pano.png");
  EXPECT_EQ(parsed.hotspots[2].panorama, "/home/u/mars/rim.tif");
  EXPECT_TRUE(parse_hotspots("", "S").hotspots.empty());
  EXPECT_EQ(parse_hotspots("spot a 1 2 3 p.png", "S").hotspots[0].panorama, "p.png");
}

TEST(Hotspots, BadLinesAreReportedByNumber) {
  EXPECT_EQ(fault_of("\nsport a 1 2 3 p\n", 2),
            "/a/S:2: expected a line that begins with spot, found \"sport\"");
  EXPECT_NE(fault_of("spot Glen Torridon 1 2 3 p\n", 1).find("found 7 words; a name or path with blanks"),
            std::string::npos);
  EXPECT_NE(fault_of("spot a 1 91 3 p\n", 1).find("a latitude from -90 to 90, found \"91\""),
            std::string::npos);
  EXPECT_NE(fault_of("spot a 1e3 9 3 p\n", 1).find("a longitude from -360 to 360"), std::string::npos);
  EXPECT_NE(fault_of("spot a 1 9 -3 p\n", 1).find("a height above the ground"), std::string::npos);
  EXPECT_NE(fault_of("spot a 1 nan 3 p\n", 1).find("a latitude"), std::string::npos);
  EXPECT_NE(fault_of("spot a 1 2 3 p\nspot a 2 2 3 q\n", 2).find("\"a\" again after line 1"),
            std::string::npos);
  EXPECT_NE(fault_of("spot \"a 1 2 3 p\n", 1).find("a closing quote"), std::string::npos);
  EXPECT_NE(fault_of("spot \"a\"b 1 2 3 p\n", 1).find("a blank after a closing quote"), std::string::npos);
  EXPECT_NE(fault_of("spot \"\" 1 2 3 p\n", 1).find("a name"), std::string::npos);
  EXPECT_NE(fault_of("spot a 1 2 3 \"\"\n", 1).find("the path"), std::string::npos);
  EXPECT_NE(fault_of(std::string("spot \0\xff 1 2 3 p\n", 16), 1).find("a name"), std::string::npos);
}

TEST(Hotspots, LinesReadBackAsTheyWere) {
  rc::check([] {
    const auto word = rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange<char>(' ', '~')));
    Hotspot hotspot{*word, {-12.345678901234567, 1.0 / 3}, 2.1, "/" + *word};
    const ParsedHotspots parsed = parse_hotspots(to_line(hotspot), "/x/S");
    RC_ASSERT(parsed.errors.empty());
    RC_ASSERT(parsed.hotspots.size() == 1U);
    RC_ASSERT(parsed.hotspots[0].name == hotspot.name);
    RC_ASSERT(parsed.hotspots[0].place.lon_deg == hotspot.place.lon_deg);
    RC_ASSERT(parsed.hotspots[0].panorama == hotspot.panorama.lexically_normal());
  });
}

TEST(Hotspots, AMissingFileIsReported) {
  const test_support::TempDir folder;
  EXPECT_THROW(load_hotspots(folder / "spots"), base::FileError);
  std::ofstream(folder / "spots") << "spot a 1 2 3 p.png\n";
  EXPECT_EQ(load_hotspots(folder / "spots").hotspots.at(0).panorama, folder / "p.png");
}

// Hotspots along the equator, 1 km apart, 2 m above ground at 100 m.
std::vector<glm::dvec3> row_of_hotspots(int count) {
  std::vector<Hotspot> hotspots;
  for (int n = 0; n < count; ++n) {
    hotspots.push_back(
        {"s" + std::to_string(n), {n * 1000.0 / mars::kMarsRadius_m / mars::kRadiansPerDegree, 0}, 2, "p"});
  }
  return hotspot_positions(hotspots, mars::kMarsRadius_m,
                           [](mars::LonLat, double exaggeration) { return 100 * exaggeration; });
}

glm::dvec3 camera_at(double east_m, double alt_m = 102) {
  return (mars::kMarsRadius_m + alt_m) *
         mars::direction({east_m / mars::kMarsRadius_m / mars::kRadiansPerDegree, 0});
}

TEST(Hotspots, TheNearestWithinADistance) {
  const auto positions = row_of_hotspots(5);
  EXPECT_NEAR(glm::length(positions[0]), mars::kMarsRadius_m + 102, 1e-6);
  const auto near = nearest_hotspot(positions, camera_at(2100), 500);
  ASSERT_TRUE(near.has_value());
  EXPECT_EQ(near->index, 2U);
  EXPECT_NEAR(near->distance_m, 100, 0.1);
  EXPECT_FALSE(nearest_hotspot(positions, camera_at(2400), 300).has_value());
  EXPECT_FALSE(nearest_hotspot(positions, camera_at(2000, 5000), 3000).has_value());  // far above counts as far
  EXPECT_FALSE(nearest_hotspot({}, camera_at(0), 1e9).has_value());
  const Hotspot hotspot{"a", {0, 0}, 2, "p"};
  const auto unknown = hotspot_positions(std::span(&hotspot, 1), mars::kMarsRadius_m, {});
  EXPECT_FALSE(nearest_hotspot(unknown, camera_at(0), 1e9).has_value());
}

TEST(HotspotTrackers, StagesBeginAndEndAtDifferentDistances) {
  HotspotTracker tracker(row_of_hotspots(1), {.approach_m = 1000, .reach_m = 100, .leave_factor = 1.5});
  const auto stage = [&](double east_m) { return tracker.update(camera_at(east_m)).stage; };
  EXPECT_EQ(stage(1100), HotspotStage::kFar);
  EXPECT_EQ(stage(990), HotspotStage::kApproaching);
  EXPECT_EQ(stage(1400), HotspotStage::kApproaching);
  EXPECT_EQ(stage(1600), HotspotStage::kFar);
  EXPECT_EQ(stage(1400), HotspotStage::kFar);
  EXPECT_EQ(stage(90), HotspotStage::kWithinReach);
  EXPECT_EQ(stage(140), HotspotStage::kWithinReach);
  EXPECT_EQ(stage(160), HotspotStage::kApproaching);
  EXPECT_EQ(stage(140), HotspotStage::kApproaching);
  EXPECT_EQ(tracker.state().hotspot.index, 0U);
  EXPECT_NEAR(tracker.state().hotspot.distance_m, 140, 0.1);
}

// Moves back and forth between two hotspots with jitter at every limit: few changes.
TEST(HotspotTrackers, NothingFlickers) {
  HotspotTracker tracker(row_of_hotspots(3), {.approach_m = 700, .reach_m = 100});
  int changes = 0;
  auto last = tracker.state();
  for (double east_m = -2000; east_m < 4000; east_m += 5) {
    for (const double trembling : {0.0, 8.0, -8.0}) {
      const auto now = tracker.update(camera_at(east_m + trembling));
      changes += now == last ? 0 : 1;
      last = now;
    }
  }
  // Far, then approaching, within reach, approaching for each of three, then far.
  EXPECT_EQ(changes, 10);
}

TEST(HotspotTrackers, AJumpToAnotherHotspotTakesEffectAtOnce) {
  HotspotTracker tracker(row_of_hotspots(50), {});
  EXPECT_EQ(tracker.update(camera_at(3000)).hotspot.index, 3U);
  const auto state = tracker.update(camera_at(40000));
  EXPECT_EQ(state.stage, HotspotStage::kWithinReach);
  EXPECT_EQ(state.hotspot.index, 40U);
  EXPECT_EQ(HotspotTracker({}, {}).update(camera_at(0)).stage, HotspotStage::kFar);
}

}  // namespace
}  // namespace vpe::explore
