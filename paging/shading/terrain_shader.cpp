#include "paging/shading/terrain_shader.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/core/appearance/shading.h"
#include "vpe/core/appearance/slope.h"

namespace paging {

namespace {

// At the poles north is along the meridian of longitude 0.
double downhill_deg(const glm::dvec3& normal, const glm::dvec3& up) {
  const double flat = std::hypot(up.x, up.y);
  const glm::dvec3 east = flat > 0.0 ? glm::dvec3(-up.y, up.x, 0) / flat : glm::dvec3(0, 1, 0);
  return vpe::core::aspect_deg(normal, up, glm::cross(up, east), east);
}

std::size_t part(double share, std::size_t budget) {
  return static_cast<std::size_t>(share * static_cast<double>(budget));
}

}  // namespace

TerrainShader::TerrainShader(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes,
                             const ShaderBudgetShares& shares)
    : planet_(std::move(planet)),
      surface_(planet_, part(shares.surface, budget_bytes)),
      heights_(part(shares.heights, budget_bytes)),
      normals_(part(shares.normals, budget_bytes)),
      images_(part(shares.images, budget_bytes)) {}

std::size_t TerrainShader::bytes_resident() const {
  return surface_.bytes_resident() + heights_.bytes() + normals_.bytes() + images_.bytes();
}

std::shared_ptr<const TileHeights> TerrainShader::heights(const lod::TileKey& key) const {
  return heights_.get(key, [&] {
    auto made = std::make_shared<const TileHeights>(planet_->heights(key));
    const std::size_t bytes =
        sizeof(*made) + made->posts.height_m.capacity() * sizeof(double) + made->nodata.capacity() / 8;
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const ImageTile> TerrainShader::image(const lod::TileKey& key) const {
  return images_.get(key, [&] {
    auto made = std::make_shared<const ImageTile>(planet_->image(key));
    const std::size_t bytes = sizeof(*made) + made->texels.capacity() * sizeof(vpe::base::Rgb);
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const NormalTile> TerrainShader::normals(const lod::TileKey& key,
                                                         const ShadingParams& params) const {
  const glm::dvec3 sun = params.lit && params.shadows ? params.sun : glm::dvec3(0);
  return normals_.get({key, params.exaggeration, sun}, [&] {
    auto made = std::make_shared<const NormalTile>(make_normals(key, params));
    const std::size_t bytes = made->bytes();
    return std::pair(std::move(made), bytes);
  });
}

lod::TileKey TerrainShader::deepest(const lod::TileKey& key) const { return planet_->tree().deepest(key).key; }

int TerrainShader::levels_below(const lod::TileKey& key, int limit) const {
  const lod::TileInfo* info = planet_->tree().find(key);
  if (info == nullptr || !info->has_children || limit == 0) return 0;
  int most = 0;
  for (int c = 0; c < 4; ++c) most = std::max(most, levels_below(lod::child(key, c), limit - 1));
  return most + 1;
}

int TerrainShader::useful_intervals(const lod::TileKey& key, ColourSource colour_source) const {
  constexpr int kMost = 3;
  const int posts = planet_->meta().tile.intervals();
  int levels = levels_below(key, kMost);
  if (colour_source == ColourSource::kImage) {
    const int image_levels = planet_->meta().finest_image_level - key.level;
    int intervals = kImageIntervals;
    for (int l = 0; l < std::min(image_levels, kMost); ++l) intervals *= 2;
    while (levels < kMost && image_levels >= 0 && posts << levels < intervals) ++levels;
  }
  return posts << levels;
}

// What a surfacing shows of a place on the ground.
glm::dvec3 TerrainShader::shown(ColourSource what, const Ground& at, const ShadingParams& params) const {
  switch (what) {
    case ColourSource::kElevation: return (*params.scale)(at.height_m);
    case ColourSource::kSlope: return (*params.scale)(vpe::core::slope_deg(at.normal, at.up));
    case ColourSource::kAspect: return (*params.scale)(downhill_deg(at.normal, at.up));
    case ColourSource::kImage:
    case ColourSource::kImageAtPosts: return at.image;
    case ColourSource::kPlain: break;
  }
  return vpe::core::kPlainGround;
}

glm::dvec3 TerrainShader::colour(const Ground& at, const ShadingParams& params) const {
  glm::dvec3 out = shown(params.colour_source, at, params);
  if (params.hue != ColourSource::kPlain) out = vpe::core::colourised(out, shown(params.hue, at, params));
  return params.lit ? out * vpe::core::light(params.ambient, params.diffuse,
                                             at.sun * glm::dot(glm::normalize(at.normal), params.sun))
                    : out;
}

// The image's texels over a block or a part of it, or none.
TerrainShader::ImageBlock TerrainShader::image_block(const lod::TileKey& block,
                                                     const ShadingParams& params) const {
  if (!shows_image(params.colour_source)) return {};
  const auto found = planet_->image_key(block);
  if (!found) throw PlanetError(planet_->path() + ": has no image; use --set mode=coloured");
  return {image(*found), *found};
}

}  // namespace paging
