#include "lod/reevaluate.h"

#include "mars/geodesy/sphere.h"
#include "tests/lod/fake_tree.h"
#include "tests/support/support.h"

namespace {

vpe::core::View view_at(double lon, double lat, double alt_m, double yaw, double pitch) {
  vpe::core::View view;
  view.camera = mars::to_camera(mars::Pose{lon, lat, alt_m, yaw, pitch, 0}, fake::kRadius_m);
  return view;
}

TEST(Reevaluate, TheSameViewSeesWhatSelectionSays) {
  const lod::TileTree tree = fake::tree(fake::rough(3, 8));
  test_support::Random random(31);
  for (int trial = 0; trial < 100; ++trial) {
    const double lon = random.uniform(-180, 180);
    const double lat = random.uniform(-90, 90);
    const double alt = random.log_uniform(9000, 1e7);
    const double yaw = random.uniform(0, 360);
    const vpe::core::View view = view_at(lon, lat, alt, yaw, random.uniform(-90, 0));
    lod::SelectScratch scratch;
    lod::Selection selection;
    lod::select({}, tree, lod::select_view(view), scratch, selection);
    lod::Selection again = selection;
    lod::reevaluate_for_view(lod::select_view(view), tree, again);
    for (std::size_t n = 0; n < selection.tiles.size(); ++n) {
      const lod::SelectedTile& a = selection.tiles[n];
      const lod::SelectedTile& b = again.tiles[n];
      ASSERT_EQ(a.key, b.key);
      ASSERT_EQ(a.min_distance_m, b.min_distance_m);
      // Another bound: selection leaves out what cannot stand against the sky, and keeps that of a coarser
      // mesh.
      ASSERT_GE(b.off_axis_magnification, 1.0);
      ASSERT_DOUBLE_EQ(b.screen_space_error_px * a.off_axis_magnification,
                       a.screen_space_error_px * b.off_axis_magnification);
    }
  }
}

TEST(Reevaluate, DistancesBoundThoseFromTheOtherCamera) {
  const lod::TileTree tree = fake::tree(fake::rough(3, 8));
  test_support::Random random(32);
  for (int trial = 0; trial < 50; ++trial) {
    const double lon = random.uniform(-180, 180);
    const double from_lat = random.uniform(-80, 80);
    const vpe::core::View from = view_at(lon, from_lat, random.log_uniform(1000, 1e6), 0, -20);
    const double to_lat = random.uniform(-80, 80);
    const vpe::core::View to = view_at(lon + 2, to_lat, random.log_uniform(1000, 1e7), 0, -60);
    lod::SelectScratch scratch;
    lod::Selection selection;
    lod::select({}, tree, lod::select_view(from), scratch, selection);
    lod::reevaluate_for_view(lod::select_view(to), tree, selection);
    double worst = 0;
    for (const lod::SelectedTile& tile : selection.tiles) {
      const cull::BoundingRegion region = tree.region(tile.index, 1.0, tile.geometric_error_m);
      for (int sample = 0; sample < 5; ++sample) {
        const glm::dvec2 at{random.uniform(region.rect.u0, region.rect.u1),
                            random.uniform(region.rect.v0, region.rect.v1)};
        const glm::dvec3 point = mars::chart_direction(region.rect.face, at.x, at.y) *
                                 random.uniform(region.min_radius_m, region.max_radius_m);
        ASSERT_LE(tile.min_distance_m, glm::length(point - to.camera.position_m));
      }
      worst = std::max(worst, tile.screen_space_error_px);
    }
    ASSERT_EQ(selection.max_screen_space_error_px, worst);
  }
}

}  // namespace
