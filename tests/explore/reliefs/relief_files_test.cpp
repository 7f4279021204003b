// Usual reliefs and their outlines, files of reliefs, and flights in which reliefs form.
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <stdexcept>

#include "relief/files/relief_file.h"
#include "relief/placed.h"
#include "scripts/ground_tracks.h"
#include "tests/support/support.h"
#include "vpe/base/file.h"
#include "vpe/explore/reliefs/relief_flight.h"
#include "vpe/explore/reliefs/relief_saving.h"
#include "vpe/explore/reliefs/usual_relief.h"

namespace vpe::explore {
namespace {

namespace fs = std::filesystem;
using relief::ReliefKind;
using relief::ReliefSpec;

constexpr double kRadius_m = 3'396'190;

std::vector<ReliefKind> all_kinds() {
  std::vector<ReliefKind> kinds;
  for (int kind = 0; kind < 8; ++kind) kinds.push_back(static_cast<ReliefKind>(kind));
  return kinds;
}

std::string text_in(const fs::path& file) {
  const auto bytes = base::read_file(file, 1 << 20);
  return {bytes.begin(), bytes.end()};
}

TEST(UsualRelief, CanBePlacedAtAnySize) {
  for (const ReliefKind kind : all_kinds()) {
    for (const double size_m : {0.0, 1e-9, 0.5, 37.123, 8000.0, 2e5, 1e9, 1e300}) {
      const ReliefSpec relief = usual_relief(kind, {10, 20}, size_m, 725);
      EXPECT_EQ(relief::problem_of(relief), "") << relief::kind_word(kind) << " of " << size_m;
    }
    const ReliefSpec relief = usual_relief(kind, {10, 20}, 1234, 95);
    const relief::PlacedRelief placed(relief, kRadius_m);
    EXPECT_GT(placed.shapes().reach_m, 0.3 * 1234) << relief::kind_word(kind);
    EXPECT_LT(placed.shapes().reach_m, 6 * 1234) << relief::kind_word(kind);
  }
  EXPECT_EQ(*usual_relief(ReliefKind::kCrater, {0, 0}, 1234, 0).radius_m, 740);
  EXPECT_EQ(usual_relief(ReliefKind::kDam, {0, 0}, 1234, 265.2).azimuth_deg, -95);
}

TEST(UsualRelief, OutlinesLieAroundTheirPlaces) {
  for (const ReliefKind kind : all_kinds()) {
    const ReliefSpec relief = usual_relief(kind, {-120, 70}, 5000, 30);
    const double reach_m = relief::PlacedRelief(relief, kRadius_m).shapes().reach_m;
    const std::vector<glm::dvec3> outline = relief_outline(relief, kRadius_m);
    ASSERT_GE(outline.size(), 3U);
    glm::dvec3 sum(0);
    for (const glm::dvec3& corner : outline) {
      EXPECT_NEAR(glm::length(corner), 1, 1e-12);
      EXPECT_LE(mars::angle_between_rad(corner, mars::direction(relief.place)) * kRadius_m, 1.001 * reach_m)
          << relief::kind_word(kind);
      sum += corner;
    }
    EXPECT_LT(mars::angle_between_rad(sum, mars::direction(relief.place)) * kRadius_m, 10);
  }
  // A trench of 7500 m towards the azimuth of 90 degrees reaches half of that to the east.
  const ReliefSpec trench = usual_relief(ReliefKind::kTrench, {0, 0}, 5000, 90);
  double east_m = 0;
  for (const glm::dvec3& corner : relief_outline(trench, kRadius_m))
    east_m = std::max(east_m, kRadius_m * std::asin(corner.y));
  EXPECT_NEAR(east_m, *trench.length_m / 2, 1);
  ReliefSpec flood;
  flood.kind = ReliefKind::kFlood;
  flood.polygon = {{1, 1}, {2, 1}, {2, 2}};
  EXPECT_EQ(relief_outline(flood, kRadius_m).size(), 3U);
}

TEST(ReliefSaving, KeepsWhatAFileHasBesideReliefs) {
  const test_support::TempDir folder;
  const fs::path file = folder / "a.relief.toml";
  const std::string by_hand = "# mine\nversion = 1\n";
  base::write_file(file, by_hand);
  const std::vector<ReliefSpec> reliefs{usual_relief(ReliefKind::kPad, {1, 2}, 100, 0)};
  EXPECT_EQ(save_reliefs(reliefs, file, false), kept_name(file));
  EXPECT_EQ(text_in(kept_name(file)), by_hand);
  EXPECT_TRUE(relief::read_relief_file(file) == reliefs);
  EXPECT_EQ(save_reliefs({}, file, false), std::nullopt);  // all of it was in the reliefs
  EXPECT_EQ(save_reliefs(reliefs, file, true), kept_name(file));
  base::write_file(file, std::string("no reliefs"));
  EXPECT_EQ(save_reliefs(reliefs, file, false), kept_name(file));
  EXPECT_EQ(text_in(kept_name(file)), "no reliefs");
  std::vector<ReliefSpec> bad = reliefs;
  bad[0].radius_m = -1;
  EXPECT_THROW(save_reliefs(bad, file, false), std::invalid_argument);
  EXPECT_TRUE(relief::read_relief_file(file) == reliefs);
  EXPECT_THROW(save_reliefs(reliefs, folder / "none/a.relief.toml", false), base::FileError);
}

TEST(ReliefFlight, ReliefsFormInIt) {
  ReliefSpec pad = usual_relief(ReliefKind::kPad, {10, 20}, 800, 0);
  pad.name = "landing pad";
  pad.strength = 0.75;
  const std::vector<ReliefSpec> reliefs{usual_relief(ReliefKind::kCrater, {10, 20}, 500, 0), pad,
                                        usual_relief(ReliefKind::kCrater, {11, 20}, 500, 0)};
  const scripts::Flight flight = with_forming(flight_at({10, 20, 5000, 30, -40, 0}, 45, 5), reliefs, 1, 6);
  EXPECT_EQ(flight.end_s, 6);
  EXPECT_EQ(flight.view.fov_deg, 45);
  const scripts::ParsedFlight again = scripts::parse_flight(scripts::to_text(flight), "again");
  ASSERT_TRUE(again.flight);
  EXPECT_EQ(*again.flight, flight);
  const scripts::GroundTracks tracks(flight, kRadius_m);
  EXPECT_TRUE(tracks.at(0.5).empty());
  EXPECT_TRUE(tracks.at(1).empty());  // of no strength
  const scripts::GroundState middle = tracks.at(3);
  ASSERT_EQ(middle.reliefs.size(), 3U);
  EXPECT_GT(middle.reliefs[1].strength, 0);
  EXPECT_LT(middle.reliefs[1].strength, 0.75);
  const scripts::GroundState end = tracks.at(6);
  ASSERT_EQ(end.reliefs.size(), 3U);
  EXPECT_EQ(end.reliefs[0].name, "Crater");
  EXPECT_EQ(end.reliefs[1].name, "landing pad");
  EXPECT_EQ(end.reliefs[2].name, "Crater 2");
  EXPECT_EQ(end.reliefs[1].strength, 0.75);
  EXPECT_EQ(end.reliefs[1].rise_m, pad.rise_m);
  // Into a flight that has a relief of the name already.
  const scripts::Flight more = with_forming(flight, {&reliefs[0], 1}, 0, 2);
  EXPECT_EQ(scripts::GroundTracks(more, kRadius_m).at(6).reliefs.size(), 4U);
  EXPECT_THROW(with_forming(flight, reliefs, 3, 3), std::invalid_argument);
  EXPECT_THROW(with_forming(flight, reliefs, -1, 3), std::invalid_argument);
  std::vector<ReliefSpec> bad = reliefs;
  bad[1].name = std::string(300, 'x');
  EXPECT_THROW(with_forming(flight_at({}, 60, 5), bad, 0, 3), std::runtime_error);
}

}  // namespace
}  // namespace vpe::explore
