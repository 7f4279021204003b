// Models of sticks from voxels: runs, kinds, sharing, coarser levels and their error.
#include "objects/sticks/build_sticks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "objects/sticks/halve_voxels.h"
#include "tests/objects/sticks/stick_shapes.h"

namespace objects {
namespace {

const Rgba kRed{200, 20, 20, 255};
const Rgba kBlue{20, 20, 200, 255};

TEST(BuildSticks, APlateHasOneStick) {
  VoxelGrid plate({64, 64, 2, 1, {0, 0, 0}});
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) plate.set(x, y, 1, stick_voxel(kRed, {0, 0, 1}));
  }
  const StickModel model = build_sticks(plate);
  const StickModel::Level& level = model.levels()[0];
  ASSERT_EQ(level.sticks.size(), 2U);
  EXPECT_EQ(level.sticks[1].kind, StickKind::kUniform);
  EXPECT_EQ(level.runs.size(), 1U);
  EXPECT_EQ(level.voxels.size(), 1U);
  EXPECT_TRUE(std::all_of(level.columns.begin(), level.columns.end(), [](std::uint32_t s) { return s == 1; }));
}

TEST(BuildSticks, KindsAreThoseOfThePaper) {
  VoxelGrid voxels({5, 1, 20, 1, {0, 0, 0}});
  voxels.set(1, 0, 3);
  for (int z = 2; z < 9; ++z) {
    const auto shade = static_cast<std::uint8_t>(z);
    voxels.set(2, 0, z, stick_voxel({shade, 0, 0, 255}, {0, 0, 1}));
  }
  voxels.set(3, 0, 1);
  voxels.set(3, 0, 12);
  voxels.set(4, 0, 5, stick_voxel({1, 2, 3, 99}, {0, 0, 1}));
  const StickModel model = build_sticks(voxels);
  const StickModel::Level& level = model.levels()[0];
  const auto kind = [&](std::size_t column) { return level.sticks[level.columns[column]].kind; };
  EXPECT_EQ(kind(0), StickKind::kEmpty);
  EXPECT_EQ(kind(1), StickKind::kUniform);
  EXPECT_EQ(kind(2), StickKind::kTextured);
  EXPECT_EQ(kind(3), StickKind::kComplex);
  EXPECT_EQ(kind(4), StickKind::kComplex);
  EXPECT_EQ(level.sticks[level.columns[2]].runs, 1);
}

TEST(BuildSticks, InsidesTakeTheNearestColourAndMakeLongRuns) {
  VoxelGrid voxels({1, 1, 200, 1, {0, 0, 0}});
  for (int z = 10; z < 190; ++z) voxels.set(0, 0, z);
  voxels.set(0, 0, 10, stick_voxel(kRed, {0, 0, -1}));
  voxels.set(0, 0, 189, stick_voxel(kBlue, {0, 0, 1}));
  const StickModel model = build_sticks(voxels);
  const StickModel::Level& level = model.levels()[0];
  ASSERT_EQ(level.sticks.size(), 2U);
  EXPECT_EQ(level.sticks[1].kind, StickKind::kTextured);
  ASSERT_EQ(level.runs.size(), 2U);
  EXPECT_EQ(level.runs[0].length, 90);
  EXPECT_EQ(level.runs[1].length, 90);
  EXPECT_EQ(level.voxels.size(), 2U);
  StickHits hits;
  for (const float z : {99.5F, 100.5F}) {
    model.cast({{-5, 0.5F, z}, {1, 0, 0}}, 0, 100, hits);
    ASSERT_TRUE(hits.has_front);
    EXPECT_EQ(hits.front.voxel.colour, z < 100 ? kRed : kBlue);
  }
}

TEST(BuildSticks, HiddenColoursAreLost) {
  VoxelGrid voxels({9, 9, 9, 1, {0, 0, 0}});
  std::mt19937 random(3);
  for (int n = 0; n < 729; ++n)
    voxels.set(n % 9, n / 9 % 9, n / 81,
               stick_voxel({static_cast<std::uint8_t>(random() % 256), 0, 0, 255}, {}));
  voxels.tidy();
  drop_hidden_colours(voxels);
  EXPECT_EQ(voxels.coloured().size(), 729U - 343U);
}

TEST(BuildSticks, TheSameVoxelsGiveTheSameModel) {
  const auto make = [] {
    std::mt19937 random(5);
    VoxelGrid voxels({40, 30, 70, 0.1F, {1, 2, 3}});
    for (int n = 0; n < 9000; ++n) {
      const auto shade = static_cast<std::uint8_t>(random() % 4 * 60);
      const auto alpha = static_cast<std::uint8_t>(random() % 3 == 0 ? 100 : 255);
      voxels.set(static_cast<int>(random() % 40), static_cast<int>(random() % 30),
                 static_cast<int>(random() % 70), stick_voxel({shade, 0, 9, alpha}, {0, 1, 0}));
    }
    return build_sticks(voxels);
  };
  const StickModel a = make();
  EXPECT_EQ(a.levels(), make().levels());
  EXPECT_EQ(a.levels().size(), 6U);  // 70, 35, 18, 9, 5, 3
  for (const StickModel::Level& level : a.levels()) {
    EXPECT_EQ(check(level), "");
    for (std::size_t n = 1; n < level.sticks.size(); ++n) {
      for (std::size_t m = 1; m < n; ++m) {
        if (level.sticks[n].runs != level.sticks[m].runs) continue;
        EXPECT_FALSE(std::equal(level.runs.begin() + level.sticks[n].first_run,
                                level.runs.begin() + level.sticks[n].first_run + level.sticks[n].runs,
                                level.runs.begin() + level.sticks[m].first_run));
      }
    }
  }
}

TEST(BuildSticks, HalfFullVoxelsAreOpaqueAndEmptierOnesLetLightThrough) {
  VoxelGrid fine({8, 2, 2, 1, {0, 0, 0}});
  for (int n = 0; n < 8; ++n) fine.set(n % 2, n / 2 % 2, n / 4, stick_voxel({200, 0, 100, 255}, {0, 0, 1}));
  for (int n = 0; n < 4; ++n) fine.set(4 + n % 2, n / 2 % 2, 0, stick_voxel({0, 100, 0, 255}, {1, 0, 0}));
  fine.tidy();
  VoxelGrid coarse = halved_voxels(fine);
  ASSERT_EQ(coarse.coloured().size(), 2U);
  EXPECT_EQ(coarse.coloured()[0].voxel.colour, (Rgba{200, 0, 100, 255}));
  EXPECT_EQ(coarse.coloured()[1].voxel.colour, (Rgba{0, 100, 0, 255}));
  EXPECT_EQ(coarse.coloured()[1].voxel.normal[0], 127);

  VoxelGrid rod({2, 2, 8, 1, {0, 0, 0}});
  for (int z = 0; z < 8; ++z) rod.set(0, 0, z, stick_voxel(kRed, {1, 0, 0}));
  rod.tidy();
  coarse = halved_voxels(rod);
  ASSERT_EQ(coarse.coloured().size(), 4U);
  EXPECT_EQ(coarse.coloured()[0].voxel.colour.a, std::lround(255.0 * 5 / 12));  // 1 of 4, 2 of 4, 2 of 4 rays
}

TEST(BuildSticks, AFullSemiTransparentVoxelKeepsItsExtinction) {
  VoxelGrid fine({4, 4, 4, 1, {0, 0, 0}});
  for (int n = 0; n < 64; ++n) fine.set(n % 4, n / 4 % 4, n / 16, stick_voxel({9, 9, 9, 51}, {0, 0, 1}));
  fine.tidy();
  const VoxelGrid coarse = halved_voxels(fine);
  ASSERT_EQ(coarse.coloured().size(), 8U);
  EXPECT_EQ(coarse.coloured()[0].voxel.colour.a, std::lround(255 * (1 - 0.8 * 0.8)));
}

TEST(BuildSticks, CavitiesNarrowerThanTwoVoxelsAreFilled) {
  VoxelGrid voxels({8, 8, 32, 1, {0, 0, 0}});
  for (int n = 0; n < 64; ++n) {
    for (int z = 0; z < 32; ++z) {
      if (z != 8 && z != 9 && !(z >= 16 && z < 20)) voxels.set(n % 8, n / 8, z);
    }
  }
  const StickModel model = build_sticks(voxels);
  const auto runs = [&](std::size_t level) {
    const StickModel::Level& l = model.levels()[level];
    return l.sticks[l.columns[0]].runs;
  };
  EXPECT_EQ(runs(0), 3);
  EXPECT_EQ(runs(1), 2);  // the lower one is one voxel high there
  EXPECT_EQ(runs(2), 1);
}

// The largest distance from voxels of one level, sampled, to those of another.
double farthest_m(const StickModel::Level& from, const StickModel::Level& to, std::mt19937& random) {
  const auto to_edge_m = static_cast<double>(to.grid.voxel_m);
  std::vector<glm::dvec3> corners;
  for (int y = 0; y < to.grid.columns_y; ++y) {
    for (int x = 0; x < to.grid.columns_x; ++x) {
      for (int z = 0; z < to.grid.height; ++z) {
        if (stick_shapes::holds(to, {x, y, z}))
          corners.push_back(glm::dvec3(to.grid.corner_m) + to_edge_m * glm::dvec3(x, y, z));
      }
    }
  }
  std::uniform_real_distribution<double> any(0, 1);
  double farthest = 0;
  for (int y = 0; y < from.grid.columns_y; ++y) {
    for (int x = 0; x < from.grid.columns_x; ++x) {
      for (int z = 0; z < from.grid.height; ++z) {
        if (!stick_shapes::holds(from, {x, y, z})) continue;
        for (int corner = 0; corner < 10; ++corner) {
          const glm::dvec3 part = corner < 8 ? glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2)
                                             : glm::dvec3(any(random), any(random), any(random));
          const glm::dvec3 p = glm::dvec3(from.grid.corner_m) +
                               static_cast<double>(from.grid.voxel_m) * (glm::dvec3(x, y, z) + part);
          double nearest = 1e30;
          for (const glm::dvec3& c : corners) {
            const glm::dvec3 beside = glm::max(glm::max(c - p, p - c - to_edge_m), 0.0);
            nearest = std::min(nearest, glm::dot(beside, beside));
            if (nearest == 0) break;
          }
          farthest = std::max(farthest, std::sqrt(nearest));
        }
      }
    }
  }
  return farthest;
}

TEST(BuildSticks, TheStatedErrorHolds) {
  std::mt19937 random(9);
  for (int number = 0; number < 3; ++number) {
    VoxelGrid voxels({24, 20, 28, 0.5F, {-1, 3, 7}});
    for (int n = 0; n < 60; ++n)
      voxels.set(static_cast<int>(random() % 24), static_cast<int>(random() % 20),
                 static_cast<int>(random() % 28));
    for (int n = 0; n < 20; ++n) {
      voxels.set(static_cast<int>(random() % 24), static_cast<int>(random() % 20),
                 static_cast<int>(random() % 28), stick_voxel({1, 2, 3, 90}, {0, 0, 1}));
    }
    for (int n = 0; number > 0 && n < 900; ++n) {
      const glm::ivec3 at(4 + n % 10, 5 + n / 10 % 9, 6 + n / 90);
      if (number == 1 || random() % 3 != 0) voxels.set(at.x, at.y, at.z);
    }
    const StickModel model = build_sticks(voxels);
    ASSERT_GE(model.levels().size(), 4U);
    EXPECT_EQ(stick_error_m(model, 0), 0);
    for (std::size_t level = 1; level < model.levels().size(); ++level) {
      const double bound = stick_error_m(model, level);
      EXPECT_LE(farthest_m(model.levels()[level], model.levels()[0], random), bound + 1e-5) << level;
      EXPECT_LE(farthest_m(model.levels()[0], model.levels()[level], random), bound + 1e-5) << level;
    }
  }
}

TEST(BuildSticks, CoarseSolidsKeepAHardSurfaceAndTheirVolume) {
  const StickModel model = build_sticks(stick_shapes::fill(
      {64, 64, 64, 1, {-32, -32, -32}}, [](const glm::dvec3& p) { return glm::length(p) - 28.3; }));
  for (std::size_t level = 0; level < 4; ++level) {
    const StickModel::Level& l = model.levels()[level];
    const double volume =
        static_cast<double>(stick_shapes::count_voxels(l)) * std::pow(8.0, static_cast<double>(level));
    EXPECT_NEAR(volume, 4.0 / 3.0 * 3.14159265 * 28.3 * 28.3 * 28.3, 0.06 * volume) << level;
    EXPECT_TRUE(std::all_of(l.runs.begin(), l.runs.end(), [](const auto& run) { return run.is_opaque; }))
        << level;
  }
}

TEST(BuildSticks, RefusesGridsBeyondTheLimits) {
  EXPECT_THROW(VoxelGrid({0, 1, 1, 1, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(VoxelGrid({1, 1, 5000, 1, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(VoxelGrid({4096, 4096, 4096, 1, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(VoxelGrid({1, 1, 1, 0, {0, 0, 0}}), std::invalid_argument);
  EXPECT_TRUE(build_sticks(VoxelGrid()).levels().empty());
}

}  // namespace
}  // namespace objects
