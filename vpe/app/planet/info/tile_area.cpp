#include "vpe/app/planet/info/tile_area.h"

#include <cmath>

#include "lod/tree/posts.h"

namespace vpe::app {

double tile_area_sr(const lod::TileKey& key) {
  const lod::GridLines lines = lod::grid_lines(key, 1);
  // From the middle of the face to a corner of the plane u, v at distance 1.
  const auto corner = [](double u, double v) { return std::atan2(u * v, std::sqrt(u * u + v * v + 1)); };
  return corner(lines.u[1], lines.v[1]) - corner(lines.u[0], lines.v[1]) - corner(lines.u[1], lines.v[0]) +
         corner(lines.u[0], lines.v[0]);
}

}  // namespace vpe::app
