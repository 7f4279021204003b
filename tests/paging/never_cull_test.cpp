// Culling by frustum, horizon and nearer terrain: it removes nothing that brute force can see.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>

#include "cull/horizon.h"
#include "lod/occlusion.h"
#include "tests/paging/drawn_terrain.h"
#include "tests/paging/rough_planet.h"
#include "vpe/core/view.h"

namespace {

using test_support::DrawnMesh;
using test_support::DrawnTerrain;
using test_support::MeshStore;
using test_support::Random;
namespace core = vpe::core;

class Ground {
 public:
  Ground()
      : planet_(test_support::build_rough(dir_ / "rough.vpe")),
        surface_(planet_, std::size_t{64} << 20),
        store_(planet_) {}
  const lod::TileTree& tree() const { return planet_->tree(); }
  const paging::Surface& surface() const { return surface_; }
  MeshStore& store() { return store_; }
  double radius_m() const { return planet_->radius_m(); }

 private:
  test_support::TempDir dir_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  paging::Surface surface_;
  MeshStore store_;
};

Ground& ground() {
  static Ground made;
  return made;
}

core::View random_view(Random& random, const glm::dvec3& camera_m, double pitch) {
  core::View view;
  const glm::dvec3 up = glm::normalize(camera_m);
  const glm::dvec3 east = mars::any_perpendicular(up);
  view.camera.position_m = camera_m;
  const double yaw = random.uniform(-180, 180);
  view.camera.axes = mars::oriented_axes({east, glm::cross(up, east), up}, yaw, pitch, random.uniform(-30, 30));
  view.width = 640;
  view.height = 400;
  view.fov_deg = random.integer(0, 3) == 0 ? random.log_uniform(5, 150) : 60.0;
  if (random.integer(0, 4) == 0) view.projection = core::Projection::kEquirectangular;
  return view;
}

// Returns a camera near one of the places with detail, anywhere, or over a pole, from half a metre above the
// ground to ten radii.
glm::dvec3 hostile_camera(Random& random) {
  glm::dvec3 d = random.direction();
  const double near = random.log_uniform(1e-5, 0.05);
  switch (random.integer(0, 7)) {
    case 0:
    case 1: d = glm::normalize(test_support::kCanyon + near * d); break;
    case 2: d = glm::normalize(test_support::kCrater + near * d); break;
    case 3:
    case 4: d = glm::normalize(test_support::kBasin + near * d); break;
    case 5:
      d = random.integer(0, 3) == 0 ? glm::dvec3(0, 0, random.integer(0, 1) * 2 - 1)
                                    : glm::normalize(test_support::kPole + near * d);
      break;
    default: break;
  }
  double height = random.log_uniform(0.5, 3000);
  switch (random.integer(0, 7)) {
    case 0:
    case 1: height = 0.5; break;
    case 2: height = random.log_uniform(1000, 10 * ground().radius_m()); break;
    case 3:
      height = random.integer(0, 3) == 0 ? 10 * ground().radius_m() : random.log_uniform(1000, 1e6);
      break;
    default: break;
  }
  return d * (ground().surface().at(d).radius_m + height);
}

lod::Selection select(const core::View& view, double tolerance_px, double exaggeration) {
  lod::SelectOptions options;
  options.tolerance_px = tolerance_px;
  options.exaggeration = exaggeration;
  options.max_triangles = 150000;
  lod::SelectScratch scratch;
  lod::Selection selection;
  lod::select(options, ground().tree(), lod::select_view(view), scratch, selection);
  return selection;
}

struct Occlusion {
  std::vector<std::uint8_t> hidden;
  double ms = 0;
};

// Every unknown-th tile lacks its occluder profile, as while it is loaded; 0 = none lacks it.
Occlusion occlude(const lod::Selection& selection, const glm::dvec3& camera_m, bool above, double margin_rad,
                  lod::OcclusionPass& pass, std::size_t unknown = 0) {
  std::vector<lod::OccludingTile> tiles;
  for (const lod::SelectedTile& t : selection.tiles) {
    tiles.push_back({t.key, ground().tree().region(t.index, selection.exaggeration, t.geometric_error_m),
                     &ground().store().mesh(t, selection.exaggeration).occluders});
    if (unknown > 0 && tiles.size() % unknown == 0) tiles.back().occluders = nullptr;
  }
  Occlusion out;
  const auto start = std::chrono::steady_clock::now();
  lod::occlude(tiles, camera_m, above, margin_rad, ground().radius_m(), pass, out.hidden);
  out.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return out;
}

// Returns a point of a mesh: mostly the vertex of a few that rises highest in the camera's view.
glm::dvec3 hostile_point(Random& random, const DrawnMesh& mesh, const glm::dvec3& camera_m) {
  const glm::dvec3 up = glm::normalize(camera_m);
  const auto vertex = [&] {
    return mesh
        .vertices[static_cast<std::size_t>(random.integer(0, static_cast<int>(mesh.vertices.size()) - 1))];
  };
  if (random.integer(0, 3) == 0) {
    const auto t =
        static_cast<std::size_t>(3 * random.integer(0, static_cast<int>(mesh.triangles.size() / 3) - 1));
    const double a = random.uniform(0, 1);
    const double b = random.uniform(0, 1 - a);
    return a * mesh.vertices[mesh.triangles[t]] + b * mesh.vertices[mesh.triangles[t + 1]] +
           (1 - a - b) * mesh.vertices[mesh.triangles[t + 2]];
  }
  glm::dvec3 best = vertex();
  double highest = glm::dot(glm::normalize(best - camera_m), up);
  for (int n = 0; n < 30; ++n) {
    const glm::dvec3 other = vertex();
    const double rise = glm::dot(glm::normalize(other - camera_m), up);
    if (rise > highest) best = other, highest = rise;
  }
  return best;
}

// Returns whether a place of the reference surface is in one of the tiles, all of which are drawn.
bool drawn_at(const lod::Selection& selection, const glm::dvec3& place) {
  const std::int64_t z = lod::morton_position(lod::tile_at(mars::chart_point(place), lod::kMaxLevel));
  const auto after = std::upper_bound(
      selection.tiles.begin(), selection.tiles.end(), z,
      [](std::int64_t at, const lod::SelectedTile& t) { return at < lod::morton_position(t.key); });
  return after != selection.tiles.begin() &&
         z < lod::morton_position((after - 1)->key) + lod::morton_extent((after - 1)->key.level);
}

struct Totals {
  int cameras = 0, half_metre = 0, ten_radii = 0, poles = 0, above = 0, below_datum = 0, tiles = 0, hidden = 0,
      points = 0, rays = 0, hits = 0, limb = 0;
};

// Expects tiles wherever rays hit the reference surface: at random pixels, on the image's border, and at the
// horizon.
void check_frustum_and_horizon(Random& random, const core::View& view, const lod::Selection& selection,
                               Totals& totals) {
  const glm::dvec3& camera = view.camera.position_m;
  for (int ray = 0; ray < 3; ++ray) {
    double x = random.uniform(0, view.width);
    double y = random.uniform(0, view.height);
    if (random.integer(0, 2) == 0) x = random.integer(0, 1) * view.width;
    if (random.integer(0, 2) == 0) y = random.integer(0, 1) * view.height;
    glm::dvec3 d = core::pixel_ray(view, x, y);
    if (ray == 2 && view.projection == core::Projection::kEquirectangular) {
      // Just below where rays pass over the planet.
      const double down =
          mars::horizon_dip_rad(glm::length(camera) - ground().radius_m(), ground().radius_m()) -
          random.uniform(-0.02, 0.01);
      const glm::dvec3 up = glm::normalize(camera);
      const glm::dvec3 ahead = glm::normalize(d - glm::dot(d, up) * up);
      d = std::cos(down) * ahead - std::sin(down) * up;
      ++totals.limb;
    }
    const double distance = ground().surface().cast(camera, glm::normalize(d));
    ++totals.rays;
    if (!std::isfinite(distance) || distance == 0.0) continue;
    ++totals.hits;
    const glm::dvec3 hit = camera + distance * glm::normalize(d);
    // Off by rounding it may lie in the next tile.
    const glm::dvec3 back = camera + distance * (1 - 1e-9) * glm::normalize(d);
    ASSERT_TRUE(drawn_at(selection, hit) || drawn_at(selection, back))
        << "camera " << totals.cameras << " at " << glm::length(camera) - ground().radius_m() << " m, hit at "
        << distance << " m";
  }
}

void check_occlusion(Random& random, const core::View& view, const lod::Selection& selection,
                     lod::OcclusionPass& pass, Totals& totals) {
  const glm::dvec3& camera = view.camera.position_m;
  const DrawnTerrain drawn(ground().store(), selection, camera);
  // Where the ground under the camera is not in the image, the reference surface replaces it, with a margin
  // for the error.
  const bool above = drawn.camera_is_above().value_or(
      glm::length(camera) > ground().radius_m() +
                                selection.exaggeration * (ground().surface().at(camera).height_m) +
                                selection.max_geometric_error_m);
  totals.above += above ? 1 : 0;
  const Occlusion found = occlude(selection, camera, above, 0.0, pass,
                                  static_cast<std::size_t>(std::max(0, random.integer(-6, 3))));
  std::vector<std::size_t> hidden;
  for (std::size_t n = 0; n < found.hidden.size(); ++n) {
    if (found.hidden[n] != 0) hidden.push_back(n);
  }
  totals.tiles += static_cast<int>(selection.tiles.size());
  totals.hidden += static_cast<int>(hidden.size());
  ASSERT_TRUE(above || hidden.empty());
  for (int n = 0; n < 3 && !hidden.empty(); ++n) {
    const std::size_t tile =
        hidden[static_cast<std::size_t>(random.integer(0, static_cast<int>(hidden.size()) - 1))];
    ++totals.points;
    ASSERT_TRUE(drawn.blocked(hostile_point(random, drawn.mesh(tile), camera)))
        << "camera " << totals.cameras << ", tile " << lod::to_string(selection.tiles[tile].key);
  }
}

void expect_never_culled(std::uint64_t seed, int cameras) {
  Random random(seed);
  lod::OcclusionPass pass;
  Totals totals;
  for (; totals.cameras < cameras && !testing::Test::HasFatalFailure(); ++totals.cameras) {
    const glm::dvec3 camera = hostile_camera(random);
    totals.below_datum += glm::length(camera) < ground().radius_m() ? 1 : 0;
    const double height = glm::length(camera) - ground().surface().at(camera).radius_m;
    totals.half_metre += height < 0.51 ? 1 : 0;
    totals.ten_radii += height > 9.99 * ground().radius_m() ? 1 : 0;
    totals.poles += camera.x == 0.0 && camera.y == 0.0 ? 1 : 0;
    const core::View view = random_view(random, camera, random.uniform(-90, 45));
    const lod::Selection selection = select(view, random.log_uniform(0.5, 20), 1.0);
    check_frustum_and_horizon(random, view, selection, totals);
    check_occlusion(random, view, selection, pass, totals);
  }
  std::printf(
      "cameras %d (0.5 m up %d, 10 radii %d, poles %d, above ground %d, below the datum %d), rays %d, hits %d, "
      "at the limb %d, tiles %d, hidden %d, points %d\n",
      totals.cameras, totals.half_metre, totals.ten_radii, totals.poles, totals.above, totals.below_datum,
      totals.rays, totals.hits, totals.limb, totals.tiles, totals.hidden, totals.points);
  EXPECT_GT(totals.above, cameras * 9 / 10);
  EXPECT_GT(totals.below_datum, cameras / 10);
  EXPECT_GT(totals.half_metre, cameras / 8);
  EXPECT_GT(totals.ten_radii, cameras / 100);
  EXPECT_GT(totals.poles, cameras / 100);
  EXPECT_GT(totals.hits, cameras);
  EXPECT_GT(totals.points, cameras);
}

TEST(NeverCull, WhatIsSeenIsDrawn) { expect_never_culled(61, 400); }

// 100 000 cameras in all, in four tests so that they can run side by side.
class LongNeverCull : public testing::TestWithParam<std::uint64_t> {};
TEST_P(LongNeverCull, WhatIsSeenIsDrawn) { expect_never_culled(GetParam(), 25000); }
INSTANTIATE_TEST_SUITE_P(LongSeeds, LongNeverCull, testing::Values(621, 622, 623, 624));

// Exaggerated ground hides more, and its occluders move with it.
TEST(NeverCull, ExaggeratedGroundHidesOnlyWhatItHides) {
  Random random(63);
  lod::OcclusionPass pass;
  for (const double exaggeration : {0.3, 4.0}) {
    Totals totals;
    for (; totals.cameras < 100; ++totals.cameras) {
      const double away = random.log_uniform(1e-5, 0.05);
      const glm::dvec3 d = glm::normalize(test_support::kCanyon + away * random.direction());
      const double height = ground().surface().at(d).height_m;
      const double radius_m = ground().radius_m() + exaggeration * height + random.log_uniform(10, 1e4);
      const double pitch = random.uniform(-30, 10);
      const core::View view = random_view(random, d * radius_m, pitch);
      check_occlusion(random, view, select(view, 4.0, exaggeration), pass, totals);
      if (HasFatalFailure()) return;
    }
    EXPECT_GT(totals.points, 60);
  }
}

// Counts tiles of which no point is seen, and those of them that the pass found.
struct HiddenTiles {
  int tiles = 0, hidden = 0, found = 0;
  double ms = 0;
};

// Tests up to `most` vertices of each tile.
HiddenTiles count_hidden(Random& random, const glm::dvec3& place, double spread_rad, int views, int most) {
  lod::OcclusionPass pass;
  HiddenTiles count;
  for (int n = 0; n < views; ++n) {
    const double away = spread_rad * random.uniform(0, 1);
    const glm::dvec3 d = glm::normalize(place + away * random.direction());
    const double radius_m = ground().surface().at(d).radius_m + random.log_uniform(2, 200);
    const double pitch = random.uniform(-5, 5);
    core::View view = random_view(random, d * radius_m, pitch);
    view.projection = core::Projection::kPerspective;
    view.fov_deg = 60;
    view.width = 1280;
    view.height = 720;
    const lod::Selection selection = select(view, 1.0, 1.0);
    const DrawnTerrain drawn(ground().store(), selection, view.camera.position_m);
    const Occlusion found = occlude(selection, view.camera.position_m, true, 0.0, pass);
    count.ms += found.ms;
    count.tiles += static_cast<int>(selection.tiles.size());
    for (std::size_t tile = 0; tile < selection.tiles.size(); ++tile) {
      const DrawnMesh& mesh = drawn.mesh(tile);
      const auto step = std::max<std::size_t>(1, mesh.vertices.size() / static_cast<std::size_t>(most));
      bool seen = false;
      for (std::size_t v = 0; v < mesh.vertices.size() && !seen; v += step)
        seen = !drawn.blocked(mesh.vertices[v]);
      EXPECT_FALSE(seen && found.hidden[tile] != 0) << lod::to_string(selection.tiles[tile].key);
      count.hidden += seen ? 0 : 1;
      count.found += found.hidden[tile] != 0 ? 1 : 0;
    }
  }
  std::printf("tiles %d, hidden %d, found %d (%.0f %%), %.3f ms a view, %.2f us a tile\n", count.tiles,
              count.hidden, count.found, 100.0 * count.found / std::max(1, count.hidden), count.ms / views,
              1e3 * count.ms / std::max(1, count.tiles));
  return count;
}

TEST(NeverCull, FindsHalfOfWhatIsHiddenInACanyonAndACrater) {
  Random random(64);
  for (const glm::dvec3& place : {test_support::kCanyon, test_support::kCrater}) {
    const HiddenTiles count = count_hidden(random, place, 0.001, 4, 40);
    EXPECT_GT(count.hidden, 20);
    EXPECT_GE(2 * count.found, count.hidden);
  }
}

TEST(LongNeverCullShare, FindsHalfOfWhatIsHiddenInACanyonAndACrater) {
  Random random(65);
  for (const glm::dvec3& place : {test_support::kCanyon, test_support::kCrater}) {
    const HiddenTiles count = count_hidden(random, place, 0.002, 60, 200);
    EXPECT_GE(2 * count.found, count.hidden);
  }
}

}  // namespace
