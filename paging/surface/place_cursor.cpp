#include "paging/surface/place_cursor.h"

#include <algorithm>
#include <cmath>

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
  if (!is_on_facet()) find_facet();
  find_point();
  return point_;
}

const SurfacePoint* PlaceCursor::move_near(const glm::dvec3& direction, double error_rad) {
  chart_ = mars::chart_point(direction);
  if (!is_on_facet()) find_facet();
  // A chart coordinate x grows by at most 1 + x^2 + y^2 <= 3 for each radian.
  const double margin = 4 * error_rad;
  const double from_middle = std::min(std::abs(chart_.u - (facet_->u0 + facet_->u1) / 2),
                                      std::abs(chart_.v - (facet_->v0 + facet_->v1) / 2));
  if (!(from_middle > margin) || !facet_->contains_around(chart_.u, chart_.v, margin)) return nullptr;
  find_point();
  return &point_;
}

bool PlaceCursor::is_on_facet() const {
  return facet_ && tile_->data.posts.key.face == chart_.face && facet_->contains(chart_.u, chart_.v);
}

void PlaceCursor::find_facet() {
  // The last lines are those of the next tile, too.
  const auto lies_between = [](double x, const std::vector<double>& lines) {
    return x >= lines.front() && x < lines.back();
  };
  const bool same = tile_ && tile_->data.posts.key.face == chart_.face &&
                    lies_between(chart_.u, tile_->lines.u) && lies_between(chart_.v, tile_->lines.v);
  if (!same) {
    facet_.reset();
    sources_.reset();
    resampled_source_.reset();
    tile_ = surface_.tile(finest_tile(surface_.planet().tree(), chart_));
  }
  facet_ = lod::facet_at(tile_->data.posts, tile_->lines, chart_.u, chart_.v, surface_.planet_radius_m());
  point_.tile = tile_->data.posts.key;
  point_.normal = facet_->normal(point_.tile.face);
}

void PlaceCursor::find_point() {
  const double radius_m = surface_.planet_radius_m();
  const auto within = [](double x, const std::vector<double>& lines) {
    return std::clamp(x, lines.front(), lines.back());
  };
  point_.height_m =
      facet_->height_m(within(chart_.u, tile_->lines.u), within(chart_.v, tile_->lines.v), radius_m);
  point_.radius_m = radius_m + point_.height_m;
  point_.nodata = is_nodata(*tile_, chart_);
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
  if (resampled_source_ == source) return resampling_;
  const ResamplingError own = of_source(sources().resampling, source);
  if (own.posts > 0) {
    resampling_ = {own, false};
  } else {
    const ResamplingError level = level_resampling(surface_.planet().meta(), point_.tile.level, source);
    resampling_ = {level, level.posts > 0};
  }
  resampled_source_ = source;
  return resampling_;
}

}  // namespace paging
