// Views, options and terms that the tests of level control share.
#pragma once

#include "lod/control.h"
#include "lod/select.h"
#include "mars/geodesy/sphere.h"
#include "tests/lod/fake_tree.h"
#include "tests/support/support.h"

namespace control_fixture {

using lod::ControlFunction;
using lod::Selection;
using lod::SelectOptions;
using lod::TileTree;
using test_support::Random;
namespace core = vpe::core;

inline core::View view_at(double lon, double lat, double alt_m, double yaw, double pitch) {
  core::View view;
  view.camera = mars::to_camera(mars::Pose{lon, lat, alt_m, yaw, pitch, 0}, fake::kRadius_m);
  return view;
}

inline core::View random_view(Random& random) {
  const double lon = random.uniform(-180, 180);
  const double lat = random.uniform(-90, 90);
  const double alt = 8500 + random.log_uniform(10, 3e6);
  const double yaw = random.uniform(0, 360);
  core::View view = view_at(lon, lat, alt, yaw, random.uniform(-90, 10));
  view.fov_deg = random.uniform(20, 100);
  return view;
}

inline const TileTree& rough_tree() {
  static const TileTree tree = fake::tree(fake::rough(3, 9));
  return tree;
}

inline Selection selected(const SelectOptions& options, const TileTree& tree, const core::View& view) {
  lod::SelectScratch scratch;
  Selection selection;
  lod::select(options, tree, lod::select_view(view), scratch, selection);
  return selection;
}

inline SelectOptions by_distance(const ControlFunction& distance, const ControlFunction& centre = {}) {
  SelectOptions options;
  options.control.metric = core::LodMetric::kDistance;
  options.control.distance = distance;
  options.control.centre = centre;
  return options;
}

// Returns the terms of a tile that is in a selection or was refined for it.
inline lod::ControlTerms terms_of(const SelectOptions& options, const TileTree& tree, const core::View& view,
                                  const lod::TileKey& key) {
  const auto index = static_cast<TileTree::Index>(tree.find(key) - &tree[0]);
  const cull::BoundingRegion region = tree.region(index, 1.0, tree[index].variants[0].terms.total_m);
  const cull::Camera camera = cull::make_camera(view.camera.position_m);
  const double distance = cull::min_distance_m(camera, cull::nearest_chord2(region.rect, camera.direction),
                                               region.min_radius_m, region.max_radius_m);
  return lod::control_terms(options.control, lod::centre_of_view(view),
                            {cull::bounding_hexahedron(region), region.rect, distance}, true);
}

}  // namespace control_fixture
