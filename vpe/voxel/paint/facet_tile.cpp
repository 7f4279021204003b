#include "vpe/voxel/paint/facet_tile.h"

#include <algorithm>
#include <cmath>

namespace vpe::voxel {

std::size_t FacetTile::bytes() const {
  return sizeof(*this) + posts.capacity() * sizeof(Post) + nodata.capacity() / 8 + (sun ? 2 * posts.size() : 0);
}

glm::dvec3 FacetTile::middle(std::size_t corner, bool lower, double radius_m) const {
  const auto wide = static_cast<std::size_t>(side);
  const lod::GridLines lines = lod::grid_lines(key, side - 1);
  glm::dvec3 sum(0);
  for (const std::size_t post : {corner, corner + (lower ? 1 : wide), corner + wide + 1}) {
    const double u = lines.u[post % wide], v = lines.v[post / wide];
    const double per_z = static_cast<double>(slopes.base) + static_cast<double>(slopes.u) * u +
                         static_cast<double>(slopes.v) * v + static_cast<double>(posts[post].relief);
    sum += mars::cube_point(key.face, u, v) * (radius_m / per_z);
  }
  return sum / 3.0;
}

std::shared_ptr<const FacetTile> make_facet_tile(const paging::PlanetFile& planet,
                                                 const paging::TerrainShader& shader, const lod::TileKey& key,
                                                 const paging::ShadingParams& shading) {
  const bool differences = paging::shows_difference(shading);
  paging::TileHeights heights = differences ? planet.heights(key) : planet.heights(key, shading.exaggeration);
  const std::vector<double>& height_m = heights.posts.height_m;
  const auto out = std::make_shared<FacetTile>();
  out->key = key;
  out->side = heights.posts.side();
  out->nodata = std::move(heights.nodata);
  const auto shown = differences ? shader.normals(key, shading) : nullptr;
  if (shown) out->nodata = shown->nodata;

  const auto side = static_cast<std::size_t>(out->side);
  const lod::GridLines lines = lod::grid_lines(key, out->side - 1);
  // The plane through the middle post that touches the sphere of its height.
  const double u0 = lines.u[side / 2], v0 = lines.v[side / 2];
  const auto [lowest, highest] = std::minmax_element(height_m.begin(), height_m.end());
  const double radius_m = planet.radius_m();
  const double share = radius_m / (radius_m + 0.5 * shading.exaggeration * (*lowest + *highest));
  const double length = std::sqrt(1 + u0 * u0 + v0 * v0);
  const auto rounded = [](double x) { return static_cast<float>(x); };
  out->slopes = {rounded(share * u0 / length), rounded(share * v0 / length), rounded(share / length)};
  const auto slope_u = static_cast<double>(out->slopes.u), slope_v = static_cast<double>(out->slopes.v),
             base = static_cast<double>(out->slopes.base);
  out->posts.reserve(side * side);
  for (std::size_t j = 0; j < side; ++j) {
    const double v = lines.v[j];
    for (std::size_t i = 0; i < side; ++i) {
      const double u = lines.u[i];
      const std::size_t n = j * side + i;
      // As NormalTile has it.
      const auto height = static_cast<double>(rounded(height_m[n]));
      const double per_z =
          std::sqrt(1 + u * u + v * v) * (radius_m / (radius_m + shading.exaggeration * height));
      out->posts.push_back({rounded(per_z - (base + slope_u * u + slope_v * v)),
                            shown ? shown->posts[n].height_m : rounded(height_m[n])});
    }
  }
  if (shading.lit && shading.shadows) out->sun = std::make_unique<std::atomic<std::uint8_t>[]>(2 * side * side);
  return out;
}

}  // namespace vpe::voxel
