// Tests tiles that are cast with their parent's posts: the posts, and which tiles of an image they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "tests/paging/planet_fixture.h"
#include "tests/support/support.h"
#include "vpe/core/metrics.h"
#include "vpe/voxel/cast/range_caster.h"

namespace {

using test_support::FakeElevation;
using vpe::voxel::CellRule;
using vpe::voxel::ColumnWalk;
using vpe::voxel::HeightGridLines;
using vpe::voxel::HeightGridStore;
using vpe::voxel::LineFamily;
using vpe::voxel::RangeCaster;
using vpe::voxel::RangeOptions;
using vpe::voxel::TileHeightGrids;
using Tile = lod::TileTree::Index;

constexpr LineFamily kFamilies[] = {LineFamily::kColumns, LineFamily::kRows, LineFamily::kDiagonals};

vpe::core::SurfaceRadius radius_of(const paging::Surface& surface) {
  return [&](std::span<const glm::dvec3> at, std::span<double> radius_m) {
    for (std::size_t k = 0; k < at.size(); ++k) radius_m[k] = surface.at(at[k]).radius_m;
  };
}

constexpr mars::LonLat kPlace{20, 10};

// Returns a height with waves of some kilometres.
double wavy_height(const glm::dvec3& d) {
  return test_support::bumpy_height(d) + 300 * std::sin(2500 * d.x) * std::sin(2500 * d.y + 1500 * d.z);
}

class QuarterTiles : public ::testing::Test {
 protected:
  void SetUp() override {
    paging::BuildOptions options;
    options.output = (dir_ / "p.vpe").string();
    options.tile_k = 7;
    options.base_spacing_m = 90000;
    options.threads = 2;
    options.resampling_posts = 5000;
    const FakeElevation ground(wavy_height, test_support::fine_around(mars::direction(kPlace), 0.02, 1000));
    paging::build_planet(options, ground, nullptr);
    planet_ = paging::PlanetFile::open(options.output);
    ASSERT_GE(planet_->meta().finest_level, 6);
  }
  const lod::TileTree& tree() const { return planet_->tree(); }
  Tile parent(Tile tile) const {
    return static_cast<Tile>(tree().find(lod::parent(tree()[tile].key)) - tree().tiles().data());
  }
  // Returns a narrow view of the fine ground.
  vpe::core::View view(double height_m, double pitch_deg) const {
    vpe::core::View view;
    view.camera =
        mars::to_camera({kPlace.lon_deg, kPlace.lat_deg, height_m, 40, pitch_deg, 0}, planet_->radius_m());
    view.width = 160;
    view.height = 120;
    view.fov_deg = 10;
    return view;
  }
  // Calls visit(view, cell_px) for views in which some tiles are fine enough and some are not.
  template <typename Visit>
  void for_views(const Visit& visit) const {
    for (int n = 0; n < 12; ++n) visit(view(9e4 + 1.5e4 * n, -80 + 3 * n), 0.25 * std::exp2(0.25 * n));
  }

  test_support::TempDir dir_;
  std::shared_ptr<const paging::PlanetFile> planet_;
};

// Returns the inverse depth at post (i, j) of a tile, counted over all its grids.
template <typename T>
double inverse_depth_at(const TileHeightGrids<T>& grids, int i, int j, double radius_m) {
  const int n = grids.lines(0, 0).side - 1;
  const int column = std::min(i / n, grids.per_side() - 1);
  const int row = std::min(j / n, grids.per_side() - 1);
  const HeightGridLines<T>& grid = grids.lines(column, row);
  const int x = i - column * n;
  const int y = j - row * n;
  return grid.reference.w0 + grid.reference.wx * x + grid.reference.wy * y -
         static_cast<double>(vpe::voxel::post_height(grid, grids.family(), x, y)) / (radius_m * radius_m);
}

TEST_F(QuarterTiles, HalfGridsHoldTheParentsPosts) {
  const HeightGridStore store(planet_, std::size_t{1} << 27);
  const double radius_m = planet_->radius_m();
  const int half = tree().shape().intervals() / 2;
  int compared = 0;
  for (Tile tile = 6; tile < tree().size(); tile += 5) {
    const lod::TileKey& key = tree()[tile].key;
    const int per_side = vpe::voxel::grids_per_side(key.level, 2 * half);
    if (2 * half / per_side < 2) continue;
    for (const double exaggeration : {1.0, 4.0}) {
      const auto own = store.any_grids(parent(tile), exaggeration);
      for (const LineFamily family : kFamilies) {
        const auto grids = store.half_grids(tile, parent(tile), family, exaggeration);
        const auto exact = store.exact_half_grids(tile, parent(tile), family, exaggeration);
        ASSERT_EQ(grids->family(), family);
        ASSERT_EQ(grids->per_side(), per_side);
        ASSERT_EQ(grids->lines(0, 0).side, half / per_side + 1);
        for (int j = 0; j <= half; j += 3) {
          for (int i = 0; i <= half; i += 3, ++compared) {
            const double wanted =
                inverse_depth_at(*own, (key.i & 1) * half + i, (key.j & 1) * half + j, radius_m);
            // A float of some kilometres.
            EXPECT_NEAR(inverse_depth_at(*grids, i, j, radius_m) / wanted, 1, 0.01 / radius_m);
            EXPECT_NEAR(inverse_depth_at(*exact, i, j, radius_m) / wanted, 1, 0.01 / radius_m);
          }
        }
      }
    }
  }
  EXPECT_GT(compared, 1000);
}

// A tile whose parent's posts are cast is as near to the surface in the image as one that is fine enough by itself, and
// the parent as a whole would not be.
TEST_F(QuarterTiles, AreFineEnoughWhereTheirParentIsNot) {
  const paging::Surface surface(planet_, std::size_t{1} << 26);
  int quarters = 0;
  for_views([&](const vpe::core::View& v, double cell_px) {
    const double distance_m = glm::length(v.camera.position_m);
    const glm::dvec3 up = v.camera.position_m / distance_m;
    const double focal_px = vpe::core::focal_px(v);
    const ColumnWalk walk(surface, {up, distance_m, planet_->radius_m(), surface.at(up).radius_m}, 1,
                          CellRule{cell_px, focal_px});
    for (Tile tile = 6; tile < tree().size(); ++tile) {
      if (walk.ends_at(parent(tile)) || !walk.ends_at(tile) || !walk.has_parents_posts(tile)) continue;
      ++quarters;
      EXPECT_EQ(walk.intervals(tile), tree().shape().intervals() / 2);
      const double geometric_error_m = tree()[parent(tile)].posts_terms.terms().total_m;
      EXPECT_LE(geometric_error_m * focal_px, cell_px * walk.least_distance_m(tile));
      EXPECT_GT(geometric_error_m * focal_px, cell_px * walk.least_distance_m(parent(tile)));
    }
  });
  EXPECT_GT(quarters, 20);
}

// The usage names the parent once for all its quarters, with the distance of the nearest of them.
TEST_F(QuarterTiles, CountForTheTileWhosePostsTheyAre) {
  RangeCaster caster(planet_, std::size_t{1} << 27);
  vpe::base::ThreadPool pool(2);
  int in_part = 0;
  for_views([&](const vpe::core::View& v, double cell_px) {
    std::vector<float> range_m(static_cast<std::size_t>(v.width * v.height));
    RangeOptions options;
    options.cell_px = cell_px;
    const auto usage = caster.cast(v, options, pool, range_m);
    EXPECT_LE(usage.screen_space_error_px, cell_px * (1 + 1e-9));
    std::set<Tile> cast;
    for (const vpe::voxel::TileUse& use : usage.tiles) {
      EXPECT_TRUE(cast.insert(use.tile).second);
      EXPECT_EQ(use.source, use.tile);
    }
    for (const Tile tile : cast) in_part += tile >= 6 && cast.contains(parent(tile)) ? 1 : 0;
  });
  EXPECT_GT(in_part, 5);
}

// What is stated of quarters is true of the pixels, columns and their refinement both.
TEST_F(QuarterTiles, KeepTheirCertificate) {
  RangeCaster caster(planet_, std::size_t{1} << 27);
  const paging::Surface surface(planet_, std::size_t{1} << 26);
  vpe::base::ThreadPool pool(2);
  double farthest_px = 0;
  for_views([&](const vpe::core::View& v, double cell_px) {
    std::vector<float> exact_m(static_cast<std::size_t>(v.width * v.height));
    std::vector<float> range_m(exact_m.size());
    caster.cast(v, {}, pool, exact_m);
    RangeOptions options;
    options.cell_px = cell_px;
    const auto usage = caster.cast(v, options, pool, range_m);
    const auto errors = vpe::core::compare_to_reference(v, range_m, exact_m, radius_of(surface), {1, 1});
    EXPECT_LE(errors.forward.max_px, usage.screen_space_error_px + 0.01);
    farthest_px = std::max(farthest_px, errors.forward.max_px);
  });
  EXPECT_GT(farthest_px, 0.05);  // something was coarser
}

}  // namespace
