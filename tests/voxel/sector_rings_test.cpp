// Tests that lines near V are thinned by rings: fewer samples, and a line beside each pixel as before.
#include "vpe/voxel/columns/sector_rings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/pose.h"
#include "tests/support/support.h"
#include "vpe/voxel/columns/view_sector.h"

namespace {

namespace core = vpe::core;
using vpe::voxel::ring_ends;
using vpe::voxel::RingRow;
using vpe::voxel::SectorPlan;
using vpe::voxel::ViewSector;

// Returns rows of a full wedge between diagonals, from `farthest_px` away from V on.
std::vector<RingRow> wedge(int count, double farthest_px) {
  std::vector<RingRow> rows;
  for (int k = 0; k < count; ++k) rows.push_back({farthest_px - k, -1, 1});
  return rows;
}

// Returns the samples of rings, for lines one pixel apart on their first rows.
double samples(const std::vector<RingRow>& rows, const std::vector<int>& ends) {
  double sum = 0;
  std::size_t first = 0;
  for (const int end : ends) {
    for (std::size_t k = first; k < static_cast<std::size_t>(end); ++k)
      sum += rows[first].distance_px * (rows[k].high - rows[k].low);
    first = static_cast<std::size_t>(end);
  }
  return sum;
}

TEST(SectorRings, LeaveOutAQuarterOfTheSamplesOfAWedge) {
  const std::vector<RingRow> rows = wedge(540, 540);
  const std::vector<int> ends = ring_ends(rows, 4);
  EXPECT_GT(ends.size(), 1U);
  EXPECT_LE(ends.size(), 4U);
  EXPECT_EQ(ends.back(), 540);
  for (std::size_t n = 1; n < ends.size(); ++n) EXPECT_LT(ends[n - 1], ends[n]);
  EXPECT_LT(samples(rows, ends), 0.76 * samples(rows, {540}));
  EXPECT_EQ(ring_ends(rows, 1), std::vector<int>{540});
}

TEST(SectorRings, AreOneWhereVIsFar) {
  EXPECT_EQ(ring_ends(wedge(1080, 1e4), 4), std::vector<int>{1080});
  EXPECT_EQ(ring_ends(wedge(1, 1), 4), std::vector<int>{1});
  // Rows without pixels make none.
  std::vector<RingRow> rows = wedge(32, 32);
  for (RingRow& row : rows) std::swap(row.low, row.high);
  EXPECT_EQ(ring_ends(rows, 4), std::vector<int>{32});
}

TEST(SectorRings, FewRowsAreDividedWholly) {
  for (int count = 1; count < 40; ++count) {
    const std::vector<int> ends = ring_ends(wedge(count, count), 4);
    EXPECT_EQ(ends.back(), count);
    EXPECT_GT(ends.front(), 0);
    for (std::size_t n = 1; n < ends.size(); ++n) EXPECT_LT(ends[n - 1], ends[n]) << count;
  }
}

core::View view_at(double pitch_deg, double roll_deg) {
  core::View view;
  view.width = 640;
  view.height = 400;
  view.fov_deg = 50;
  view.camera = mars::to_camera({10, 20, 5000, 30, pitch_deg, roll_deg}, 3.4e6);
  return view;
}

// Every pixel is in the ring that has its step, between two of its lines, which are at most a spacing apart there; and the pixels
// that steps_alike() counts are in the same one.
TEST(SectorRings, EachPixelLiesBetweenTwoLinesOfItsOwn) {
  test_support::Random random(2040);
  int several = 0;
  for (int n = 0; n < 60; ++n) {
    const core::View view = view_at(n % 5 == 0 ? -90 : random.uniform(-90, -20), random.uniform(-180, 180));
    const glm::dvec3 up = glm::normalize(view.camera.position_m);
    const SectorPlan plan(view, up, 1);
    const SectorPlan one(view, up, 1, 1);
    EXPECT_LE(one.sectors().size(), 4U);
    several += plan.sectors().size() > one.sectors().size() ? 1 : 0;
    for (int y = 0; y < view.height; ++y) {
      for (int x = 0; x < view.width; ++x) {
        const SectorPlan::Side side = plan.side_of(x + 0.5, y + 0.5);
        const SectorPlan::Side coarse = one.side_of(x + 0.5, y + 0.5);
        ASSERT_EQ(side.upright, coarse.upright);
        ASSERT_EQ(side.forward, coarse.forward);
        ASSERT_EQ(coarse.ring, 0);
        const ViewSector* const sector = plan.sector_of(side);
        ASSERT_EQ(sector == nullptr, one.sector_of(coarse) == nullptr);
        if (sector == nullptr) continue;
        const int step = (side.upright ? y : x) - sector->first_step;
        if (step < 0 || step >= sector->steps) continue;  // next to V
        const ViewSector::Map& map = sector->maps[static_cast<std::size_t>(step)];
        EXPECT_GE(map.scale, 1.0 - 1e-12);
        const double line = map.scale * ((side.upright ? x : y) + 0.5) + map.shift - sector->first_line;
        ASSERT_GE(line, 0) << n << ", " << x << " " << y;
        ASSERT_LE(line, sector->lines - 1) << n << ", " << x << " " << y;
        if (side.upright) continue;
        const int alike = plan.steps_alike(side, x, view.width - x);
        ASSERT_GE(alike, 1);
        const auto is_same_side = [&](const SectorPlan::Side& other) {
          return !other.upright && other.forward == side.forward;
        };
        const SectorPlan::Side last = plan.side_of(x + alike - 0.5, y + 0.5);
        if (is_same_side(last)) {
          ASSERT_EQ(last.ring, side.ring);
        }
        const SectorPlan::Side next = plan.side_of(x + alike + 0.5, y + 0.5);
        if (x + alike < view.width && is_same_side(next)) {
          ASSERT_NE(next.ring, side.ring);
        }
      }
    }
  }
  EXPECT_GT(several, 30);
}

}  // namespace
