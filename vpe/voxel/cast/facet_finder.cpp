#include "vpe/voxel/cast/facet_finder.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/cube.h"

namespace vpe::voxel {

namespace {

bool near(double x, int intervals) { return x > -kExactLines && x < intervals + kExactLines; }

}  // namespace

bool FacetFinder::Found::holds(const mars::ChartPoint& place) const {
  return place.face == facets.face && place.u >= u0 && place.u <= u1 && place.v >= v0 && place.v <= v1;
}

const Facets& FacetFinder::at(const glm::dvec3& place_m) {
  const mars::ChartPoint place = mars::chart_point(place_m);
  if (last_ < found_.size() && found_[last_].holds(place)) return found_[last_].facets;
  for (std::size_t k = 0; k < found_.size(); ++k) {
    if (!found_[k].holds(place)) continue;
    last_ = k;
    return found_[k].facets;
  }
  last_ = oldest_;
  if (found_.size() < kKept) {
    found_.emplace_back();
    last_ = found_.size() - 1;
  } else {
    oldest_ = (oldest_ + 1) % kKept;
  }
  // Without a grid of its own, should the next line throw.
  found_[last_] = {};
  find(place, found_[last_]);
  return found_[last_].facets;
}

void FacetFinder::find(const mars::ChartPoint& place, Found& found) {
  const lod::TileTree& tree = walk_.tree();
  Facets& facets = found.facets;
  auto tile = static_cast<lod::TileTree::Index>(place.face);
  // The current cell is (i, j) of 2^level along a side.
  double u0 = -1;
  double u1 = 1;
  double v0 = -1;
  double v1 = 1;
  int level = 0;
  std::int32_t i = 0;
  std::int32_t j = 0;
  const auto halve = [&] {
    const double u = walk_.middle_line(level, i);
    const double v = walk_.middle_line(level, j);
    const bool east = place.u >= u;
    const bool north = place.v >= v;
    (east ? u0 : u1) = u;
    (north ? v0 : v1) = v;
    i = 2 * i + (east ? 1 : 0);
    j = 2 * j + (north ? 1 : 0);
    ++level;
    return (east ? 1U : 0U) + (north ? 2U : 0U);
  };
  lod::TileTree::Index parent = tile;
  while (!walk_.ends_at(tile)) {
    parent = tile;
    tile = tree.first_child(tile) + halve();
  }
  walk_.mark_used(tile);
  const lod::TileTree::Index posts_of = walk_.has_parents_posts(tile) ? parent : tile;
  const lod::TileKey& key = tree[tile].key;
  const int per_side = grids_per_side(key.level, tree.shape().intervals());
  for (int k = 1; k < per_side; k *= 2) halve();
  i -= key.i * per_side;
  j -= key.j * per_side;
  facets.id = (std::uint64_t{tile} << 16) + static_cast<std::uint64_t>(j * per_side + i);
  facets.face = place.face;
  HeightGridFrame& f = facets.frame;
  f.intervals = walk_.intervals(tile) / per_side;
  f.u0 = u0;
  f.du = (u1 - u0) / f.intervals;
  f.v0 = v0;
  f.dv = (v1 - v0) / f.intervals;
  const mars::FaceAxes& axes = mars::face_axes(place.face);
  const double z = glm::dot(walk_.camera().up, axes.out);
  const bool exact = z > 0 && needs_exact(f, walk_.camera()) &&
                     near((glm::dot(walk_.camera().up, axes.right) / z - f.u0) / f.du, f.intervals) &&
                     near((glm::dot(walk_.camera().up, axes.up) / z - f.v0) / f.dv, f.intervals);
  facets.exact_lines = nullptr;
  if (exact) {
    facets.family = LineFamily::kColumns;
    found.exact_held = tiles_.exact_grids(tile, posts_of, facets.family);
    facets.exact_lines = &found.exact_held->lines(i, j);
  } else {
    found.held = tiles_.any_grids(tile, posts_of);
    facets.family = found.held->family();
    facets.lines = &found.held->lines(i, j);
  }
  found.u0 = u0;
  found.u1 = u1;
  found.v0 = v0;
  found.v1 = v1;
}

}  // namespace vpe::voxel
