#include "paging/surface/height_difference.h"

namespace paging {

PostHeights heights_at_posts(const Surface& planet, const lod::TileKey& key, int intervals) {
  const PlanetFile& file = planet.planet();
  if (file.meta().tile.intervals() == intervals && file.tree().find(key) != nullptr) {
    const auto tile = planet.tile(key);
    return {tile->data.posts.height_m, tile->data.nodata};
  }
  PostHeights out;
  const lod::GridLines lines = lod::grid_lines(key, intervals);
  out.height_m.reserve(lines.u.size() * lines.v.size());
  std::vector<bool> nodata;
  bool has_nodata = false;
  for (const double v : lines.v) {
    for (const double u : lines.u) {
      const SurfacePoint point = planet.at(mars::chart_direction(key.face, u, v));
      out.height_m.push_back(point.height_m);
      nodata.push_back(point.nodata);
      has_nodata = has_nodata || point.nodata;
    }
  }
  if (has_nodata) out.nodata = std::move(nodata);
  return out;
}

}  // namespace paging
