// Which tiles a column walk casts, and how far they are off.
#include "vpe/voxel/cast/column_walk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <map>

#include "mars/geodesy/cube.h"
#include "vpe/voxel/cast/tile_fallbacks.h"

namespace vpe::voxel {

namespace {

// Bits of ends_.
constexpr std::uint8_t kKnown = 1;
constexpr std::uint8_t kYes = 2;
constexpr std::uint8_t kUsed = 4;
constexpr std::uint8_t kParentsPosts = 8;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// Returns the steepest slope from the camera to anything within `radius_m` of the centre at central angles
// [near, far].
double steepest(double radius_m, double distance_m, double near, double far) {
  const auto slope = [&](double angle) {
    const double sine = std::sin(angle);
    const double rise = radius_m * std::cos(angle) - distance_m;
    if (sine <= 0.0) return rise >= 0.0 ? kUnbounded : -kUnbounded;
    return rise / (radius_m * sine);
  };
  if (radius_m >= distance_m) return slope(std::max(0.0, near));
  const double limb = std::acos(radius_m / distance_m);
  return slope(std::clamp(limb, std::max(0.0, near), std::min(far, std::acos(-1.0))));
}

}  // namespace

ColumnWalk::ColumnWalk(const paging::Surface& surface, const ColumnCamera& camera, double exaggeration,
                       const CellRule& rule, TileFallbacks* fallbacks)
    : surface_(surface),
      tree_(surface.planet().tree()),
      camera_(camera),
      exaggeration_(exaggeration),
      highest_m_(camera.radius_m + exaggeration * (surface.planet().meta().highest_radius_m - camera.radius_m)),
      rule_(rule),
      fallbacks_(fallbacks),
      bounds_(tree_.size()),
      ends_(tree_.size()) {
  for (std::atomic<float>& bound : bounds_)
    bound.store(std::numeric_limits<float>::quiet_NaN(), std::memory_order_relaxed);
}

ColumnWalk::Angles ColumnWalk::angles(lod::TileTree::Index tile) const {
  const lod::TileKey& key = tree_[tile].key;
  const auto line = [&](std::int32_t k) { return mars::face_line(k, key.level); };
  const double u[2] = {line(key.i), line(key.i + 1)};
  const double v[2] = {line(key.j), line(key.j + 1)};
  // Bounds the tile by a cone.
  const glm::dvec3 axis = mars::chart_direction(key.face, 0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1]));
  double cosine = 1;
  for (double x : u) {
    for (double y : v) cosine = std::min(cosine, glm::dot(axis, mars::chart_direction(key.face, x, y)));
  }
  constexpr double kSlack = 1e-9;
  const double opening = std::acos(std::clamp(cosine, -1.0, 1.0)) + kSlack;
  const double angle = std::atan2(glm::length(glm::cross(camera_.up, axis)), glm::dot(camera_.up, axis));
  return {std::max(0.0, angle - opening), angle + opening};
}

float ColumnWalk::slope_bound(lod::TileTree::Index tile) const {
  const float known = bounds_[tile].load(std::memory_order_relaxed);
  if (!std::isnan(known)) return known;
  const Angles at = angles(tile);
  const double top = (camera_.radius_m + exaggeration_ * tree_[tile].max_height_m) * (1 + 1e-12);
  const double bound = steepest(top, camera_.distance_m, at.near, at.far);
  // Rounded upward, to stay a bound.
  const float rounded = std::nextafter(static_cast<float>(bound), std::numeric_limits<float>::infinity());
  bounds_[tile].store(rounded, std::memory_order_relaxed);
  return rounded;
}

// The posts lie in a part of a spherical layer, whose nearest point bounds their distance.
double ColumnWalk::least_distance_m(lod::TileTree::Index tile) const {
  const lod::TileInfo& info = tree_[tile];
  const double low = camera_.radius_m + exaggeration_ * info.min_height_m;
  const double high = camera_.radius_m + exaggeration_ * info.max_height_m;
  const double along = camera_.distance_m * std::cos(angles(tile).near);
  const double radius = std::clamp(along, low, high);
  return std::sqrt(
      std::max(0.0, camera_.distance_m * camera_.distance_m + radius * radius - 2 * radius * along));
}

double ColumnWalk::measured_error_m(lod::TileTree::Index tile) const {
  const lod::TileInfo& info = tree_[tile];
  if (!info.posts_terms.known()) return kUnbounded;
  return tree_.geometric_error_m(info, info.posts_terms.terms(), exaggeration_);
}

// What lies between two lines shows the voxel on the second one. A step from line to line is at most sqrt(2) cells long, and the
// tops of its voxels are those of posts half a cell aside, or of every second post.
double ColumnWalk::voxel_error_m(lod::TileTree::Index tile) const {
  if (!rule_.is_discrete) return 0;
  const double step_m = std::sqrt(2.0) * reach_m(tile);
  const double aside_m = blend_from_m(tile) > 0 ? step_m : reach_m(tile) / 2;
  return std::hypot(step_m, tree_.steepest_slope(tree_[tile], exaggeration_) * (step_m + 2 * aside_m));
}

double ColumnWalk::blend_from_m(lod::TileTree::Index tile) const {
  if (!rule_.blends || !(rule_.cell_px > 0)) return 0;
  return spacing_m(tile) * rule_.focal_px / rule_.cell_px;
}

double ColumnWalk::in_image_px(double geometric_error_m, lod::TileTree::Index tile) const {
  return geometric_error_m * rule_.focal_px / least_distance_m(tile);
}

lod::TileTree::Index ColumnWalk::parent(lod::TileTree::Index tile) const {
  return static_cast<lod::TileTree::Index>(tree_.find(lod::parent(tree_[tile].key)) - tree_.tiles().data());
}

bool ColumnWalk::is_fine(lod::TileTree::Index tile, lod::TileTree::Index posts_of) const {
  const lod::TileInfo& info = tree_[posts_of];
  double factor = 1;
  double cell_px = rule_.cell_px;
  if (rule_.control != nullptr) {
    const cull::BoundingRegion region = tree_.region(tile, exaggeration_, posts_error_m(posts_of));
    const lod::ControlTerms terms = lod::control_terms(
        *rule_.control, rule_.centre, {cull::bounding_hexahedron(region), region.rect, least_distance_m(tile)});
    if (rule_.control->metric == core::LodMetric::kDistance)
      return lod::level_count(info.key) >= lod::wanted_level_count(terms.sum);
    factor = std::exp2(lod::level_shift(terms.sum));
    cell_px *= lod::degrade_factor(*rule_.control, terms.degrade_weight);
  }
  if (info.posts_terms.known() && !rule_.is_discrete)
    return factor * in_image_px(measured_error_m(posts_of), tile) <= cell_px;
  return factor * spacing_m(posts_of) * rule_.focal_px <= cell_px * least_distance_m(tile);
}

// Level control is that of whole tiles, as --explain-lod states it. About the foot of a low camera lines are read in
// double (needs_exact()), for which the parent's posts, kept in floats, are not exact enough; grids there are nearer
// to the camera than this. A grid must have an even number of intervals.
bool ColumnWalk::takes_parents_posts(lod::TileTree::Index tile) const {
  const lod::TileKey& key = tree_[tile].key;
  if (key.level == 0 || rule_.is_discrete || rule_.control != nullptr) return false;
  const int n = tree_.shape().intervals();
  if (n / grids_per_side(key.level, n) < 2) return false;
  const lod::TileTree::Index above = parent(tile);
  const double exact_m = 2 * kExactLines * reach_m(above);
  const bool is_low = camera_.distance_m - camera_.ground_m < exact_m;
  return tree_[above].posts_terms.known() && !(is_low && least_distance_m(tile) <= exact_m) &&
         is_fine(tile, above) && (fallbacks_ == nullptr || !fallbacks_->prefers_children(above));
}

bool ColumnWalk::has_parents_posts(lod::TileTree::Index tile) const {
  return (ends_[tile].load(std::memory_order_relaxed) & kParentsPosts) != 0;
}

bool ColumnWalk::ends_at(lod::TileTree::Index tile) const {
  const lod::TileInfo& info = tree_[tile];
  if (!(rule_.cell_px > 0)) return !info.has_children;
  const unsigned known = ends_[tile].load(std::memory_order_relaxed);
  if ((known & kKnown) != 0) return (known & kYes) != 0;
  std::uint8_t found = kKnown;
  if (takes_parents_posts(tile)) {
    found |= kYes | kParentsPosts;
  } else if (!info.has_children ||
             (is_fine(tile, tile) && (fallbacks_ == nullptr || !fallbacks_->prefers_children(tile)))) {
    found |= kYes;
  }
  // Another thread may have found the tile there, or not, a moment before.
  std::uint8_t before = ends_[tile].load(std::memory_order_relaxed);
  while ((before & kKnown) == 0) {
    const auto after = static_cast<std::uint8_t>(before | found);
    if (ends_[tile].compare_exchange_weak(before, after, std::memory_order_relaxed)) return (found & kYes) != 0;
  }
  return (before & kYes) != 0;
}

lod::TileTree::Index ColumnWalk::below_camera() const {
  const mars::ChartPoint place = mars::chart_point(camera_.up);
  auto tile = static_cast<lod::TileTree::Index>(place.face);
  while (!ends_at(tile)) {
    const lod::TileKey& key = tree_[tile].key;
    const bool east = place.u >= middle_line(key.level, key.i);
    const bool north = place.v >= middle_line(key.level, key.j);
    tile = tree_.first_child(tile) + (east ? 1U : 0U) + (north ? 2U : 0U);
  }
  return has_parents_posts(tile) ? parent(tile) : tile;
}

double ColumnWalk::spacing_m(lod::TileTree::Index tile) const {
  return lod::nominal_side_m(tree_[tile].key.level, camera_.radius_m) / tree_.shape().intervals();
}

// Any place of a cell is at most a cell's side away from a post (half a diagonal from the nearest), and warped
// lines are up to sqrt(2) times the nominal spacing apart.
double ColumnWalk::reach_m(lod::TileTree::Index tile) const { return std::sqrt(2.0) * spacing_m(tile); }

double ColumnWalk::posts_error_m(lod::TileTree::Index tile) const {
  const lod::TileInfo& info = tree_[tile];
  if (!info.has_children) return 0;
  if (const double measured = measured_error_m(tile); std::isfinite(measured)) return measured;
  // The tile's posts lie on the reference surface. Neither the surface nor the facet is steeper than the
  // surface's steepest facet.
  const double reach = reach_m(tile);
  const double sagitta = reach * reach / (4 * camera_.radius_m);
  return 2 * exaggeration_ * info.steepest_slope * reach + sagitta + tree_.edge_shift_m(info, exaggeration_);
}

// A post that is moved to a limit of the tile's heights comes nearer to the reference surface. Between a post
// that was moved by up to the error and one that is off by up to the error, the facet is off by both at most.
// Nothing is farther off than the tile's own heights reach.
double ColumnWalk::fallback_error_m(lod::TileTree::Index tile, lod::TileTree::Index source) const {
  const lod::TileInfo& info = tree_[tile];
  const double reach = reach_m(tile);
  const double sagitta = reach * reach / (4 * camera_.radius_m);
  const double height_range = exaggeration_ * (info.max_height_m - info.min_height_m);
  double geometric_error_m = posts_error_m(source);
  // The facets of tiles wider than the knots' spacing are cut at other lines than the coarser tile's.
  const bool has_even_lines =
      grids_per_side(tree_[source].key.level, tree_.shape().intervals()) < tree_.shape().intervals();
  if (!has_even_lines) geometric_error_m = height_range;
  return std::min(2 * geometric_error_m, height_range + sagitta) + sagitta;
}

void ColumnWalk::mark_used(lod::TileTree::Index tile) const {
  if ((ends_[tile].load(std::memory_order_relaxed) & kUsed) == 0)
    ends_[tile].fetch_or(kUsed, std::memory_order_relaxed);
}

TileUsage ColumnWalk::usage() const {
  TileUsage usage;
  // Ground that is nowhere steeper than a slope is no nearer to a camera above it than this.
  const double clear_m =
      (camera_.distance_m - camera_.ground_m) / std::hypot(1.0, tree_.steepest_slope(exaggeration_));
  // Quarters count for the tile whose posts they are.
  std::map<lod::TileTree::Index, double> least_m;
  for (lod::TileTree::Index tile = 0; tile < tree_.size(); ++tile) {
    if ((ends_[tile].load(std::memory_order_relaxed) & kUsed) == 0) continue;
    const double distance_m = least_distance_m(tile);
    const auto [at, is_new] = least_m.try_emplace(has_parents_posts(tile) ? parent(tile) : tile, distance_m);
    if (!is_new) at->second = std::min(at->second, distance_m);
  }
  for (const auto& [tile, nearest_m] : least_m) {
    const lod::TileTree::Index source = fallbacks_ != nullptr ? fallbacks_->source_of(tile) : tile;
    TileUse use{tile, source, nearest_m};
    use.geometric_error_m =
        (source == tile ? posts_error_m(tile) : fallback_error_m(tile, source)) + voxel_error_m(source);
    if (use.geometric_error_m != 0) {
      // Voxels are never exact, also about a camera that is lower than the tile's highest ground.
      const double distance_m =
          rule_.is_discrete && source == tile ? std::max(use.min_distance_m, clear_m) : use.min_distance_m;
      use.screen_space_error_px = use.geometric_error_m * rule_.focal_px / distance_m;
    }
    usage.tiles.push_back(use);
    usage.steepest_slope = std::max(usage.steepest_slope, tree_.steepest_slope(tree_[source], exaggeration_));
  }
  update_totals(tree_, usage);
  return usage;
}

}  // namespace vpe::voxel
