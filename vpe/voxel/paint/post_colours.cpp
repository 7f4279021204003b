#include "vpe/voxel/paint/post_colours.h"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>

namespace vpe::voxel {

namespace {

constexpr std::size_t kImageLines = paging::kImageIntervals + 1;

// Maps a grid's lines to positions in an image tile along one axis.
struct LineInImage {
  std::size_t index;  // of the texel before
  float rest;
};

LineInImage line_in_image(std::int64_t line, int grid_level, int image_level, std::int32_t image_index) {
  const double at =
      (std::ldexp(static_cast<double>(line), image_level - grid_level) - image_index) * paging::kImageIntervals;
  const double inside = std::clamp(at, 0.0, double{paging::kImageIntervals});
  const auto index = std::min(static_cast<std::size_t>(inside), kImageLines - 2);
  return {index, static_cast<float>(inside - static_cast<double>(index))};
}

glm::vec3 image_between(const paging::ImageTile& image, const LineInImage& x, const LineInImage& y) {
  const auto texel = [&](std::size_t at) {
    const base::Rgb& rgb = image.texels[at];
    return glm::vec3(rgb.r, rgb.g, rgb.b);
  };
  const std::size_t at = y.index * kImageLines + x.index;
  const glm::vec3 south = texel(at) * (1 - x.rest) + texel(at + 1) * x.rest;
  const glm::vec3 north = texel(at + kImageLines) * (1 - x.rest) + texel(at + kImageLines + 1) * x.rest;
  return south * (1 - y.rest) + north * y.rest;
}

std::int32_t shifted(std::int64_t index, int by) {
  return static_cast<std::int32_t>(by >= 0 ? index << by : index >> -by);
}

}  // namespace

std::shared_ptr<const PostColours> make_post_colours(const paging::PlanetFile& planet,
                                                     const paging::TerrainShader& shader,
                                                     const lod::TileKey& key, int image_level,
                                                     const paging::ShadingParams& shading) {
  const int k = planet.meta().tile.k;
  const int n = planet.meta().tile.intervals();
  const int grid_level = key.level + k;
  // Of a size that image_at() takes this level for.
  const double footprint_m =
      1.25 * lod::nominal_side_m(0, planet.radius_m()) / paging::kImageIntervals / std::ldexp(1, image_level);
  const lod::GridLines lines = lod::grid_lines(key, n);
  const auto out = std::make_shared<PostColours>();
  out->side = n + 1;
  out->texels.reserve(4 * static_cast<std::size_t>(n + 1) * static_cast<std::size_t>(n + 1));
  const auto add = [&](const glm::dvec3& rgb) {
    for (int c = 0; c < 3; ++c)
      out->texels.push_back(static_cast<std::uint16_t>(std::lround(rgb[c] * PostColours::kPerUnit)));
    out->texels.push_back(0);
  };

  paging::TerrainShader::Cursor cursor;
  std::shared_ptr<const paging::ImageTile> image;
  lod::TileKey image_key;
  lod::TileKey square;
  for (int j = 0; j <= n; ++j) {
    const std::int64_t row = std::int64_t{key.j} * n + j;
    LineInImage y{};
    image = nullptr;
    for (int i = 0; i <= n; ++i) {
      const std::int64_t column = std::int64_t{key.i} * n + i;
      // Posts on the border may take their texel from another tile or face.
      if (i == 0 || i == n || j == 0 || j == n) {
        add(shader
                .nodata_image_at(mars::chart_direction(key.face, lines.u[static_cast<std::size_t>(i)],
                                                       lines.v[static_cast<std::size_t>(j)]),
                                 footprint_m, shading, cursor)
                .value());
        continue;
      }
      const lod::TileKey here{key.face, image_level, shifted(column, image_level - grid_level),
                              shifted(row, image_level - grid_level)};
      if (!image || here != square) {
        const auto found = planet.image_key(here);
        if (!found) throw paging::PlanetError(planet.path() + ": has no image; use --set mode=coloured");
        square = here;
        image_key = *found;
        image = shader.image(image_key, shading.stretch);
        y = line_in_image(row, grid_level, image_key.level, image_key.j);
      }
      add(image_between(*image, line_in_image(column, grid_level, image_key.level, image_key.i), y));
    }
  }
  return out;
}

}  // namespace vpe::voxel
