// Where bricks lie, what is solid in them, and how long they are kept.
#include "vpe/voxel/volume/brick_plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "tests/support/support.h"
#include "vpe/voxel/volume/brick_store.h"
#include "vpe/voxel/volume/terrain_volume.h"

namespace vpe::voxel {
namespace {

using test_support::Random;

constexpr double kRadius_m = 3.4e6;

core::GroundPart part_at(const glm::dvec3& up, double radius_m, double voxel_m,
                         const std::string& name = "it") {
  core::GroundPart part;
  part.name = name;
  part.centre_m = (kRadius_m + 100) * glm::normalize(up);
  part.radius_m = radius_m;
  part.voxel_m = voxel_m;
  part.solids = [](const glm::dvec3&, std::vector<core::SolidSpan>&) {};
  return part;
}

bool is_over(const BrickPlan& plan, const glm::dvec3& place_m, double margin = 0) {
  if (!(glm::dot(place_m, mars::face_axes(plan.face).out) > 0)) return false;
  const mars::ChartPoint at = mars::chart_on(plan.face, place_m);
  const double x = (at.u - plan.frame.u0) / plan.frame.du;
  const double y = (at.v - plan.frame.v0) / plan.frame.dv;
  return std::min({x, y, plan.frame.intervals - x, plan.frame.intervals - y}) >= margin;
}

TEST(BrickPlan, HoldsEveryBallWithItsMarginOnAllFaces) {
  Random random(41);
  for (int n = 0; n < 300; ++n) {
    // Also over the edges and corners of faces.
    glm::dvec3 up = random.direction();
    if (n % 3 == 0) up = glm::normalize(glm::dvec3(1, n % 2 == 0 ? 1 : 0.3, n % 4 == 1 ? 1 : -0.7));
    const double radius_m = random.log_uniform(1, 30000);
    const core::GroundPart part = part_at(up, radius_m, radius_m / random.uniform(10, 200));
    const std::vector<BrickPlan> plans = plan_bricks({&part, 1}, kRadius_m);
    ASSERT_EQ(plans.size(), 1U);
    EXPECT_EQ(plans[0].parts, std::vector<std::size_t>{0});
    for (int k = 0; k < 50; ++k) {
      const glm::dvec3 place_m = part.centre_m + part.radius_m * random.direction();
      ASSERT_TRUE(is_over(plans[0], place_m, kBrickMargin - 1e-6));
    }
    // Voxels have about the size that is asked for, and the brick is no larger than it need be.
    const double side_m = 2 * radius_m / part.voxel_m * std::sqrt(3.0) + 2 * kBrickMargin + 2;
    EXPECT_LT(plans[0].frame.intervals, side_m);
  }
}

TEST(BrickPlan, PartsThatTouchShareABrick) {
  Random random(42);
  int shared = 0;
  for (int n = 0; n < 200; ++n) {
    std::vector<core::GroundPart> parts;
    const glm::dvec3 middle =
        n % 2 == 0 ? random.direction() : glm::normalize(glm::dvec3(1, 1, random.uniform(-1, 1)));
    const int count = random.integer(1, 12);
    for (int k = 0; k < count; ++k) {
      const glm::dvec3 up = glm::normalize(middle + random.log_uniform(1e-6, 1e-3) * random.direction());
      parts.push_back(part_at(up, random.uniform(5, 200), random.uniform(1, 4), std::to_string(k)));
    }
    const std::vector<BrickPlan> plans = plan_bricks(parts, kRadius_m);
    std::vector<std::size_t> seen;
    for (const BrickPlan& plan : plans) {
      seen.insert(seen.end(), plan.parts.begin(), plan.parts.end());
      shared += plan.parts.size() > 1;
      double finest_m = std::numeric_limits<double>::infinity();
      for (const std::size_t k : plan.parts) {
        finest_m = std::min(finest_m, parts[k].voxel_m);
        for (int m = 0; m < 8; ++m)
          EXPECT_TRUE(
              is_over(plan, parts[k].centre_m + parts[k].radius_m * random.direction(), kBrickMargin - 1e-6));
      }
      const double u = plan.frame.u0 + 0.5 * plan.frame.intervals * plan.frame.du;
      const double v = plan.frame.v0 + 0.5 * plan.frame.intervals * plan.frame.dv;
      EXPECT_NEAR(plan.frame.du * kRadius_m / std::pow(1 + u * u + v * v, 0.75), finest_m, 1e-6 * finest_m);
      EXPECT_TRUE(std::ranges::is_sorted(plan.parts));
    }
    // Every part is in one brick, and no place is in two.
    std::ranges::sort(seen);
    ASSERT_EQ(seen.size(), parts.size());
    for (std::size_t k = 0; k < seen.size(); ++k) EXPECT_EQ(seen[k], k);
    for (const BrickPlan& plan : plans) {
      for (int k = 0; k < 40; ++k) {
        const double x = random.uniform(0, plan.frame.intervals);
        const double y = random.uniform(0, plan.frame.intervals);
        const glm::dvec3 place =
            mars::cube_point(plan.face, plan.frame.u0 + x * plan.frame.du, plan.frame.v0 + y * plan.frame.dv);
        EXPECT_EQ(std::ranges::count_if(plans, [&](const BrickPlan& p) { return is_over(p, place, 1e-9); }),
                  is_over(plan, place, 1e-9) ? 1 : 0);
      }
    }
  }
  EXPECT_GT(shared, 50);
}

TEST(BrickPlan, SaysWhichPartsAreTooLargeForTheirVoxels) {
  const core::GroundPart parts[] = {part_at({1, 0, 0}, 3000, 100, "wide"),
                                    part_at({1, 1e-5, 0}, 2, 0.01, "fine")};
  try {
    plan_bricks(parts, kRadius_m);
    FAIL();
  } catch (const std::runtime_error& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("\"wide\", \"fine\""), std::string::npos) << text;
    EXPECT_NE(text.find("voxel_m"), std::string::npos) << text;
  }
  EXPECT_EQ(plan_bricks({parts, 1}, kRadius_m).size(), 1U);
  EXPECT_EQ(plan_bricks({parts + 1, 1}, kRadius_m).size(), 1U);
}

TEST(BrickPlan, RefusesNumbersWithoutSense) {
  const auto refuses = [](auto change) {
    core::GroundPart part = part_at({0, 1, 0}, 10, 1);
    change(part);
    EXPECT_THROW(plan_bricks({&part, 1}, kRadius_m), std::invalid_argument);
  };
  refuses([](core::GroundPart& p) { p.radius_m = 0; });
  refuses([](core::GroundPart& p) { p.radius_m = NAN; });
  refuses([](core::GroundPart& p) { p.radius_m = 0.3 * kRadius_m; });
  refuses([](core::GroundPart& p) { p.voxel_m = 0; });
  refuses([](core::GroundPart& p) { p.voxel_m = -NAN; });
  refuses([](core::GroundPart& p) { p.centre_m = glm::dvec3(0); });
  refuses([](core::GroundPart& p) { p.centre_m.z = INFINITY; });
  refuses([](core::GroundPart& p) { p.solids = {}; });
  const std::vector<core::GroundPart> many(kMostGroundParts + 1, part_at({0, 1, 0}, 10, 1));
  EXPECT_THROW(plan_bricks(many, kRadius_m), std::invalid_argument);
  EXPECT_TRUE(plan_bricks({}, kRadius_m).empty());
}

// Compares with the same operations on a row of cells.
TEST(BrickPlan, CutsAsCellsAreCut) {
  Random random(43);
  for (int n = 0; n < 500; ++n) {
    const auto spans = [&](int most) {
      std::vector<core::SolidSpan> out;
      for (int k = random.integer(0, most); k > 0; --k) {
        const int low = random.integer(0, 40);
        out.push_back({static_cast<double>(low), static_cast<double>(low + random.integer(1, 12))});
      }
      return out;
    };
    std::vector<core::SolidSpan> solids;
    for (int at = random.integer(0, 5); at < 50;) {
      const int end = at + random.integer(1, 10);
      solids.push_back({static_cast<double>(at), static_cast<double>(end)});
      at = end + random.integer(1, 8);
    }
    const std::vector<core::SolidSpan> cut = spans(5);
    const auto holds = [](const std::vector<core::SolidSpan>& all, double z) {
      return std::ranges::any_of(all, [&](const core::SolidSpan& s) { return z > s.low_m && z < s.high_m; });
    };
    std::vector<core::SolidSpan> left = solids;
    cut_out_of(left, cut);
    for (double z = -0.5; z < 70; z += 1) EXPECT_EQ(holds(left, z), holds(solids, z) && !holds(cut, z)) << z;
    for (std::size_t k = 0; k < left.size(); ++k) {
      EXPECT_LT(left[k].low_m, left[k].high_m);
      if (k > 0) {
        EXPECT_LE(left[k - 1].high_m, left[k].low_m);
      }
    }
  }
}

TEST(BrickPlan, WhatIsAddedStaysWhereSomethingIsCut) {
  std::vector<core::GroundPart> parts{part_at({1, 0, 0}, 50, 1), part_at({1, 0, 0}, 50, 1)};
  parts[0].is_cut = true;
  parts[0].solids = [](const glm::dvec3&, std::vector<core::SolidSpan>& s) { s.push_back({-30, 20}); };
  parts[1].solids = [](const glm::dvec3&, std::vector<core::SolidSpan>& s) { s.push_back({-10, -5}); };
  const std::vector<BrickPlan> plans = plan_bricks(parts, kRadius_m);
  ASSERT_EQ(plans.size(), 1U);
  std::vector<core::SolidSpan> solids;
  solids_of(parts, plans[0], [](const glm::dvec3&) { return 7.0; })({1, 0, 0}, solids);
  ASSERT_EQ(solids.size(), 2U);
  EXPECT_LT(solids[0].low_m, -30);
  EXPECT_EQ(solids[0].high_m, -30);
  EXPECT_EQ(solids[1].low_m, -10);
  EXPECT_EQ(solids[1].high_m, -5);
}

TEST(BrickStore, MakesBricksOnceAndForgetsOldOnes) {
  BrickStore store;
  const auto ground = [](const glm::dvec3&) { return 0.0; };
  const auto parts = std::make_shared<const core::GroundParts>(core::GroundParts{part_at({1, 0, 0}, 2, 1)});
  const BandSpec band;
  EXPECT_TRUE(store.get(nullptr, 1, band, kRadius_m, ground).empty());
  EXPECT_TRUE(store.get(std::make_shared<const core::GroundParts>(), 1, band, kRadius_m, ground).empty());
  const BrickStore::Bricks first = store.get(parts, 1, band, kRadius_m, ground);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_GT(store.bytes_resident(), 0U);
  EXPECT_EQ(store.get(parts, 1, band, kRadius_m, ground), first);
  // Another exaggeration or filter is other ground.
  EXPECT_NE(store.get(parts, 2, band, kRadius_m, ground), first);
  EXPECT_EQ(store.get(parts, 1, band, kRadius_m, ground), first);
  EXPECT_NE(store.get(parts, 1, {.filter = VolumeFilter::kBox}, kRadius_m, ground), first);
  store.clear();
  EXPECT_EQ(store.bytes_resident(), 0U);
  EXPECT_NE(store.get(parts, 1, band, kRadius_m, ground), first);
}

}  // namespace
}  // namespace vpe::voxel
