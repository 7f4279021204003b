// The horizon over azimuth blocks no ray that passes above all occluders, and almost all rays that the
// occluders block.
#include "cull/terrain_horizon.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"

namespace {

using test_support::Random;

constexpr double kRadius_m = mars::kMarsRadius_m;
constexpr double kNone = -std::numeric_limits<double>::infinity();

struct Occluder {
  mars::Face face;
  bool column;
  double line;
  std::vector<double> ends;
  std::vector<double> radius_m;
  cull::OccluderSegment view() const { return {face, column, line, ends, radius_m}; }
};

double slope_of(double cosine, double sine, double radius_m, double camera_m) {
  return (radius_m * cosine - camera_m) / (radius_m * sine);
}

// Slope of the highest ray along `ahead` (horizontal) that an occluder blocks, by the place where the ray's
// plane meets it.
double exact_slope(const std::vector<Occluder>& occluders, const cull::Camera& camera,
                   const glm::dvec3& ahead) {
  double highest = kNone;
  for (const Occluder& occluder : occluders) {
    const mars::FaceAxes& axes = mars::face_axes(occluder.face);
    const glm::dvec3 normal = (occluder.column ? axes.right : axes.up) - occluder.line * axes.out;
    glm::dvec3 d = glm::cross(normal, glm::cross(camera.direction, ahead));
    d = glm::normalize(glm::dot(d, ahead) < 0.0 ? -d : d);
    if (glm::dot(d, axes.out) <= 0.0) continue;
    const double along = glm::dot(occluder.column ? axes.up : axes.right, d) / glm::dot(axes.out, d);
    for (std::size_t n = 0; n < occluder.radius_m.size(); ++n) {
      if (along < occluder.ends[n] || along > occluder.ends[n + 1]) continue;
      highest = std::max(highest, slope_of(glm::dot(d, camera.direction), glm::dot(d, ahead),
                                           occluder.radius_m[n], camera.radius_m));
    }
  }
  return highest;
}

// The lines of a block of `side` x `side` tiles of one size round a chart point; neighbours share lines.
std::vector<Occluder> block_of_occluders(Random& random, const mars::ChartPoint& centre, double size, int side,
                                         double low, double high) {
  std::vector<Occluder> occluders;
  const double u0 = centre.u - 0.5 * side * size;
  const double v0 = centre.v - 0.5 * side * size;
  for (int tile = 0; tile < side * side; ++tile) {
    for (int line = 0; line <= 4; ++line) {
      for (const bool column : {true, false}) {
        Occluder occluder{centre.face, column, 0, {}, {}};
        const int a = column ? tile % side : tile / side;
        const int b = column ? tile / side : tile % side;
        occluder.line = (column ? u0 : v0) + (a * 4 + line) * (size / 4);
        for (int k = 0; k <= 4; ++k) occluder.ends.push_back((column ? v0 : u0) + (b * 4 + k) * (size / 4));
        for (int k = 0; k < 4; ++k) occluder.radius_m.push_back(kRadius_m + random.uniform(low, high));
        if (std::abs(occluder.line) <= 1 && occluder.ends.front() >= -1 && occluder.ends.back() <= 1)
          occluders.push_back(occluder);
      }
    }
  }
  return occluders;
}

struct Scene {
  cull::Camera camera;
  std::vector<Occluder> occluders;
};

Scene random_scene(Random& random) {
  Scene scene;
  const glm::dvec3 up = random.direction();
  const double above = random.integer(0, 2) == 0 ? random.log_uniform(0.5, 2000) : random.log_uniform(0.5, 3e7);
  const double ground = random.uniform(-8000, 8000);
  scene.camera = cull::make_camera(up * (kRadius_m + ground + above));
  const double reach = random.log_uniform(1e-5, 0.3);
  const double low = ground - random.log_uniform(1, 5000);
  for (int block = random.integer(1, 3); block > 0; --block) {
    const double away = reach * random.uniform(0, 2);
    const mars::ChartPoint near = mars::chart_point(up + away * random.direction());
    const double size = reach * random.log_uniform(0.05, 1);
    const int count = random.integer(1, 3);
    const double high = low + random.log_uniform(1, 20000);
    for (Occluder& occluder : block_of_occluders(random, near, size, count, low, high)) {
      scene.occluders.push_back(std::move(occluder));
    }
  }
  return scene;
}

// Horizontal direction towards a place; made perpendicular twice, as the place may be near.
glm::dvec3 ahead_to(const glm::dvec3& place, const glm::dvec3& up) {
  const glm::dvec3 once = glm::normalize(place - glm::dot(place, up) * up);
  return glm::normalize(once - glm::dot(once, up) * up);
}

glm::dvec3 random_ahead(Random& random, const glm::dvec3& up) {
  const glm::dvec3 east = mars::any_perpendicular(up);
  const double angle = random.uniform(-3.15, 3.15);
  return std::cos(angle) * east + std::sin(angle) * glm::cross(up, east);
}

double angle_between(double high, double low) { return std::atan((high - low) / (1.0 + high * low)); }

TEST(TerrainHorizon, BlocksNoRayAboveAllOccluders) {
  Random random(81);
  cull::TerrainHorizon horizon;
  int blocked = 0;
  std::vector<double> lost;
  for (int trial = 0; trial < 400; ++trial) {
    const Scene scene = random_scene(random);
    horizon.begin(scene.camera);
    for (const Occluder& occluder : scene.occluders) horizon.add(occluder.view());
    if (scene.occluders.empty()) continue;
    for (int ray = 0; ray < 100; ++ray) {
      glm::dvec3 ahead = random_ahead(random, scene.camera.direction);
      if (ray % 2 == 0) {  // towards an occluder
        const Occluder& occluder = scene.occluders[static_cast<std::size_t>(
            random.integer(0, static_cast<int>(scene.occluders.size()) - 1))];
        const double at = random.uniform(occluder.ends.front(), occluder.ends.back());
        const glm::dvec3 to = occluder.column ? mars::cube_point(occluder.face, occluder.line, at)
                                              : mars::cube_point(occluder.face, at, occluder.line);
        ahead = ahead_to(to, scene.camera.direction);
      }
      const double slope = horizon.blocked_slope(ahead);
      const double exact = exact_slope(scene.occluders, scene.camera, ahead);
      ASSERT_TRUE(exact > kNone || slope == kNone) << trial;
      if (exact == kNone) continue;
      ASSERT_LE(slope, exact + cull::TerrainHorizon::kRounding_rad * (1 + exact * exact)) << trial;
      blocked += slope > kNone ? 1 : 0;
      if (exact > kNone && slope > kNone) lost.push_back(angle_between(exact, slope));
    }
  }
  EXPECT_GT(blocked, 8000);
  std::sort(lost.begin(), lost.end());
  // Bins are 2 to 3 mrad wide, and these occluders jump up and down from piece to piece.
  EXPECT_LT(lost[lost.size() / 2], 0.01) << lost.size();
}

TEST(TerrainHorizon, HidesNoRegionWithAPointAboveAllOccluders) {
  Random random(82);
  cull::TerrainHorizon horizon;
  int hidden = 0;
  int aside = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const Scene scene = random_scene(random);
    const double margin = random.integer(0, 1) == 0 ? 0 : random.log_uniform(1e-5, 1e-2);
    horizon.begin(scene.camera, margin);
    for (const Occluder& occluder : scene.occluders) horizon.add(occluder.view());
    for (int tile = 0; tile < 20; ++tile) {
      const double away = random.log_uniform(1e-5, 1);
      const mars::ChartPoint at = mars::chart_point(scene.camera.direction + away * random.direction());
      const double size = random.log_uniform(1e-6, 0.05);
      const cull::BoundingRegion region{{at.face, std::max(-1.0, at.u - size), std::min(1.0, at.u + size),
                                         std::max(-1.0, at.v - size), std::min(1.0, at.v + size)},
                                        kRadius_m - 9000,
                                        kRadius_m + random.uniform(-9000, 5000)};
      if (!horizon.hidden(region)) continue;
      ++hidden;
      for (int sample = 0; sample < 30; ++sample) {
        const double s = random.integer(0, 2) == 0 ? random.integer(0, 1) : random.uniform(0, 1);
        const double t = random.integer(0, 2) == 0 ? random.integer(0, 1) : random.uniform(0, 1);
        const glm::dvec3 point =
            region.max_radius_m * mars::chart_direction(at.face,
                                                        region.rect.u0 + s * (region.rect.u1 - region.rect.u0),
                                                        region.rect.v0 + t * (region.rect.v1 - region.rect.v0));
        glm::dvec3 ray = glm::normalize(point - scene.camera.direction * scene.camera.radius_m);
        if (margin > 0 && sample % 2 == 0) {
          const glm::dvec3 off = glm::cross(ray, random.direction());
          ray = glm::normalize(ray + std::tan(margin * random.uniform(0.9, 1)) * glm::normalize(off));
          ++aside;
        }
        const double rise = glm::dot(ray, scene.camera.direction);
        const glm::dvec3 run = ray - rise * scene.camera.direction;
        const double exact = exact_slope(scene.occluders, scene.camera, ahead_to(run, scene.camera.direction));
        ASSERT_LT(rise / glm::length(run), exact) << trial << " " << margin;
      }
    }
  }
  EXPECT_GT(hidden, 500);
  EXPECT_GT(aside, 1000);
}

// Where the occluders of neighbours meet there must be no gap in azimuth: a ridge of many tiles hides like one.
TEST(TerrainHorizon, OccludersOfNeighboursLeaveNoGap) {
  Random random(83);
  cull::TerrainHorizon horizon;
  for (int trial = 0; trial < 200; ++trial) {
    // The camera stands within a block of tiles, off their lines; the block reaches over no face's border.
    const mars::ChartPoint at{static_cast<mars::Face>(random.integer(0, 5)), random.uniform(-0.5, 0.5),
                              random.uniform(-0.5, 0.5)};
    const double size = random.log_uniform(1e-3, 0.05);
    const glm::dvec3 up = mars::chart_direction(at.face, at.u + 0.03 * size, at.v + 0.0411 * size);
    const cull::Camera camera = cull::make_camera(up * (kRadius_m + 10));
    horizon.begin(camera);
    for (const Occluder& occluder : block_of_occluders(random, at, size, 3, 1000, 1001))
      horizon.add(occluder.view());
    int open = 0;
    for (int ray = 0; ray < 300; ++ray) open += horizon.blocked_slope(random_ahead(random, up)) > 0.0 ? 0 : 1;
    ASSERT_EQ(open, 0) << trial;
    // Ground of the same height behind it is hidden, higher ground is not.
    const glm::dvec3 far = glm::normalize(up + 4.0 * size * random_ahead(random, up));
    const mars::ChartPoint p = mars::chart_point(far);
    const cull::BoundingRegion behind{
        {p.face, p.u - 0.1 * size, p.u + 0.1 * size, p.v - 0.1 * size, p.v + 0.1 * size},
        kRadius_m,
        kRadius_m + 900};
    ASSERT_TRUE(horizon.hidden(behind));
    ASSERT_FALSE(horizon.hidden({behind.rect, kRadius_m, kRadius_m + 4e5}));
  }
}

TEST(TerrainHorizon, NothingIsHiddenUnderTheCameraOrWithoutOccluders) {
  cull::TerrainHorizon horizon;
  const cull::Camera camera = cull::make_camera({kRadius_m + 10, 0, 0});
  const mars::ChartRect here{mars::Face::kPlusX, -0.01, 0.01, -0.01, 0.01};
  const mars::ChartRect there{mars::Face::kPlusX, 0.1, 0.11, -0.005, 0.005};
  horizon.begin(camera);
  EXPECT_FALSE(horizon.hidden({there, kRadius_m - 9000, kRadius_m - 5000}));
  const std::vector<double> ends{-0.2, 0.2};
  const std::vector<double> radius{kRadius_m + 5000};
  horizon.add({mars::Face::kPlusX, true, 0.02, ends, radius});
  EXPECT_TRUE(horizon.hidden({there, kRadius_m - 9000, kRadius_m - 5000}));
  EXPECT_FALSE(horizon.hidden({here, kRadius_m - 9000, kRadius_m - 5000}));
  EXPECT_FALSE(horizon.hidden({{mars::Face::kMinusX, -0.1, 0.1, -0.1, 0.1}, kRadius_m - 9000, kRadius_m}));
  EXPECT_EQ(horizon.bins_spanned(here), cull::TerrainHorizon::kBins);
  EXPECT_LT(horizon.bins_spanned(there), 100);
  horizon.begin(camera);
  EXPECT_FALSE(horizon.hidden({there, kRadius_m - 9000, kRadius_m - 5000})) << "occluders of the frame before";
}

}  // namespace
