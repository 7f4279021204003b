#include "paging/surface/height_cursor.h"

#include <algorithm>
#include <limits>

#include "paging/surface/tile_place.h"

namespace paging {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns the error of a tile's own posts; infinity where it is not stated.
double posts_error_m(const lod::TileInfo& info) {
  if (!info.has_children) return 0;
  const double total_m = info.posts_terms.terms().total_m;
  return total_m >= 0 ? total_m : kInfinity;
}

bool lies_between(double x, const std::vector<double>& lines) { return x >= lines.front() && x < lines.back(); }

}  // namespace

bool HeightCursor::is_within(double most_error_m) const {
  return geometric_error_m_ <= most_error_m && most_error_m < parent_error_m_;
}

// Errors never grow from a tile to its children.
void HeightCursor::find_tile(const mars::ChartPoint& place, double most_error_m) {
  const lod::TileTree& tree = surface_.planet().tree();
  lod::TileKey key = lod::tile_at(place, 0);
  parent_error_m_ = kInfinity;
  for (const lod::TileInfo* info = tree.find(key); info != nullptr; info = tree.find(key)) {
    geometric_error_m_ = posts_error_m(*info);
    if (geometric_error_m_ <= most_error_m || !info->has_children) break;
    parent_error_m_ = geometric_error_m_;
    key = lod::tile_at(place, key.level + 1);
  }
  tile_ = surface_.tile(key);
}

double HeightCursor::height_m(const glm::dvec3& direction, double most_error_m) {
  const mars::ChartPoint place = mars::chart_point(direction);
  const double most_m = std::max(0.0, most_error_m);
  const bool is_served = tile_ && tile_->data.posts.key.face == place.face && is_within(most_m);
  if (!is_served || !facet_ || !facet_->contains(place.u, place.v)) {
    facet_.reset();
    if (!is_served || !lies_between(place.u, tile_->lines.u) || !lies_between(place.v, tile_->lines.v))
      find_tile(place, most_m);
    facet_ = lod::facet_at(tile_->data.posts, tile_->lines, place.u, place.v, surface_.planet_radius_m());
  }
  const auto within = [](double x, const std::vector<double>& lines) {
    return std::clamp(x, lines.front(), lines.back());
  };
  return facet_->height_m(within(place.u, tile_->lines.u), within(place.v, tile_->lines.v),
                          surface_.planet_radius_m());
}

}  // namespace paging
