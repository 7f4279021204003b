#include "lod/tree/tree.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vpe/base/mutation.h"
#include "vpe/base/number.h"

namespace lod {

using vpe::base::Guard;
using vpe::base::mutated;

namespace {

[[noreturn]] void refuse(const TileKey& key, const std::string& trouble) {
  throw std::runtime_error("tile " + to_string(key) + ": " + trouble);
}

bool grows(const ErrorTerms& from, const ErrorTerms& to) {
  if (mutated(Guard::kErrorsNest)) return false;
  return !(to.height_error_m <= from.height_error_m && to.sagitta_m <= from.sagitta_m &&
           to.total_m <= from.total_m);
}

void check(const TileInfo& tile, double radius_m) {
  if (!std::isfinite(tile.min_height_m) || !std::isfinite(tile.max_height_m))
    refuse(tile.key, "heights not finite");
  if (tile.min_height_m > tile.max_height_m) refuse(tile.key, "lowest height above the highest");
  if (tile.min_height_m <= -radius_m) refuse(tile.key, "lowest height below the planet's centre");
  if (!std::isfinite(tile.steepest_slope) || tile.steepest_slope < 0.0)
    refuse(tile.key, "slope not finite or negative");
  if (tile.variants.empty()) refuse(tile.key, "no mesh");
  if (tile.has_children && tile.variants.size() != 1) refuse(tile.key, "more than one mesh above children");
  for (const MeshVariant& variant : tile.variants) {
    for (const double term : {variant.terms.height_error_m, variant.terms.sagitta_m, variant.terms.total_m}) {
      if (!std::isfinite(term) || term < 0.0) refuse(tile.key, "error not finite or negative");
    }
  }
  for (std::size_t v = 1; v < tile.variants.size(); ++v) {
    if (grows(tile.variants[v - 1].terms, tile.variants[v].terms))
      refuse(tile.key, "error grows with finer meshes");
  }
  if (const ErrorTerms posts = tile.posts_terms.terms(); tile.posts_terms.known()) {
    if (!tile.has_children) refuse(tile.key, "finest tile whose posts have an error");
    if (grows(posts, posts) || grows(posts, {}) || !std::isfinite(posts.total_m))
      refuse(tile.key, "error of its posts not finite or negative");
  }
  if (!tile.has_children && grows({}, tile.variants.back().terms)) {
    refuse(tile.key, "finest tile whose last mesh has an error");
  }
}

void check(const TileInfo& tile, const TileInfo& child) {
  if (child.min_height_m < tile.min_height_m || child.max_height_m > tile.max_height_m) {
    refuse(child.key, "heights beyond its parent's");
  }
  if (child.steepest_slope > tile.steepest_slope) refuse(child.key, "slope steeper than its parent's");
  if (grows(tile.variants.back().terms, child.variants.front().terms)) {
    refuse(child.key, "error larger than its parent's");
  }
  if (tile.posts_terms.known() && child.posts_terms.known() &&
      grows(tile.posts_terms.terms(), child.posts_terms.terms()))
    refuse(child.key, "error of its posts larger than of its parent's");
}

bool before(const TileKey& a, const TileKey& b) {
  return a.level != b.level ? a.level < b.level : morton_position(a) < morton_position(b);
}

// Returns a factor f such that a flat facet over posts of radius >= r stays above f r: a lower bound of the
// cosine of the half-width of the widest cell of a level.
double facet_factor(int level, const TileShape& shape) {
  if (mutated(Guard::kFacetSagitta)) return 1.0;
  const double half_width = kCapPerSide * nominal_side_m(level + shape.k, 1.0);
  return 1.0 - 0.5 * half_width * half_width;
}

}  // namespace

TileTree::TileTree(std::vector<TileInfo> tiles, const TileShape& shape, double radius_m, double lowest_radius_m)
    : tiles_(std::move(tiles)), shape_(shape), radius_m_(radius_m), known_lowest_m_(lowest_radius_m) {
  if (!std::isfinite(radius_m) || radius_m <= 0.0) throw std::runtime_error("planet radius is not positive");
  if (tiles_.size() >= static_cast<Index>(-1)) throw std::runtime_error("too many tiles");
  for (const TileInfo& tile : tiles_) {
    if (!is_valid(tile.key)) refuse(tile.key, "no such tile");
    check(tile, radius_m);
  }
  std::sort(tiles_.begin(), tiles_.end(), [](const auto& a, const auto& b) { return before(a.key, b.key); });
  tiles_.shrink_to_fit();
  first_child_.resize(tiles_.size());

  // Parents have the order of their children, so one pass finds every missing and every stray tile.
  std::size_t next = 0;
  const auto refuse_stray = [&] {
    const bool twice = next > 0 && tiles_[next].key == tiles_[next - 1].key;
    refuse(tiles_[next].key, twice ? "there twice" : "child of no tile that has children");
  };
  const auto expect = [&](const TileKey& key) {
    if (next < tiles_.size() && before(tiles_[next].key, key)) refuse_stray();
    if (next == tiles_.size() || tiles_[next].key != key) refuse(key, "missing");
    ++next;
  };
  for (int face = 0; face < mars::kFaces; ++face) expect({static_cast<mars::Face>(face), 0, 0, 0});
  lowest_height_m_ = tiles_[0].min_height_m;
  for (std::size_t n = 0; n < next; ++n) {
    const TileInfo& tile = tiles_[n];
    lowest_height_m_ = std::min(lowest_height_m_, tile.min_height_m);
    if (!tile.has_children) {
      coarsest_facets_ = std::min(coarsest_facets_, tile.key.level);
      finest_facets_ = std::max(finest_facets_, tile.key.level);
      continue;
    }
    first_child_[n] = static_cast<Index>(next);
    for (int c = 0; c < 4; ++c) {
      expect(child(tile.key, c));
      check(tile, tiles_[next - 1]);
    }
  }
  if (next < tiles_.size()) refuse_stray();
  bytes_ = sizeof(*this) + tiles_.capacity() * sizeof(TileInfo) + first_child_.capacity() * sizeof(Index);
  for (const TileInfo& tile : tiles_)
    bytes_ += tile.variants.capacity() * sizeof(MeshVariant) + 2 * sizeof(void*);
}

TileTree::Index TileTree::descend(const TileKey& key) const {
  auto tile = static_cast<Index>(key.face);
  for (int level = 1; level <= key.level && tiles_[tile].has_children; ++level) {
    const int shift = key.level - level;
    const auto c = static_cast<Index>(((key.i >> shift) & 1) + 2 * ((key.j >> shift) & 1));
    tile = first_child_[tile] + c;
  }
  return tile;
}

const TileInfo* TileTree::find(const TileKey& key) const {
  if (!is_valid(key)) return nullptr;
  const TileInfo& tile = tiles_[descend(key)];
  return tile.key.level == key.level ? &tile : nullptr;
}

const TileInfo& TileTree::deepest(const TileKey& key) const { return tiles_[descend(key)]; }

cull::BoundingRegion TileTree::region(Index tile, double exaggeration, double geometric_error_m) const {
  const TileInfo& info = tiles_[tile];
  const double facets = facet_factor(info.has_children ? info.key.level + 1 : info.key.level, shape_);
  // At another exaggeration posts on a coarser neighbour's edge stay on it: below its ends by that edge's
  // sagitta.
  const auto finer = exaggeration == 1.0 ? std::nullopt : coarsest_beside_coarser(info);
  const double edges = finer ? facet_factor(*finer - 1, shape_) : 1.0;
  const double lowest = (radius_m_ + exaggeration * info.min_height_m) * edges * facets - geometric_error_m;
  return {chart_rect(info.key), std::max(0.0, lowest),
          std::max(0.0, radius_m_ + exaggeration * info.max_height_m)};
}

double TileTree::lowest_radius_m(double exaggeration) const {
  const double lowest =
      std::max(0.0, radius_m_ + exaggeration * lowest_height_m_) * facet_factor(coarsest_facets_, shape_);
  if (exaggeration == 1.0) return std::max(lowest, known_lowest_m_);
  return finest_facets_ > coarsest_facets_ ? lowest * facet_factor(coarsest_facets_ + 1, shape_) : lowest;
}

std::optional<int> TileTree::coarsest_beside_coarser(const TileInfo& tile) const {
  const int level = std::max(tile.has_children ? tile.key.level + 1 : tile.key.level, coarsest_facets_ + 1);
  if (level > finest_facets_) return std::nullopt;
  return level;
}

double TileTree::geometric_error_m(const TileInfo& tile, const ErrorTerms& terms, double exaggeration) const {
  return error_bound(terms, exaggeration, tile.min_height_m, tile.max_height_m, radius_m_) +
         edge_shift_m(tile, exaggeration);
}

double TileTree::steepest_slope(const TileInfo& tile, double exaggeration) const {
  const double lowest_m = radius_m_ + exaggeration * tile.min_height_m;
  if (!(lowest_m > 0)) return std::numeric_limits<double>::infinity();
  const double ground = exaggeration * tile.steepest_slope * (radius_m_ + tile.max_height_m) / lowest_m;
  if (tile.has_children) return ground;
  // Lines of posts are nowhere nearer to each other than half the nominal spacing.
  const double least_m = 0.5 * nominal_side_m(tile.key.level, radius_m_) / shape_.intervals();
  return ground + edge_shift_m(tile, exaggeration) / least_m;
}

double TileTree::steepest_slope(double exaggeration) const {
  double steepest = 0;
  for (const TileInfo& tile : tiles_) {
    if (tile.has_children && exaggeration != 1.0) continue;  // its finest tiles add edge_shift_m()
    steepest = std::max(steepest, steepest_slope(tile, exaggeration));
    if (exaggeration == 1.0 && tile.key.level > 0) break;  // slopes do not grow below the roots
  }
  return steepest;
}

double TileTree::exaggeration_limit() const {
  double lowest_m = 0;
  for (const TileInfo& tile : tiles_) {
    if (tile.key.level > 0) break;
    lowest_m = std::min(lowest_m, tile.min_height_m);
  }
  return lowest_m < 0 ? radius_m_ / -lowest_m : std::numeric_limits<double>::infinity();
}

void TileTree::require_drawable(double exaggeration) const {
  const double limit = exaggeration_limit();
  if (exaggeration < limit) return;
  throw std::invalid_argument("an exaggeration of " + vpe::base::format_general(exaggeration, 6) +
                              " takes the lowest ground to the planet's centre; it must be less than " +
                              vpe::base::format_general(limit, 6));
}

// On an edge between posts of radius R + x h the radius is r(x) = 1 / sum(m / (R + x h)). A post kept on the
// edge is at r(x), a post exaggerated by itself at R + x (r(1) - R). They agree at x = 1 and differ by the
// edge's sagitta at x = 0; elsewhere they differ by the line through both and a second order that error_bound()
// has too. A facet moves by at most the movement of its posts times the squared ratio of their radii.
double TileTree::edge_shift_m(const TileInfo& tile, double exaggeration) const {
  if (exaggeration == 1.0) return 0.0;
  const std::optional<int> level = coarsest_beside_coarser(tile);
  if (!level) return 0.0;
  const double factor = facet_factor(*level - 1, shape_);
  const double sagitta_m = radius_m_ * (1.0 - factor);
  const double edge_m =
      2 * kCapPerSide * nominal_side_m(*level - 1 + shape_.k, 1.0) * (radius_m_ + tile.max_height_m);
  const double range_m = std::min(tile.max_height_m - tile.min_height_m, tile.steepest_slope * edge_m);
  const double post_m =
      std::abs(exaggeration - 1.0) * sagitta_m +
      second_order_bound(exaggeration, range_m, tile.min_height_m, tile.max_height_m, radius_m_);
  const double lowest = std::min(radius_m_ + tile.min_height_m, radius_m_ + exaggeration * tile.min_height_m);
  if (!(lowest > 0.0)) return std::numeric_limits<double>::infinity();
  const double highest = std::max(radius_m_ + tile.max_height_m, radius_m_ + exaggeration * tile.max_height_m);
  const double ratio = highest / (lowest * factor);
  return post_m * ratio * ratio;
}

}  // namespace lod
