#include "lod/select.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "cull/horizon.h"
#include "vpe/base/mutation.h"

namespace lod {

using vpe::base::Guard;
using vpe::base::mutated;

namespace {

// Errors are weighed by their ratio to the tolerance, of which 0 has none.
constexpr double kLeastTolerance_px = 1.0 / 64;

void check(const SelectOptions& options, const SelectView& view) {
  if (!std::isfinite(view.camera_m.x) || !std::isfinite(view.camera_m.y) || !std::isfinite(view.camera_m.z)) {
    throw std::invalid_argument("select: the camera's position is not finite");
  }
  if (!std::isfinite(view.focal_px) || view.focal_px <= 0.0) {
    throw std::invalid_argument("select: the focal length is not a positive number of pixels");
  }
  if (std::isnan(options.tolerance_px) || options.tolerance_px < 0.0) {
    throw std::invalid_argument("select: the tolerance is not a number of pixels >= 0");
  }
  if (std::isnan(options.child_tolerance_px) || options.child_tolerance_px < 0.0) {
    throw std::invalid_argument("select: the tolerance of children is not a number of pixels >= 0");
  }
  if (!std::isfinite(options.exaggeration) || options.exaggeration <= 0.0) {
    throw std::invalid_argument("select: the exaggeration is not a positive number");
  }
  if (options.max_triangles < 0) throw std::invalid_argument("select: the number of triangles is negative");
  check(options.control);
}

double screen_space_error(double geometric_error_m, double focal_px, double distance_m,
                          double off_axis_magnification) {
  if (geometric_error_m == 0.0) return 0.0;
  return distance_m > 0.0 ? off_axis_magnification * (geometric_error_m * focal_px / distance_m)
                          : std::numeric_limits<double>::infinity();
}

}  // namespace

SelectView select_view(const vpe::core::View& view) {
  const bool perspective = view.projection == vpe::core::Projection::kPerspective;
  return {view.camera.position_m,
          perspective ? vpe::core::focal_px(view) : view.width / (2.0 * std::numbers::pi),
          cull::make_frustum(view), image_plane(view), centre_of_view(view)};
}

class Selector {
 public:
  Selector(const SelectOptions& options, const TileTree& tree, const SelectView& view, SelectScratch& scratch,
           Selection& out)
      : options_(options),
        tree_(tree),
        view_(view),
        camera_(cull::make_camera(view.camera_m)),
        horizon_(cull::make_horizon(camera_, mutated(Guard::kLowestOccluder)
                                                 ? tree.radius_m()
                                                 : tree.lowest_radius_m(options.exaggeration))),
        heap_(scratch.heap_),
        out_(out),
        by_distance_(options.control.metric == vpe::core::LodMetric::kDistance),
        controlled_(!is_neutral(options.control)),
        accepted_urgency_(by_distance_ ? 0.0 : options.tolerance_px),
        full_tolerance_px_(std::max(options.tolerance_px / options.control.coarsening, kLeastTolerance_px)) {}

  void run() {
    heap_.clear();
    reset();
    Replacement replacement;
    for (TileTree::Index root = 0; root < mars::kFaces; ++root)
      visit(root, cull::all_planes(view_.frustum), std::numeric_limits<double>::infinity(), replacement);
    commit(replacement);
    while (!heap_.empty() && refine_worst()) {
    }
    for (const Candidate& rest : heap_) draw(rest);
    finish();
  }

  bool may_be_seen(TileTree::Index index) const {
    Replacement replacement;
    visit(index, cull::all_planes(view_.frustum), std::numeric_limits<double>::infinity(), replacement);
    return replacement.size > 0;
  }

  SelectedTile measured(TileTree::Index index, int variant) const {
    Candidate c{};
    c.index = index;
    c.variant = variant;
    c.geometric_error_m = geometric_error_m(tree_[index], variant);
    const cull::BoundingRegion region = tree_.region(index, options_.exaggeration, c.geometric_error_m);
    c.chord2 = cull::nearest_chord2(region.rect, camera_.direction);
    c.off_axis_magnification = sky_magnification(region, cull::bounding_hexahedron(region));
    measure(c, region);
    return tile_of(c);
  }

 private:
  using Candidate = SelectScratch::Candidate;

  // The tiles that replace a tile, with the counts of visiting them.
  struct Replacement {
    std::array<Candidate, mars::kFaces> members;
    std::size_t size = 0;
    std::int64_t triangles = 0;
    int visited = 0;
    int culled_frustum = 0;
    int culled_horizon = 0;
  };

  static bool less_urgent(const Candidate& a, const Candidate& b) {
    if (a.urgency != b.urgency) return a.urgency < b.urgency;
    return a.screen_space_error_px != b.screen_space_error_px
               ? a.screen_space_error_px < b.screen_space_error_px
               : a.index > b.index;
  }

  void reset() {
    out_.tiles.clear();
    out_.tiles_by_level.clear();
    out_.exaggeration = options_.exaggeration;
    out_.visited = out_.culled_frustum = out_.culled_horizon = out_.refined = 0;
    out_.triangles = 0;
    out_.max_geometric_error_m = out_.max_screen_space_error_px = 0.0;
    out_.capped = false;
  }

  std::uint32_t triangles(const Candidate& c) const {
    return tree_[c.index].variants[static_cast<std::size_t>(c.variant)].triangles;
  }

  double geometric_error_m(const TileInfo& tile, int variant) const {
    if (is_full_grid(tile, variant)) return 0.0;
    return tree_.geometric_error_m(tile, tile.variants[static_cast<std::size_t>(variant)].terms,
                                   options_.exaggeration);
  }

  // Returns the screen-space error that counts, or with the metric kDistance the number of levels that the tile
  // lacks.
  double urgency(const Candidate& c) const {
    if (!controlled_) return c.screen_space_error_px;
    if (!by_distance_) return weighed(c.screen_space_error_px * std::exp2(c.control), c.degrade_weight);
    const TileInfo& tile = tree_[c.index];
    const double lacks = c.control - level_count(tile.key, c.variant, static_cast<int>(tile.variants.size()));
    return lacks > 0.0 && c.degrade_weight != 1.0 ? lacks / c.degrade_weight : lacks;
  }

  // Returns the error of weight 1 that takes as large a budget: both are a tolerance times the same factor, to the
  // power of their weights. So one order serves all weights, under a limit of triangles and under a coarsening.
  double weighed(double tile_px, double weight) const {
    if (weight == 1.0 || !(tile_px > full_tolerance_px_)) return tile_px;
    if (weight == 0.0) return std::numeric_limits<double>::infinity();
    return full_tolerance_px_ * std::pow(tile_px / full_tolerance_px_, 1.0 / weight);
  }

  void measure(Candidate& c, const cull::BoundingRegion& region) const {
    c.min_distance_m = cull::min_distance_m(camera_, c.chord2, region.min_radius_m, region.max_radius_m);
    c.screen_space_error_px =
        screen_space_error(c.geometric_error_m, view_.focal_px, c.min_distance_m, c.off_axis_magnification);
    c.urgency = urgency(c);
  }

  double sky_magnification(const cull::BoundingRegion& region, const cull::BoundingHexahedron& volume) const {
    const bool may_be_against_sky =
        view_.plane.flat &&
        cull::against_sky(camera_, horizon_, cull::farthest_chord2(region.rect, camera_.direction),
                          region.max_radius_m);
    return may_be_against_sky ? off_axis_magnification(view_.plane, volume) : 1.0;
  }

  // Visits a tile. `mask` and `most_magnification` are bounds of the parent, which hold for its children too.
  void visit(TileTree::Index index, cull::PlaneMask mask, double most_magnification,
             Replacement& replacement) const {
    const TileInfo& tile = tree_[index];
    Candidate c{};
    c.index = index;
    c.geometric_error_m = geometric_error_m(tile, 0);
    const cull::BoundingRegion region = tree_.region(index, options_.exaggeration, c.geometric_error_m);
    ++replacement.visited;
    c.chord2 = cull::nearest_chord2(region.rect, camera_.direction);
    if (options_.cull_horizon && cull::hidden(horizon_, c.chord2, region.max_radius_m)) {
      ++replacement.culled_horizon;
      return;
    }
    const cull::BoundingHexahedron volume = cull::bounding_hexahedron(region);
    if (mask != 0) {
      const auto crossed = cull::planes_crossed(view_.frustum, volume, mask);
      if (!crossed) {
        ++replacement.culled_frustum;
        return;
      }
      mask = *crossed;
    }
    c.mask = mask;
    c.off_axis_magnification = std::min(most_magnification, sky_magnification(region, volume));
    measure(c, region);
    if (controlled_) {
      const ControlTerms terms =
          control_terms(options_.control, view_.centre, {volume, region.rect, c.min_distance_m});
      c.control = by_distance_ ? wanted_level_count(terms.sum) : lod::level_shift(terms.sum);
      c.degrade_weight = terms.degrade_weight;
      c.urgency = urgency(c);
    }
    replacement.triangles += triangles(c);
    replacement.members[replacement.size++] = c;
  }

  void commit(const Replacement& replacement) {
    out_.visited += replacement.visited;
    out_.culled_frustum += replacement.culled_frustum;
    out_.culled_horizon += replacement.culled_horizon;
    out_.triangles += replacement.triangles;
    for (std::size_t n = 0; n < replacement.size; ++n) {
      const Candidate& c = replacement.members[n];
      if (is_full_grid(tree_[c.index], c.variant) ||
          (!(c.urgency > accepted_urgency_) && may_replace_children(c))) {
        draw(c);
      } else {
        heap_.push_back(c);
        std::push_heap(heap_.begin(), heap_.end(), less_urgent);
      }
    }
  }

  // See SelectOptions::child_tolerance_px.
  bool may_replace_children(const Candidate& c) const {
    if (by_distance_ || !(c.urgency > options_.child_tolerance_px) || !tree_[c.index].has_children) return true;
    Replacement children;
    const TileTree::Index first = tree_.first_child(c.index);
    for (TileTree::Index child = first; child < first + 4; ++child)
      visit(child, c.mask, c.off_axis_magnification, children);
    return std::none_of(children.members.begin(),
                        children.members.begin() + static_cast<std::ptrdiff_t>(children.size),
                        [&](const Candidate& child) { return child.urgency > options_.child_tolerance_px; });
  }

  bool refine_worst() {
    const Candidate worst = heap_.front();
    const TileInfo& tile = tree_[worst.index];
    Replacement replacement;
    if (tile.has_children) {
      const TileTree::Index first = tree_.first_child(worst.index);
      for (TileTree::Index c = first; c < first + 4; ++c)
        visit(c, worst.mask, worst.off_axis_magnification, replacement);
    } else {
      Candidate& next = replacement.members[replacement.size++];
      next = worst;
      ++next.variant;
      next.geometric_error_m = geometric_error_m(tile, next.variant);
      measure(next, tree_.region(worst.index, options_.exaggeration, next.geometric_error_m));
      replacement.triangles = triangles(next);
    }
    replacement.triangles -= triangles(worst);
    if (options_.max_triangles > 0 && out_.triangles + replacement.triangles > options_.max_triangles) {
      out_.capped = true;
      return false;
    }
    std::pop_heap(heap_.begin(), heap_.end(), less_urgent);
    heap_.pop_back();
    out_.refined += tile.has_children ? 1 : 0;
    commit(replacement);
    return true;
  }

  SelectedTile tile_of(const Candidate& c) const {
    return {tree_[c.index].key,
            c.index,
            c.variant,
            c.geometric_error_m,
            c.screen_space_error_px,
            c.min_distance_m,
            c.off_axis_magnification,
            c.control};
  }
  void draw(const Candidate& c) { out_.tiles.push_back(tile_of(c)); }

  void finish() {
    std::sort(out_.tiles.begin(), out_.tiles.end(),
              [](const auto& a, const auto& b) { return morton_position(a.key) < morton_position(b.key); });
    update_totals(tree_, out_);
  }

  const SelectOptions& options_;
  const TileTree& tree_;
  const SelectView& view_;
  cull::Camera camera_;
  cull::Horizon horizon_;
  std::vector<Candidate>& heap_;
  Selection& out_;
  bool by_distance_;
  bool controlled_;
  double accepted_urgency_;   // urgency up to which a tile is not refined
  double full_tolerance_px_;  // before coarsening
};

void select(const SelectOptions& options, const TileTree& tree, const SelectView& view, SelectScratch& scratch,
            Selection& selection) {
  check(options, view);
  Selector(options, tree, view, scratch, selection).run();
}

SelectedTile measure_tile(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                          TileTree::Index index, int variant) {
  SelectScratch scratch;
  Selection unused;
  return Selector(options, tree, view, scratch, unused).measured(index, variant);
}

bool may_be_seen(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                 TileTree::Index index) {
  SelectScratch scratch;
  Selection unused;
  return Selector(options, tree, view, scratch, unused).may_be_seen(index);
}

void update_totals(const TileTree& tree, Selection& selection) {
  selection.triangles = 0;
  selection.max_geometric_error_m = selection.max_screen_space_error_px = 0.0;
  selection.tiles_by_level.clear();
  for (const SelectedTile& tile : selection.tiles) {
    selection.triangles += tree[tile.index].variants[static_cast<std::size_t>(tile.variant)].triangles;
    selection.max_geometric_error_m = std::max(selection.max_geometric_error_m, tile.geometric_error_m);
    selection.max_screen_space_error_px =
        std::max(selection.max_screen_space_error_px, tile.screen_space_error_px);
    const auto level = static_cast<std::size_t>(tile.key.level);
    if (selection.tiles_by_level.size() <= level) selection.tiles_by_level.resize(level + 1);
    ++selection.tiles_by_level[level];
  }
}

}  // namespace lod
