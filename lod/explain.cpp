#include "lod/explain.h"

#include <cmath>

namespace lod {

namespace {

LevelReason reason_of(const SelectOptions& options, const TileInfo& info, const SelectedTile& tile,
                      double degrade_weight) {
  if (is_full_grid(info, tile.variant)) return LevelReason::kFinestThere;
  if (options.control.metric == vpe::core::LodMetric::kDistance) {
    const double number = level_count(tile.key, tile.variant, static_cast<int>(info.variants.size()));
    return number >= tile.control ? LevelReason::kLevelReached : LevelReason::kBudgetSpent;
  }
  return tile.screen_space_error_px * std::exp2(tile.control) <=
                 options.tolerance_px * degrade_factor(options.control, degrade_weight)
             ? LevelReason::kWithinTolerance
             : LevelReason::kBudgetSpent;
}

}  // namespace

const char* to_string(LevelReason reason) {
  switch (reason) {
    case LevelReason::kFinestThere: return "finest there";
    case LevelReason::kWithinTolerance: return "within tolerance";
    case LevelReason::kLevelReached: return "level reached";
    case LevelReason::kReplaced: return "replaced by an ancestor";
    case LevelReason::kBudgetSpent: break;
  }
  return "budget spent";
}

std::vector<TileExplanation> explain(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                                     const Selection& selection) {
  const cull::Camera camera = cull::make_camera(view.camera_m);
  std::vector<TileExplanation> all;
  all.reserve(selection.tiles.size());
  for (const SelectedTile& tile : selection.tiles) {
    const TileInfo& info = tree[tile.index];
    TileExplanation e;
    e.key = tile.key;
    e.post_spacing_m = nominal_side_m(tile.key.level, tree.radius_m()) / tree.shape().intervals();
    e.variant = tile.variant;
    e.variants = static_cast<int>(info.variants.size());
    e.min_distance_m = tile.min_distance_m;
    e.geometric_error_m = tile.geometric_error_m;
    e.screen_space_error_px = tile.screen_space_error_px;
    const double coarsest_m = is_full_grid(info, 0)
                                  ? 0.0
                                  : tree.geometric_error_m(info, info.variants[0].terms, options.exaggeration);
    const cull::BoundingRegion region = tree.region(tile.index, options.exaggeration, coarsest_m);
    const double distance_m = cull::min_distance_m(camera, cull::nearest_chord2(region.rect, camera.direction),
                                                   region.min_radius_m, region.max_radius_m);
    e.terms = control_terms(options.control, view.centre,
                            {cull::bounding_hexahedron(region), region.rect, distance_m}, true);
    if (options.control.metric == vpe::core::LodMetric::kDistance) {
      e.wanted_level = static_cast<int>(tile.control) - 1;
    } else {
      e.shift = tile.control;
    }
    e.reason = reason_of(options, info, tile, e.terms.degrade_weight);
    all.push_back(e);
  }
  return all;
}

}  // namespace lod
