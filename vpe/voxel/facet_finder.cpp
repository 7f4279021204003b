#include "vpe/voxel/facet_finder.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/cube.h"

namespace vpe::voxel {

namespace {

bool near(double x, int intervals) { return x > -kExactLines && x < intervals + kExactLines; }

}  // namespace

const Facets& FacetFinder::at(const glm::dvec3& place_m) {
  const lod::TileTree& tree = walk_.tree();
  const mars::ChartPoint place = mars::chart_point(place_m);
  if (found_ && place.face == facets_.face) {
    const LatticeFrame& f = facets_.frame;
    const double x = (place.u - f.u0) / f.du;
    const double y = (place.v - f.v0) / f.dv;
    if (x >= 0 && x <= f.intervals && y >= 0 && y <= f.intervals) return facets_;
  }
  auto tile = static_cast<lod::TileTree::Index>(place.face);
  while (!walk_.ends_at(tile)) {
    const lod::TileKey& key = tree[tile].key;
    const bool east = place.u >= mars::face_line(2 * std::int64_t{key.i} + 1, key.level + 1);
    const bool north = place.v >= mars::face_line(2 * std::int64_t{key.j} + 1, key.level + 1);
    tile = tree.first_child(tile) + (east ? 1U : 0U) + (north ? 2U : 0U);
  }
  const lod::TileKey& key = tree[tile].key;
  const int per_side = lattices_per_side(key.level, tree.shape().intervals());
  int parts_level = key.level;
  for (int k = 1; k < per_side; k *= 2) ++parts_level;
  const auto part = [&](double chart, std::int32_t index) {
    const double lines = std::ldexp(mars::face_parameter(chart), parts_level);
    return std::clamp(static_cast<int>(lines - static_cast<double>(index) * per_side), 0, per_side - 1);
  };
  const int i = part(place.u, key.i);
  const int j = part(place.v, key.j);
  facets_.id = (std::uint64_t{tile} << 16) + static_cast<std::uint64_t>(j * per_side + i);
  facets_.face = place.face;
  LatticeFrame& f = facets_.frame;
  f.intervals = tree.shape().intervals() / per_side;
  const auto line = [&](std::int32_t index, int k) {
    return mars::face_line(std::int64_t{index} * per_side + k, parts_level);
  };
  f.u0 = line(key.i, i);
  f.du = (line(key.i, i + 1) - f.u0) / f.intervals;
  f.v0 = line(key.j, j);
  f.dv = (line(key.j, j + 1) - f.v0) / f.intervals;
  const mars::FaceAxes& axes = mars::face_axes(place.face);
  const double z = glm::dot(walk_.eye().up, axes.out);
  const bool exact = z > 0 && needs_exact(f, walk_.eye()) &&
                     near((glm::dot(walk_.eye().up, axes.right) / z - f.u0) / f.du, f.intervals) &&
                     near((glm::dot(walk_.eye().up, axes.up) / z - f.v0) / f.dv, f.intervals);
  facets_.exact_lines = nullptr;
  if (exact) {
    facets_.family = Family::kColumns;
    facets_.exact_lines = &shelf_.exact_lattices(tile, facets_.family).lines(i, j);
  } else {
    facets_.lines = &shelf_.any_lattices(tile, facets_.family).lines(i, j);
  }
  found_ = true;
  return facets_;
}

}  // namespace vpe::voxel
