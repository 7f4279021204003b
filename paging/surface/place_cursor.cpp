#include "paging/surface/place_cursor.h"

#include "paging/surface/tile_place.h"

namespace paging {
namespace {

ResamplingError of_source(const std::vector<SourceResampling>& list, int source) {
  for (const SourceResampling& own : list)
    if (own.source == source) return own.error;
  return {};
}

// Files before format 1.3 do not tell sources apart.
ResamplingError level_resampling(const PlanetMeta& meta, int level, int source) {
  for (const LevelSummary& summary : meta.levels) {
    if (summary.level != level) continue;
    return meta.sources.size() == 1 ? summary.resampling : of_source(summary.resampling_by_source, source);
  }
  return {};
}

}  // namespace

const SurfacePoint& PlaceCursor::move_to(const glm::dvec3& direction) {
  chart_ = mars::chart_point(direction);
  const bool same = tile_ && tile_->data.posts.key.face == chart_.face &&
                    lod::tile_at(chart_, tile_->data.posts.key.level) == tile_->data.posts.key;
  if (!same) {
    tile_ = surface_.tile(finest_tile(surface_.planet().tree(), chart_));
    sources_.reset();
  }
  point_ = point_in(*tile_, chart_, surface_.planet_radius_m(), 1.0);
  return point_;
}

const TileSources& PlaceCursor::sources() {
  if (!sources_) sources_ = surface_.sources(point_.tile);
  return *sources_;
}

std::optional<int> PlaceCursor::source() {
  if (point_.nodata) return std::nullopt;
  const TileSources& all = sources();
  return all.of_post.empty() ? all.at(0) : all.at(nearest_post(*tile_, chart_));
}

PlaceCursor::Resampling PlaceCursor::resampling(int source) {
  const ResamplingError own = of_source(sources().resampling, source);
  if (own.posts > 0) return {own, false};
  const ResamplingError level = level_resampling(surface_.planet().meta(), point_.tile.level, source);
  return {level, level.posts > 0};
}

}  // namespace paging
