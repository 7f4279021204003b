#include "lod/select.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "cull/horizon.h"
#include "mars/geodesy/sphere.h"
#include "tests/lod/fake_tree.h"
#include "tests/support/support.h"

namespace {

using lod::Selection;
using lod::SelectOptions;
using lod::TileInfo;
using lod::TileKey;
using lod::TileTree;
using test_support::Random;
namespace core = vpe::core;

core::View view_at(double lon, double lat, double alt_m, double yaw, double pitch) {
  core::View view;
  view.camera = mars::to_camera(mars::Pose{lon, lat, alt_m, yaw, pitch, 0}, fake::kRadius_m);
  return view;
}

core::View panorama_at(double lon, double lat, double alt_m) {
  core::View view = view_at(lon, lat, alt_m, 0, 0);
  view.projection = core::Projection::kEquirectangular;
  return view;
}

Selection selected(const SelectOptions& options, const TileTree& tree, const core::View& view) {
  lod::SelectScratch scratch;
  Selection selection;
  lod::select(options, tree, lod::select_view(view), scratch, selection);
  return selection;
}

SelectOptions tolerance(double px) {
  SelectOptions options;
  options.tolerance_px = px;
  return options;
}

const TileTree& rough_tree() {
  static const TileTree tree = fake::tree(fake::rough(3, 9));
  return tree;
}

// Returns critical positions and attitudes, at heights from below the datum to ten radii.
core::View hostile_view(Random& random, double exaggeration) {
  double lon = random.uniform(-180, 180);
  double lat = std::asin(random.uniform(-1, 1)) / mars::kRadiansPerDegree;
  switch (random.integer(0, 6)) {
    case 0: lat = random.integer(0, 1) == 0 ? 90.0 : -90.0; break;
    case 1: lon = 180.0 - random.integer(0, 1) * 1e-9; break;
    case 2: lon = 45.0, lat = -35.264389682754654; break;
    case 3: lon = 0.0, lat = 0.0; break;
    default: break;
  }
  core::View view;
  const mars::LonLat place{lon, lat};
  const TileInfo& below =
      rough_tree().deepest(lod::tile_at(mars::chart_point(mars::direction(place)), lod::kMaxLevel));
  double alt = exaggeration * below.max_height_m;
  switch (random.integer(0, 3)) {
    case 0: alt += 0.5; break;
    case 1: alt = exaggeration * random.uniform(-8200, below.max_height_m); break;
    default: alt += random.log_uniform(1, 10 * fake::kRadius_m); break;
  }
  view.camera = mars::to_camera(
      mars::Pose{lon, lat, alt, random.uniform(-180, 180), random.uniform(-90, 60), random.uniform(-180, 180)},
      fake::kRadius_m);
  view.fov_deg = random.integer(0, 2) == 0 ? random.log_uniform(0.1, 170) : 60.0;
  if (random.integer(0, 5) == 0) view.projection = core::Projection::kEquirectangular;
  return view;
}

double projected(double geometric_error_m, double focal_px, double distance_m, double off_axis_magnification) {
  if (geometric_error_m == 0.0) return 0.0;
  return distance_m == 0.0 ? std::numeric_limits<double>::infinity()
                           : off_axis_magnification * (geometric_error_m * focal_px / distance_m);
}

void expect_sound(const Selection& s, const TileTree& tree, const SelectOptions& options,
                  const core::View& view) {
  const double focal = lod::select_view(view).focal_px;
  ASSERT_EQ(s.visited, s.culled_frustum + s.culled_horizon + s.refined + static_cast<int>(s.tiles.size()));
  std::int64_t end = -1;
  std::int64_t triangles = 0;
  double worst_m = 0;
  double worst_px = 0;
  std::vector<int> levels(lod::kMaxLevel + 1);
  for (const lod::SelectedTile& t : s.tiles) {
    ASSERT_GE(lod::morton_position(t.key), end) << "overlap at " << lod::to_string(t.key);
    end = lod::morton_position(t.key) + lod::morton_extent(t.key.level);
    ASSERT_EQ(tree[t.index].key, t.key);
    const lod::MeshVariant& mesh = tree[t.index].variants.at(static_cast<std::size_t>(t.variant));
    triangles += mesh.triangles;
    if (options.exaggeration == 1.0) {
      ASSERT_EQ(t.geometric_error_m, mesh.terms.total_m);
    }
    ASSERT_EQ(t.screen_space_error_px,
              projected(t.geometric_error_m, focal, t.min_distance_m, t.off_axis_magnification));
    worst_m = std::max(worst_m, t.geometric_error_m);
    worst_px = std::max(worst_px, t.screen_space_error_px);
    ++levels[static_cast<std::size_t>(t.key.level)];
  }
  ASSERT_EQ(s.triangles, triangles);
  ASSERT_EQ(s.max_geometric_error_m, worst_m);
  ASSERT_EQ(s.max_screen_space_error_px, worst_px);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    ASSERT_EQ(level < s.tiles_by_level.size() ? s.tiles_by_level[level] : 0, levels[level]);
  }
  if (!s.capped) {
    ASSERT_LE(s.max_screen_space_error_px, options.tolerance_px);
  }
}

struct Counts {
  int visited, horizon, frustum, refined, drawn;
  auto operator<=>(const Counts&) const = default;
};

Counts counts(const Selection& s) {
  return {s.visited, s.culled_horizon, s.culled_frustum, s.refined, static_cast<int>(s.tiles.size())};
}

std::ostream& operator<<(std::ostream& out, const Counts& c) {
  return out << "visited " << c.visited << " horizon " << c.horizon << " frustum " << c.frustum << " refined "
             << c.refined << " drawn " << c.drawn;
}

TEST(SelectCounts, FromTenRadiiFiveRootsAreSeen) {
  // Errors of 10 km of 1800 km tiles at 34 000 km are half a pixel. The sixth face is behind the planet.
  const TileTree ball = fake::tree(fake::uniform(5));
  const core::View down = view_at(0, 0, 10 * fake::kRadius_m, 0, -90);
  EXPECT_EQ(counts(selected(tolerance(1), ball, down)), (Counts{6, 1, 0, 0, 5}));
  const core::View away = view_at(0, 0, 10 * fake::kRadius_m, 0, 90);
  EXPECT_EQ(counts(selected(tolerance(0), ball, away)), (Counts{6, 1, 5, 0, 0}));
}

TEST(SelectCounts, HalfAMetreUpOverFourTilesCornersFourAreDrawn) {
  // The horizon is 1.8 km away, a finest tile 167 km wide; the camera stands over the middle of +X. Hidden:
  // five roots but the camera's, 12 of the 16 tiles at each of the levels 2 to 5.
  const TileTree ball = fake::tree(fake::uniform(5));
  const Selection s = selected(tolerance(1), ball, view_at(0, 0, 0.5, 90, -1));
  EXPECT_EQ(counts(s), (Counts{74, 5 + 4 * 12, 0, 17, 4}));
  EXPECT_EQ(s.tiles_by_level, (std::vector<int>{0, 0, 0, 0, 0, 4}));
  EXPECT_EQ(s.max_screen_space_error_px, 0.0);  // the camera is within the errors of the coarser meshes
}

TEST(SelectCounts, AtTheEastPoleOfThreeFacesThreeTilesAreDrawn) {
  // Half a metre over a cube corner: three tiles meet there.
  const TileTree ball = fake::tree(fake::uniform(5));
  const Selection s = selected(tolerance(1), ball, panorama_at(45, 35.264389682754654, 0.5));
  EXPECT_EQ(counts(s), (Counts{6 + 5 * 3 * 4, 3 + 5 * 9, 0, 15, 3}));
}

TEST(SelectCounts, APoleAndTheAntimeridianAreLikeThePlanetsFront) {
  // The middles of faces are equal up to a rotation of the cube.
  const TileTree ball = fake::tree(fake::uniform(5));
  for (const double alt : {0.5, 1e5, 3e6}) {
    const Counts front = counts(selected(tolerance(0.5), ball, panorama_at(0, 0, alt)));
    EXPECT_EQ(counts(selected(tolerance(0.5), ball, panorama_at(180, 0, alt))), front) << alt;
    EXPECT_EQ(counts(selected(tolerance(0.5), ball, panorama_at(0, 90, alt))), front) << alt;
    EXPECT_EQ(counts(selected(tolerance(0.5), ball, panorama_at(0, -90, alt))), front) << alt;
  }
}

TEST(SelectCounts, WithoutAFrustumAtToleranceZeroAllFinestTilesAboveTheHorizonAreDrawn) {
  const TileTree ball = fake::tree(fake::uniform(4));
  for (const double alt : {1e4, 1e6, 3e7}) {
    const core::View view = panorama_at(33, -12, alt);
    const Selection s = selected(tolerance(0), ball, view);
    // Computes angles to a dense border of each tile, in other arithmetic than the program's.
    const double limit = std::acos(ball.lowest_radius_m(1) / (fake::kRadius_m + alt)) +
                         std::acos(ball.lowest_radius_m(1) / fake::kRadius_m);
    int expected = 0;
    for (const TileInfo& tile : ball.tiles()) {
      if (tile.has_children) continue;
      const mars::ChartRect r = lod::chart_rect(tile.key);
      double nearest = lod::tile_at(mars::chart_point(view.camera.position_m), 4) == tile.key ? 0.0 : 4.0;
      for (int k = 0; k <= 400; ++k) {
        const double u = r.u0 + (r.u1 - r.u0) * k / 400.0;
        const double v = r.v0 + (r.v1 - r.v0) * k / 400.0;
        for (const auto& [x, y] : {std::pair{u, r.v0}, {u, r.v1}, {r.u0, v}, {r.u1, v}}) {
          nearest = std::min(
              nearest, mars::angle_between_rad(mars::chart_direction(r.face, x, y), view.camera.position_m));
        }
      }
      expected += nearest <= limit ? 1 : 0;
    }
    EXPECT_EQ(static_cast<int>(s.tiles.size()), expected) << alt;
    EXPECT_EQ(s.max_geometric_error_m, 0.0);
  }
}

TEST(Select, DrawsEveryVisiblePlaceExactlyOnce) {
  Random random(41);
  const TileTree& tree = rough_tree();
  lod::SelectScratch scratch;
  Selection s;
  int seen = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    SelectOptions options = tolerance(random.integer(0, 9) == 0 ? 0.0 : random.log_uniform(0.1, 100));
    options.exaggeration = random.integer(0, 2) == 0 ? random.log_uniform(0.1, 20) : 1.0;
    const core::View view = hostile_view(random, options.exaggeration);
    const glm::dvec3 camera = view.camera.position_m;
    lod::select(options, tree, lod::select_view(view), scratch, s);
    expect_sound(s, tree, options, view);
    if (HasFatalFailure()) return;
    const double lowest = tree.lowest_radius_m(options.exaggeration);
    for (int sample = 0; sample < 40; ++sample) {
      // Anywhere, or where a pixel's ray meets a sphere within the terrain.
      glm::dvec3 point = random.direction();
      if (sample % 4 != 0) {
        const double x = random.uniform(0, view.width);
        const glm::dvec3 ray = core::pixel_ray(view, x, random.uniform(0, view.height));
        const double r = fake::kRadius_m + options.exaggeration * random.uniform(-8000, 8000);
        const double b = glm::dot(ray, camera);
        const double root = b * b - glm::dot(camera, camera) + r * r;
        if (root < 0) continue;
        const double t = -b - std::sqrt(root) > 0 ? -b - std::sqrt(root) : -b + std::sqrt(root);
        if (t <= 0) continue;
        point = camera + t * ray;
      }
      const TileKey key = lod::tile_at(mars::chart_point(point), lod::kMaxLevel);
      const TileInfo& finest = tree.deepest(key);
      const double low = fake::kRadius_m + options.exaggeration * finest.min_height_m;
      const double high = fake::kRadius_m + options.exaggeration * finest.max_height_m;
      point = glm::normalize(point) * std::clamp(glm::length(point), low, high);
      const glm::dvec3 step = point - camera;
      const double t = std::clamp(-glm::dot(camera, step) / glm::dot(step, step), 0.0, 1.0);
      if (glm::length(camera + t * step) < lowest + 1e-6) continue;
      if (view.projection == core::Projection::kPerspective) {
        const core::Projected p = core::project(view, point);
        if (p.behind || p.xy.x < 0 || p.xy.x > view.width || p.xy.y < 0 || p.xy.y > view.height) continue;
      }
      ++seen;
      int holders = 0;
      for (const lod::SelectedTile& tile : s.tiles) {
        if (!lod::contains(tile.key, key)) continue;
        ++holders;
        ASSERT_LE(tile.min_distance_m, glm::length(step) + 1e-8);
        ASSERT_GE(tile.screen_space_error_px * (1 + 1e-12),
                  tile.geometric_error_m == 0
                      ? 0
                      : tile.geometric_error_m * lod::select_view(view).focal_px / glm::length(step));
      }
      ASSERT_EQ(holders, 1) << "trial " << trial << " " << lod::to_string(key);
    }
  }
  EXPECT_GT(seen, 10000);
}

// The number of triangles may fall: not all children of a tile need be visible.
TEST(Select, FinerToleranceOnlyRefines) {
  Random random(42);
  for (int trial = 0; trial < 200; ++trial) {
    const core::View view = hostile_view(random, 1.0);
    Selection coarser = selected(tolerance(std::numeric_limits<double>::infinity()), rough_tree(), view);
    EXPECT_EQ(coarser.refined, 0);
    for (const double px : {1e9, 30.0, 10.0, 3.0, 1.0, 0.3, 0.1, 0.0}) {
      const Selection finer = selected(tolerance(px), rough_tree(), view);
      ASSERT_GE(finer.visited, coarser.visited) << px;
      ASSERT_LE(finer.max_screen_space_error_px, px);
      std::int64_t least = 0;  // triangles of the coarser tiles that something is left of
      auto outer = coarser.tiles.begin();
      const lod::SelectedTile* counted = nullptr;
      for (const lod::SelectedTile& tile : finer.tiles) {
        while (outer != coarser.tiles.end() && !lod::contains(outer->key, tile.key)) ++outer;
        ASSERT_NE(outer, coarser.tiles.end()) << lod::to_string(tile.key);
        ASSERT_LE(tile.geometric_error_m, outer->geometric_error_m);
        if (outer->key == tile.key) {
          ASSERT_GE(tile.variant, outer->variant);
        }
        if (counted != &*outer) {
          counted = &*outer;
          least += rough_tree()[outer->index].variants[static_cast<std::size_t>(outer->variant)].triangles;
        }
      }
      ASSERT_GE(finer.triangles, least) << px;
      coarser = finer;
    }
  }
}

// Errors may shrink by less than a factor of two from level to level: then twice the tolerance is more than a level.
TEST(Select, WithAToleranceOfChildrenNoTileIsMoreThanALevelCoarser) {
  Random random(97);
  int coarser = 0;
  int two_levels = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const double px = random.log_uniform(0.1, 8);
    const double factor = random.uniform(1, 6);
    const core::View view = hostile_view(random, 1);
    const Selection fine = selected(tolerance(px), rough_tree(), view);
    SelectOptions options = tolerance(factor * px);
    const Selection free = selected(options, rough_tree(), view);
    options.child_tolerance_px = px;
    const Selection coarse = selected(options, rough_tree(), view);
    const auto levels_above = [](const Selection& from, const TileKey& tile) {
      for (const lod::SelectedTile& t : from.tiles)
        if (lod::contains(t.key, tile)) return tile.level - t.key.level;
      return -1;
    };
    for (const lod::SelectedTile& t : fine.tiles) {
      const int above = levels_above(coarse, t.key);
      ASSERT_GE(above, 0) << lod::to_string(t.key);
      ASSERT_LE(above, 1) << lod::to_string(t.key);
      coarser += above;
      two_levels += levels_above(free, t.key) > 1 ? 1 : 0;
    }
    for (const lod::SelectedTile& t : coarse.tiles) {
      if (!rough_tree()[t.index].has_children) continue;
      ASSERT_LE(t.screen_space_error_px, factor * px);
    }
  }
  EXPECT_GT(coarser, 300);
  EXPECT_GT(two_levels, 100);
}

TEST(Select, AtToleranceZeroNothingHasAnError) {
  Random random(43);
  for (int trial = 0; trial < 200; ++trial) {
    for (const lod::SelectedTile& tile :
         selected(tolerance(0), rough_tree(), hostile_view(random, 1.0)).tiles) {
      ASSERT_EQ(tile.geometric_error_m, 0.0);
      ASSERT_FALSE(rough_tree()[tile.index].has_children);
      ASSERT_EQ(static_cast<std::size_t>(tile.variant) + 1, rough_tree()[tile.index].variants.size());
    }
  }
}

TEST(Select, TheCapIsHardAndSpentOnTheWorstFirst) {
  Random random(44);
  int capped = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const core::View view = hostile_view(random, 1.0);
    const std::int64_t roots =
        selected(tolerance(std::numeric_limits<double>::infinity()), rough_tree(), view).triangles;
    const Selection free = selected(tolerance(0.5), rough_tree(), view);
    double worst_px = std::numeric_limits<double>::infinity();
    for (const std::int64_t cap : {1LL, 8000LL, 20000LL, 50000LL, 200000LL, 1000000LL}) {
      SelectOptions options = tolerance(0.5);
      options.max_triangles = cap;
      const Selection s = selected(options, rough_tree(), view);
      expect_sound(s, rough_tree(), options, view);
      if (HasFatalFailure()) return;
      ASSERT_LE(s.triangles, std::max(cap, roots));
      ASSERT_LE(s.max_screen_space_error_px, worst_px);
      worst_px = s.max_screen_space_error_px;
      // Whatever was refined was at least as bad as all that was left.
      const cull::Camera camera = cull::make_camera(view.camera.position_m);
      for (const lod::SelectedTile& tile : s.tiles) {
        if (tile.key.level == 0) continue;
        const auto parent =
            static_cast<TileTree::Index>(rough_tree().find(lod::parent(tile.key)) - &rough_tree()[0]);
        const double geometric_error_m = rough_tree()[parent].variants[0].terms.total_m;
        const cull::BoundingRegion region = rough_tree().region(parent, 1.0, geometric_error_m);
        const double distance_m =
            cull::min_distance_m(camera, cull::nearest_chord2(region.rect, camera.direction),
                                 region.min_radius_m, region.max_radius_m);
        double off_axis_magnification = std::numeric_limits<double>::infinity();
        for (int level = 0; level < tile.key.level; ++level) {
          const auto outer = static_cast<TileTree::Index>(rough_tree().find(lod::ancestor(tile.key, level)) -
                                                          &rough_tree()[0]);
          const cull::BoundingRegion around =
              rough_tree().region(outer, 1.0, rough_tree()[outer].variants[0].terms.total_m);
          const bool sky =
              cull::against_sky(camera, cull::make_horizon(camera, rough_tree().lowest_radius_m(1.0)),
                                cull::farthest_chord2(around.rect, camera.direction), around.max_radius_m);
          off_axis_magnification =
              sky ? std::min(
                        off_axis_magnification,
                        lod::off_axis_magnification(lod::image_plane(view), cull::bounding_hexahedron(around)))
                  : 1.0;
        }
        ASSERT_GE(
            projected(geometric_error_m, lod::select_view(view).focal_px, distance_m, off_axis_magnification),
            s.max_screen_space_error_px);
      }
      capped += s.capped ? 1 : 0;
      if (!s.capped) {
        ASSERT_EQ(s.triangles, free.triangles);
        ASSERT_EQ(s.tiles.size(), free.tiles.size());
      }
    }
  }
  EXPECT_GT(capped, 300);
}

TEST(Select, OfEquallyBadTilesTheFirstOfTheTreeIsRefined) {
  // Half a metre over the corner of four finest tiles, all with infinite error; the limit allows one full grid.
  const TileTree ball = fake::tree(fake::uniform(5));
  SelectOptions options = tolerance(1);
  options.max_triangles = 40000;
  const Selection s = selected(options, ball, panorama_at(0, 0, 0.5));
  EXPECT_TRUE(s.capped);
  EXPECT_EQ(s.triangles, 2 * 128 * 128 + 3 * 1000);
  ASSERT_EQ(s.tiles.size(), 4U);
  for (const lod::SelectedTile& tile : s.tiles) {
    EXPECT_EQ(tile.variant, tile.key == (TileKey{mars::Face::kPlusX, 5, 15, 15}) ? 1 : 0);
  }
}

// Culling each tile and all of its ancestors separately, against all planes, gives the same tiles.
TEST(Select, InheritedPlanesCullAsMuchAsAllPlanes) {
  Random random(47);
  const TileTree ball = fake::tree(fake::uniform(4));
  int culled = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const double lon = random.uniform(-180, 180);
    const double lat = random.uniform(-90, 90);
    const double alt = random.log_uniform(1e5, 1e7);
    const double yaw = random.uniform(0, 360);
    core::View view = view_at(lon, lat, alt, yaw, random.uniform(-90, -30));
    view.fov_deg = random.uniform(5, 90);
    const cull::Frustum frustum = cull::make_frustum(view);
    const cull::Camera camera = cull::make_camera(view.camera.position_m);
    const cull::Horizon horizon = cull::make_horizon(camera, ball.lowest_radius_m(1.0));
    const auto kept = [&](const TileKey& key) {
      const auto index = static_cast<TileTree::Index>(ball.find(key) - &ball[0]);
      const cull::BoundingRegion region = ball.region(index, 1.0, ball[index].variants[0].terms.total_m);
      return !cull::hidden(horizon, cull::nearest_chord2(region.rect, camera.direction), region.max_radius_m) &&
             cull::planes_crossed(frustum, cull::bounding_hexahedron(region), cull::all_planes(frustum))
                 .has_value();
    };
    std::vector<TileKey> expected;
    for (const TileInfo& tile : ball.tiles()) {
      bool keep = !tile.has_children;
      for (int level = 0; keep && level <= tile.key.level; ++level) keep = kept(lod::ancestor(tile.key, level));
      if (keep) expected.push_back(tile.key);
    }
    const Selection s = selected(tolerance(0), ball, view);
    std::vector<TileKey> got;
    for (const lod::SelectedTile& tile : s.tiles) got.push_back(tile.key);
    std::sort(got.begin(), got.end());
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(got, expected) << trial;
    culled += s.culled_frustum;
  }
  EXPECT_GT(culled, 500);
}

bool operator==(const lod::SelectedTile& a, const lod::SelectedTile& b) {
  return a.key == b.key && a.index == b.index && a.variant == b.variant &&
         a.geometric_error_m == b.geometric_error_m && a.screen_space_error_px == b.screen_space_error_px &&
         a.min_distance_m == b.min_distance_m;
}

TEST(Select, IsTheSameWhateverWasSelectedBefore) {
  Random random(45);
  lod::SelectScratch scratch;
  Selection reused;
  for (int trial = 0; trial < 300; ++trial) {
    SelectOptions options = tolerance(random.log_uniform(0.1, 100));
    options.max_triangles = random.integer(0, 1) == 0 ? 0 : random.integer(1, 100000);
    const core::View view = hostile_view(random, 1.0);
    lod::select(options, rough_tree(), lod::select_view(view), scratch, reused);
    const Selection fresh = selected(options, rough_tree(), view);
    ASSERT_TRUE(std::equal(reused.tiles.begin(), reused.tiles.end(), fresh.tiles.begin(), fresh.tiles.end(),
                           [](const auto& a, const auto& b) { return a == b; }));
    ASSERT_EQ(counts(reused), counts(fresh));
    ASSERT_EQ(reused.tiles_by_level, fresh.tiles_by_level);
    ASSERT_EQ(reused.capped, fresh.capped);
  }
}

TEST(Select, ALevelsShiftIsAFactorTwoOfTheTolerance) {
  Random random(46);
  for (int trial = 0; trial < 100; ++trial) {
    const core::View view = hostile_view(random, 1.0);
    for (const double levels : {-1.0, 0.0, 1.0, 3.0}) {
      SelectOptions options = tolerance(1.0);
      options.control.centre = {0.0, levels, 1.0, {}};
      const Selection shifted = selected(options, rough_tree(), view);
      const Selection plain = selected(tolerance(std::exp2(-levels)), rough_tree(), view);
      ASSERT_EQ(counts(shifted), counts(plain));
      ASSERT_EQ(shifted.max_screen_space_error_px, plain.max_screen_space_error_px);
    }
  }
}

TEST(Select, ExaggerationMovesTheGroundAndItsError) {
  // A plateau of +7 km: at exaggeration 10 a camera at 20 km is below it.
  fake::Planet plateau = fake::uniform(4);
  plateau.height_m = [](const TileKey&) { return 7000.0; };
  const TileTree tree = fake::tree(plateau);
  SelectOptions options = tolerance(1.0);
  const core::View view = panorama_at(10, 10, 20000);
  const Selection plain = selected(options, tree, view);
  EXPECT_NEAR(plain.tiles.empty() ? 0.0
                                  : std::min_element(plain.tiles.begin(), plain.tiles.end(),
                                                     [](const auto& a, const auto& b) {
                                                       return a.min_distance_m < b.min_distance_m;
                                                     })
                                        ->min_distance_m,
              13000.0, 5.0);
  options.exaggeration = 10.0;
  const Selection high = selected(options, tree, view);
  EXPECT_EQ(high.culled_horizon, 0);
  EXPECT_GT(high.tiles.size(), plain.tiles.size());
}

TEST(Select, RefusesWhatIsNoNumberOrOutOfRange) {
  const TileTree ball = fake::tree(fake::uniform(1));
  const lod::SelectView good = lod::select_view(view_at(0, 0, 1e6, 0, -90));
  lod::SelectScratch scratch;
  Selection s;
  const auto refuses = [&](const auto& spoil) {
    SelectOptions options;
    lod::SelectView view = good;
    spoil(options, view);
    EXPECT_THROW(lod::select(options, ball, view, scratch, s), std::invalid_argument);
  };
  const double nan = std::nan("");
  const double inf = std::numeric_limits<double>::infinity();
  refuses([&](auto&, auto& v) { v.camera_m.y = nan; });
  refuses([&](auto&, auto& v) { v.camera_m.z = inf; });
  refuses([&](auto&, auto& v) { v.focal_px = 0; });
  refuses([&](auto&, auto& v) { v.focal_px = nan; });
  refuses([&](auto& o, auto&) { o.tolerance_px = -1; });
  refuses([&](auto& o, auto&) { o.tolerance_px = nan; });
  refuses([&](auto& o, auto&) { o.exaggeration = 0; });
  refuses([&](auto& o, auto&) { o.exaggeration = inf; });
  refuses([&](auto& o, auto&) { o.max_triangles = -1; });
  SelectOptions options;
  lod::SelectView centre = good;
  centre.camera_m = {0, 0, 0};
  lod::select(options, ball, centre, scratch, s);
  EXPECT_EQ(s.culled_horizon, 0);
}

}  // namespace
