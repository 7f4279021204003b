#include "vpe/voxel/explain_tiles.h"

#include "lod/options.h"

namespace vpe::voxel {

namespace {

lod::LevelReason reason_of(const lod::TileInfo& tile, const TileUse& use, bool by_distance) {
  if (use.source != use.tile) return lod::LevelReason::kReplaced;
  if (!tile.has_children) return lod::LevelReason::kFinestThere;
  return by_distance ? lod::LevelReason::kLevelReached : lod::LevelReason::kWithinTolerance;
}

}  // namespace

std::vector<lod::TileExplanation> explain_tiles(const core::DrawRequest& request, const lod::TileTree& tree,
                                                const TileUsage& usage) {
  const lod::LevelControl control = lod::level_control(request, tree.radius_m());
  const lod::CentreOfView centre = lod::centre_of_view(request.view);
  const bool by_distance = control.metric == core::LodMetric::kDistance;
  std::vector<lod::TileExplanation> all;
  all.reserve(usage.tiles.size());
  for (const TileUse& use : usage.tiles) {
    const lod::TileInfo& info = tree[use.tile];
    lod::TileExplanation e;
    e.key = info.key;
    e.post_spacing_m =
        lod::nominal_side_m(tree[use.source].key.level, tree.radius_m()) / tree.shape().intervals();
    e.min_distance_m = use.min_distance_m;
    e.geometric_error_m = use.geometric_error_m;
    e.screen_space_error_px = use.screen_space_error_px;
    const cull::BoundingRegion region =
        tree.region(use.tile, request.settings.exaggeration, use.geometric_error_m);
    e.terms = lod::control_terms(control, centre,
                                 {cull::bounding_hexahedron(region), region.rect, use.min_distance_m}, true);
    if (by_distance) {
      e.wanted_level = lod::wanted_level_count(e.terms.sum) - 1;
    } else {
      e.shift = lod::level_shift(e.terms.sum);
    }
    e.reason = reason_of(info, use, by_distance);
    all.push_back(e);
  }
  return all;
}

}  // namespace vpe::voxel
