#include "lod/off_axis_magnification.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "lod/tree/tile_key.h"
#include "tests/support/support.h"

namespace {

using test_support::Random;
namespace core = vpe::core;

constexpr double kRadius_m = 3396190.0;

core::View view_of(const mars::Pose& pose, double fov_deg) {
  core::View view;
  view.camera = mars::to_camera(pose, kRadius_m);
  view.fov_deg = fov_deg;
  return view;
}

// Length in the image of a small radial step at a point, by a central difference, in units of step * f /
// range.
double drawn_stretch(const core::View& view, const glm::dvec3& point) {
  const double range = glm::length(point - view.camera.position_m);
  const double step = 1e-4 * range;
  const glm::dvec3 up = glm::normalize(point);
  const core::Projected a = core::project(view, point + 0.5 * step * up);
  const core::Projected b = core::project(view, point - 0.5 * step * up);
  const glm::dvec2 moved = a.xy - b.xy;
  return std::hypot(moved.x, moved.y) / (step * core::focal_px(view) / range);
}

cull::BoundingRegion bounding_region(const lod::TileKey& key) {
  return {lod::chart_rect(key), kRadius_m - 6000.0, kRadius_m + 8000.0};
}

glm::dvec3 point_in(const cull::BoundingRegion& region, Random& random) {
  const mars::ChartRect& r = region.rect;
  const glm::dvec2 at{random.uniform(r.u0, r.u1), random.uniform(r.v0, r.v1)};
  return mars::chart_direction(r.face, at.x, at.y) * random.uniform(region.min_radius_m, region.max_radius_m);
}

TEST(OffAxisMagnification, BoundsWhatIsDrawn) {
  Random random(91);
  int seen = 0;
  int whole_tiles = 0;
  double bounds = 0;
  double drawn = 0;
  for (int trial = 0; trial < 40000; ++trial) {
    const mars::LonLat at = mars::lon_lat(random.direction());
    const double alt = random.log_uniform(9000, 3e7);
    const mars::Pose pose{at.lon_deg,
                          at.lat_deg,
                          alt,
                          random.uniform(0, 360),
                          random.uniform(-90, 10),
                          random.uniform(-180, 180)};
    core::View view = view_of(pose, random.log_uniform(1, 150));
    if (trial % 3 == 0) view.principal_offset_px = {random.uniform(-900, 900), random.uniform(-500, 500)};
    if (trial % 5 == 0) view.part = {random.integer(0, 900), random.integer(0, 500), 200, 120};
    const core::SubRectangle shown =
        view.part.width > 0 ? view.part : core::SubRectangle{0, 0, view.width, view.height};
    const glm::dvec2 pixel{shown.x + random.uniform(0, shown.width), shown.y + random.uniform(0, shown.height)};
    const glm::dvec3 ray = core::pixel_ray(view, pixel.x, pixel.y);
    const double middle = -glm::dot(view.camera.position_m, ray);
    const double lowest2 = glm::dot(view.camera.position_m, view.camera.position_m) - middle * middle;
    if (middle <= 0 || lowest2 >= kRadius_m * kRadius_m) continue;
    const glm::dvec3 hit = view.camera.position_m + ray * (middle - std::sqrt(kRadius_m * kRadius_m - lowest2));
    const lod::TileKey key = lod::tile_at(mars::chart_point(hit), random.integer(0, 9));
    const cull::BoundingRegion region = bounding_region(key);
    const double bound = lod::off_axis_magnification(lod::image_plane(view), cull::bounding_hexahedron(region));
    ASSERT_GE(bound, 1.0);
    double worst = 0;
    bool whole = true;
    for (int n = 0; n < 30; ++n) {
      const glm::dvec3 point = n == 0 ? hit : point_in(region, random);
      const core::Projected p = core::project(view, point);
      const bool inside = !p.behind && p.xy.x >= shown.x && p.xy.x <= shown.x + shown.width &&
                          p.xy.y >= shown.y && p.xy.y <= shown.y + shown.height;
      whole = whole && inside;
      if (!inside) continue;
      ++seen;
      worst = std::max(worst, drawn_stretch(view, point));
    }
    ASSERT_LE(worst, bound * (1 + 1e-6)) << "trial " << trial << " level " << key.level;
    if (whole && key.level >= 8 && worst < 4) {
      ++whole_tiles;
      bounds += bound;
      drawn += std::max(1.0, worst);
    }
  }
  EXPECT_GT(seen, 20000);
  EXPECT_GT(whole_tiles, 200);
  EXPECT_LE(bounds, 1.05 * drawn);
}

TEST(OffAxisMagnification, IsOneAboutTheAxisAndForPanoramas) {
  const cull::BoundingHexahedron below =
      cull::bounding_hexahedron(bounding_region(lod::tile_at(mars::chart_point(mars::direction({10, 20})), 9)));
  core::View view = view_of({10, 20, 5e5, 0, -90, 0}, 60);
  EXPECT_EQ(lod::off_axis_magnification(lod::image_plane(view), below), 1.0);
  view.projection = core::Projection::kEquirectangular;
  EXPECT_FALSE(lod::image_plane(view).flat);
  EXPECT_EQ(lod::off_axis_magnification(lod::image_plane(view), below), 1.0);
}

// A limb far off axis: upright there, so the secant of the angle is all there is.
TEST(OffAxisMagnification, IsTheSecantAtTheSidesOfALevelView) {
  core::View view = view_of({0, 0, 20000, 90, 0, 0}, 60);
  const glm::dvec3 aside = core::pixel_ray(view, view.width - 0.5, 0.5 * view.height + 60);
  const double middle = -glm::dot(view.camera.position_m, aside);
  const glm::dvec3 point = view.camera.position_m + aside * middle;
  const lod::TileKey key = lod::tile_at(mars::chart_point(point), 9);
  const double t = (0.5 * view.width - 0.5) / core::focal_px(view);
  EXPECT_NEAR(
      lod::off_axis_magnification(lod::image_plane(view), cull::bounding_hexahedron(bounding_region(key))),
      std::hypot(1.0, t), 0.12);
}

}  // namespace
