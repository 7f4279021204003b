#include "paging/plan/build_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

namespace paging {

bool morton_less(const lod::TileKey& a, const lod::TileKey& b) {
  const std::int64_t pa = lod::morton_position(a);
  const std::int64_t pb = lod::morton_position(b);
  return pa != pb ? pa < pb : a.level < b.level;
}

BuildPlan::BuildPlan(const lod::TileShape& shape, double radius_m, const WantedSpacing& wanted,
                     const PlanLimits& limits) {
  std::vector<lod::TileKey> open;
  for (int f = 0; f < mars::kFaces; ++f) open.push_back({static_cast<mars::Face>(f), 0, 0, 0});
  while (!open.empty()) {
    const lod::TileKey key = open.back();
    open.pop_back();
    const double spacing = lod::post_spacing_m(key.level, shape.intervals(), radius_m);
    const double wanted_m = wanted(key, lod::bounding_cap(key));
    if (!(spacing > wanted_m)) continue;
    if (key.level >= limits.max_level || 3 * inner_set_.size() > limits.max_leaves) {
      throw std::runtime_error("a post spacing of " + std::to_string(wanted_m) +
                               " m needs more tiles than a planet file may have (" +
                               std::to_string(limits.max_leaves) +
                               "); ask for a coarser --spacing or a smaller --region");
    }
    split(key);
    for (int c = 0; c < 4; ++c) open.push_back(lod::child(key, c));
  }
  balance();
  for (const lod::TileKey& key : inner_set_) {
    inner_.push_back(key);
    for (int c = 0; c < 4; ++c) {
      const lod::TileKey child = lod::child(key, c);
      if (!is_inner(child)) leaves_.push_back(child);
    }
  }
  for (int f = 0; f < mars::kFaces; ++f) {
    const lod::TileKey root{static_cast<mars::Face>(f), 0, 0, 0};
    if (!is_inner(root)) leaves_.push_back(root);
  }
  sort();
}

BuildPlan::BuildPlan(std::vector<lod::TileKey> leaves) : leaves_(std::move(leaves)) {
  for (const lod::TileKey& leaf : leaves_) {
    for (lod::TileKey key = leaf; key.level > 0;) {
      key = lod::parent(key);
      if (!inner_set_.insert(key).second) break;
    }
  }
  inner_.assign(inner_set_.begin(), inner_set_.end());
  sort();
  for (std::size_t n = 0; n <= leaves_.size(); ++n) {
    // In Morton order, each begins where the one before it ends.
    const auto begin_of = [&](std::size_t at) {
      return at < leaves_.size() ? lod::morton_position(leaves_[at])
                                 : lod::morton_position({mars::Face::kMinusZ, 0, 0, 0}) + lod::morton_extent(0);
    };
    const std::int64_t end =
        n == 0 ? 0 : lod::morton_position(leaves_[n - 1]) + lod::morton_extent(leaves_[n - 1].level);
    if (begin_of(n) == end) continue;
    throw std::runtime_error(
        "finest tiles do not exist or exist twice " +
        (n == 0 ? std::string("at the start") : "after " + lod::to_string(leaves_[n - 1])));
  }
}

BuildPlan::BuildPlan(const BuildPlan& coarser, std::span<const lod::TileKey> divided)
    : inner_set_(coarser.inner_set_), inner_(coarser.inner_) {
  for (const lod::TileKey& key : divided) split(key);
  balance();
  for (const lod::TileKey& leaf : coarser.leaves_) {
    std::vector<lod::TileKey> open{leaf};
    while (!open.empty()) {
      const lod::TileKey key = open.back();
      open.pop_back();
      (is_inner(key) ? inner_ : leaves_).push_back(key);
      for (int c = 0; c < 4 && is_inner(key); ++c) open.push_back(lod::child(key, c));
    }
  }
  sort();
}

void BuildPlan::sort() {
  for (const lod::TileKey& key : leaves_) finest_level_ = std::max(finest_level_, key.level);
  std::sort(leaves_.begin(), leaves_.end(), morton_less);
  std::sort(inner_.begin(), inner_.end(), [](const lod::TileKey& a, const lod::TileKey& b) {
    return a.level != b.level ? a.level > b.level : morton_less(a, b);
  });
}

void BuildPlan::split(const lod::TileKey& key) {
  if (!inner_set_.insert(key).second) return;
  pending_.push_back(key);
  if (key.level > 0) split(lod::parent(key));
}

void BuildPlan::balance() {
  // The children of an inner tile may only meet finest tiles of its own level or deeper: its neighbours
  // of its own level must exist.
  while (!pending_.empty()) {
    const lod::TileKey key = pending_.back();
    pending_.pop_back();
    if (key.level == 0) continue;
    for (const lod::Edge edge : lod::kEdges) split(lod::parent(lod::neighbour(key, edge).key));
  }
}

int BuildPlan::leaf_level(const mars::ChartPoint& point) const {
  int level = 0;
  while (is_inner(lod::tile_at(point, level))) ++level;
  return level;
}

int BuildPlan::coarsest_level_at_corner(const lod::TileKey& key, bool east, bool north) const {
  const mars::ChartRect rect = lod::chart_rect(key);
  // A thousandth of a tile to each side lies well inside whatever touches the corner.
  return coarsest_level_about(rect.face, east ? rect.u1 : rect.u0, north ? rect.v1 : rect.v0,
                              (rect.u1 - rect.u0) * 1e-3, (rect.v1 - rect.v0) * 1e-3);
}

int BuildPlan::coarsest_level_at(mars::Face face, double u, double v) const {
  const double aside = std::ldexp(1e-3, -finest_level_);
  return coarsest_level_about(face, u, v, aside, aside);
}

int BuildPlan::coarsest_level_about(mars::Face face, double u, double v, double du, double dv) const {
  int level = lod::kMaxLevel;
  for (const auto& [su, sv] : {std::array{-1.0, -1.0}, {1.0, -1.0}, {-1.0, 1.0}, {1.0, 1.0}}) {
    const mars::ChartPoint near = mars::chart_point(mars::cube_point(face, u + su * du, v + sv * dv));
    level = std::min(level, leaf_level(near));
  }
  return level;
}

int BuildPlan::edge_step(const lod::TileKey& leaf, lod::Edge edge) const {
  if (leaf.level == 0) return 0;
  return exists(lod::neighbour(leaf, edge).key) ? 0 : 1;
}

}  // namespace paging
