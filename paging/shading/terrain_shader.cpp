#include "paging/shading/terrain_shader.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "paging/planet/ground_version.h"
#include "paging/shading/terrain_grid.h"
#include "vpe/core/appearance/light_choice.h"
#include "vpe/core/appearance/shading.h"
#include "vpe/core/appearance/slope.h"

namespace paging {

namespace {

ColourSource colour_source_of(vpe::core::Colour colour, bool has_image) {
  switch (colour) {
    case vpe::core::Colour::kElevation: return ColourSource::kElevation;
    case vpe::core::Colour::kSlope: return ColourSource::kSlope;
    case vpe::core::Colour::kAspect: return ColourSource::kAspect;
    case vpe::core::Colour::kImage: return has_image ? ColourSource::kImageAtPosts : ColourSource::kPlain;
    case vpe::core::Colour::kDifference: return ColourSource::kDifference;
    case vpe::core::Colour::kNone: break;
  }
  return ColourSource::kPlain;
}

bool shows_scale(ColourSource s) {
  return s == ColourSource::kElevation || s == ColourSource::kSlope || s == ColourSource::kAspect ||
         s == ColourSource::kDifference;
}

// Returns the direction of steepest descent. At the poles, north is along the meridian of longitude 0.
double downhill_deg(const glm::dvec3& normal, const glm::dvec3& up) {
  const double flat = std::hypot(up.x, up.y);
  const glm::dvec3 east = flat > 0.0 ? glm::dvec3(-up.y, up.x, 0) / flat : glm::dvec3(0, 1, 0);
  return vpe::core::aspect_deg(normal, up, glm::cross(up, east), east);
}

std::size_t share_of(double share, std::size_t budget) {
  return static_cast<std::size_t>(share * static_cast<double>(budget));
}

// Returns the coarsest level whose posts, `intervals` a tile, are no farther apart than footprint_m.
int level_for(double footprint_m, int intervals, double radius_m) {
  const double root_m = lod::nominal_side_m(0, radius_m) / intervals;
  return std::clamp(static_cast<int>(std::ceil(std::log2(root_m / footprint_m))), 0, lod::kMaxLevel);
}

}  // namespace

ShadingParams shading_params(const vpe::core::Appearance& a, const glm::dvec3& sun, bool has_image,
                             std::shared_ptr<const vpe::core::ColourScale> scale) {
  using vpe::core::Mode;
  ShadingParams shading;
  const ColourSource shown = colour_source_of(a.colour, has_image);
  const bool of_vertices = a.mode == Mode::kWireframe || a.mode == Mode::kMarkers;
  shading.exaggeration = a.exaggeration;
  shading.flat = a.shading == vpe::core::Shading::kFlat && !of_vertices;
  shading.lit = vpe::core::is_lit_by_sun(a) && !of_vertices && a.mode != Mode::kUnlit;
  shading.colour_source = a.mode == Mode::kWireframe || a.mode == Mode::kLit ? ColourSource::kPlain
                          : a.mode == Mode::kTextured && has_image           ? ColourSource::kImage
                                                                             : shown;
  if (shading.colour_source == ColourSource::kImage && a.colourise) shading.hue = shown;
  if (a.shading == vpe::core::Shading::kVertex && !of_vertices)
    shading.flat =
        shading.colour_source == ColourSource::kSlope || shading.colour_source == ColourSource::kAspect;
  // Parameters that are not used keep their defaults, so that equal images have equal parameters.
  if (shading.lit) {
    shading.sun = sun;
    shading.ambient = a.sun_ambient;
    shading.diffuse = a.sun_diffuse;
    shading.shadows = a.shadows;
  }
  if (shows_image(shading.colour_source)) shading.stretch = {a.image_low, a.image_high, a.image_gamma};
  if (shading.colour_source == ColourSource::kPlain) shading.plain = a.plain_ground;
  if (shows_scale(shading.colour_source) || shows_scale(shading.hue)) shading.scale = std::move(scale);
  return shading;
}

bool needs_scale(const vpe::core::Appearance& appearance, bool has_image) {
  const ShadingParams shading = shading_params(appearance, {1, 0, 0}, has_image, nullptr);
  return shows_scale(shading.colour_source) || shows_scale(shading.hue);
}

bool shows_difference(const ShadingParams& params) {
  return params.colour_source == ColourSource::kDifference || params.hue == ColourSource::kDifference;
}

namespace {

// Heights of the other planet are read through half of the share for shadows.
std::shared_ptr<const Surface> earlier_surface(const PlanetFile& planet, double share, std::size_t budget) {
  if (!planet.earlier()) return nullptr;
  return std::make_shared<const Surface>(planet.earlier(), share_of(share / 2, budget));
}

}  // namespace

TerrainShader::TerrainShader(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes,
                             const ShaderBudgetShares& shares)
    : planet_(std::move(planet)),
      shares_(shares),
      surface_(planet_, share_of(planet_->earlier() ? shares.surface / 2 : shares.surface, budget_bytes)),
      earlier_(earlier_surface(*planet_, shares.surface, budget_bytes)),
      heights_(share_of(shares.heights, budget_bytes)),
      normals_(share_of(shares.normals, budget_bytes)),
      images_(share_of(shares.images, budget_bytes)),
      textures_(share_of(shares.textures, budget_bytes)) {}

std::size_t TerrainShader::bytes_resident() const {
  const std::size_t earlier = earlier_ ? earlier_->bytes_resident() : 0;
  return earlier + surface_.bytes_resident() + heights_.bytes() + normals_.bytes() + images_.bytes() +
         textures_.bytes();
}

void TerrainShader::change_planet(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes) {
  surface_.change_planet(planet);
  if (planet->earlier() != planet_->earlier())
    earlier_ = earlier_surface(*planet, shares_.surface, budget_bytes);
  planet_ = std::move(planet);
  heights_.set_limit(share_of(shares_.heights, budget_bytes));
  normals_.set_limit(share_of(shares_.normals, budget_bytes));
  images_.set_limit(share_of(shares_.images, budget_bytes));
  textures_.set_limit(share_of(shares_.textures, budget_bytes));
}

std::uint64_t shading_version(const PlanetFile& planet, const lod::TileKey& key, MadeOf made_of,
                              const ShadingParams& params) {
  std::uint64_t version = planet.version(key, made_of);
  const auto include = [&](std::uint64_t of_ground) { version = with_ground_version(version, of_ground); };
  if (shows_difference(params)) include(planet.compared_version());
  if (!params.lit || !params.shadows || !planet.is_patched()) return version;
  include(planet.shadow_version(key, params.exaggeration));
  return version;
}

TerrainShader::NormalKey TerrainShader::normal_key(const lod::TileKey& key, const ShadingParams& params) const {
  return {{key, shading_version(*planet_, key, MadeOf::kBorders, params)},
          params.exaggeration,
          params.lit && params.shadows ? params.sun : glm::dvec3(0),
          shows_difference(params) ? planet_->compared_version() : 0};
}

std::shared_ptr<const TileHeights> TerrainShader::heights(const lod::TileKey& key) const {
  return heights_.get({key, planet_->version(key)}, [&] {
    auto made = std::make_shared<const TileHeights>(planet_->heights(key));
    const std::size_t bytes =
        sizeof(*made) + made->posts.height_m.capacity() * sizeof(double) + made->nodata.capacity() / 8;
    return std::pair(std::move(made), bytes);
  });
}

TerrainShader::ImageKey TerrainShader::key_of(const lod::TileKey& key, const ImageStretch& stretch) const {
  return {{key, planet_->version(key, MadeOf::kImage)}, stretch};
}

std::shared_ptr<const ImageTile> TerrainShader::image(const lod::TileKey& key,
                                                      const ImageStretch& stretch) const {
  return images_.get(key_of(key, stretch), [&] {
    ImageTile tile = planet_->image(key);
    if (stretch != ImageStretch()) {
      const std::array<std::uint8_t, 256> table = stretch_table(stretch);
      for (vpe::base::Rgb& texel : tile.texels) texel = {table[texel.r], table[texel.g], table[texel.b]};
    }
    auto made = std::make_shared<const ImageTile>(std::move(tile));
    const std::size_t bytes = sizeof(*made) + made->texels.capacity() * sizeof(vpe::base::Rgb);
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const NormalTile> TerrainShader::normals(const lod::TileKey& key,
                                                         const ShadingParams& params) const {
  return normals_.get(normal_key(key, params), [&] {
    auto made = std::make_shared<const NormalTile>(make_normals(key, params));
    const std::size_t bytes = made->bytes();
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const NormalTile> TerrainShader::held_normals(const lod::TileKey& key,
                                                              const ShadingParams& params) const {
  return normals_.find(normal_key(key, params));
}

std::shared_ptr<const ImageTile> TerrainShader::held_image(const lod::TileKey& key,
                                                           const ImageStretch& stretch) const {
  return images_.find(key_of(key, stretch));
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

glm::dvec3 TerrainShader::source_colour(ColourSource source, const Ground& at,
                                        const ShadingParams& params) const {
  switch (source) {
    case ColourSource::kElevation:
    case ColourSource::kDifference: return (*params.scale)(at.height_m);
    case ColourSource::kSlope: return (*params.scale)(vpe::core::slope_deg(at.normal, at.up));
    case ColourSource::kAspect: return (*params.scale)(downhill_deg(at.normal, at.up));
    case ColourSource::kImage:
    case ColourSource::kImageAtPosts: return at.image;
    case ColourSource::kPlain: break;
  }
  return params.plain;
}

glm::dvec3 TerrainShader::colour(const Ground& at, const ShadingParams& params) const {
  glm::dvec3 out = source_colour(params.colour_source, at, params);
  if (params.hue != ColourSource::kPlain)
    out = vpe::core::colourised(out, source_colour(params.hue, at, params));
  return params.lit ? out * vpe::core::light(params.ambient, params.diffuse,
                                             at.sun * glm::dot(glm::normalize(at.normal), params.sun))
                    : out;
}

TerrainShader::ImageBlock TerrainShader::image_block(const lod::TileKey& block,
                                                     const ShadingParams& params) const {
  if (!shows_image(params.colour_source)) return {};
  const auto found = planet_->image_key(block);
  if (!found) throw PlanetError(planet_->path() + ": has no image; use --set mode=coloured");
  return {image(*found, params.stretch), *found};
}

glm::dvec3 TerrainShader::image_at(const glm::dvec3& direction, double footprint_m, const ImageStretch& stretch,
                                   Cursor& cursor) const {
  const mars::ChartPoint place = mars::chart_point(direction);
  const int level = level_for(footprint_m, kImageIntervals, planet_->radius_m());
  const auto key = planet_->image_key(lod::tile_at(place, level));
  if (!key) throw PlanetError(planet_->path() + ": has no image; use --set mode=coloured");
  if (!cursor.image_ || cursor.image_key_ != *key || cursor.image_stretch_ != stretch) {
    cursor.image_ = image(*key, stretch);
    cursor.image_key_ = *key;
    cursor.image_stretch_ = stretch;
  }
  return bilinear<glm::vec3>(between_lines(place.u, key->level, key->i, kImageIntervals),
                             between_lines(place.v, key->level, key->j, kImageIntervals), kImageSide,
                             [&](std::size_t k) { return rgb(cursor.image_->texels[k]); });
}

std::optional<glm::dvec3> TerrainShader::nodata_image_at(const glm::dvec3& direction, double footprint_m,
                                                         const ShadingParams& params, Cursor& cursor) const {
  if (!shows_image(params.colour_source)) return std::nullopt;
  return image_at(direction, footprint_m, params.stretch, cursor);
}

std::optional<glm::dvec3> TerrainShader::colour_at(const glm::dvec3& direction, double footprint_m,
                                                   const ShadingParams& params, Cursor& cursor) const {
  const int n = planet_->meta().tile.intervals();
  const double radius = planet_->radius_m();
  const mars::ChartPoint place = mars::chart_point(direction);
  const int level = params.flat ? lod::kMaxLevel : level_for(footprint_m, n, radius);
  const lod::TileKey key = deepest(lod::tile_at(place, level));
  if (!cursor.ground_ || cursor.ground_key_ != key) {
    cursor.ground_ = normals(key, params);
    cursor.ground_key_ = key;
  }
  const NormalTile& ground = *cursor.ground_;
  const auto side = static_cast<std::size_t>(ground.side);
  const GridPosition x = between_lines(place.u, key.level, key.i, n);
  const GridPosition y = between_lines(place.v, key.level, key.j, n);
  if (is_nodata(ground.nodata, x, y, side)) return std::nullopt;
  Ground at;
  at.up = direction;
  const int grid_level = key.level + planet_->meta().tile.k;
  const auto post = [&](std::size_t a, std::size_t b) {
    const auto line = [&](std::int32_t tile, std::size_t k) {
      return mars::face_line(std::int64_t{tile} * n + static_cast<std::int64_t>(k), grid_level);
    };
    return mars::chart_direction(key.face, line(key.i, x.index + a), line(key.j, y.index + b));
  };
  if (params.flat) {
    const bool lower = x.rest >= y.rest;
    std::array<glm::dvec3, 3> corners;
    // The tile has differences in place of heights.
    const auto own = shows_difference(params) ? heights(key) : nullptr;
    at.height_m = 0;
    const std::array<std::array<std::size_t, 2>, 3> posts{
        {{0, 0}, {lower ? std::size_t{1} : std::size_t{0}, lower ? std::size_t{0} : std::size_t{1}}, {1, 1}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = posts[k];
      const std::size_t of_post = (y.index + b) * side + x.index + a;
      const double value = static_cast<double>(ground.posts[of_post].height_m);
      const double height = own ? own->posts.height_m[of_post] : value;
      corners[k] = post(a, b) * (radius + params.exaggeration * height);
      at.height_m += value / 3;
    }
    const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    at.up = glm::normalize(middle);
    at.normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    if (glm::dot(at.normal, at.up) < 0.0) at.normal = -at.normal;
    if (params.lit && params.shadows && glm::dot(at.normal, params.sun) > 0.0)
      at.sun = sees_sun(middle, lod::nominal_side_m(key.level, radius) / n, params) ? 1.0 : 0.0;
    if (shows_image(params.colour_source)) at.image = image_at(at.up, footprint_m, params.stretch, cursor);
    return colour(at, params);
  }
  at.height_m = bilinear<float>(x, y, side, [&](std::size_t k) { return ground.posts[k].height_m; });
  at.normal = bilinear<glm::vec3>(x, y, side, [&](std::size_t k) { return ground.posts[k].normal; });
  if (!ground.sees_sun.empty())
    at.sun = bilinear<float>(x, y, side, [&](std::size_t k) { return static_cast<float>(ground.sees_sun[k]); });
  if (params.colour_source == ColourSource::kImage)
    at.image = image_at(direction, footprint_m, params.stretch, cursor);
  if (params.colour_source == ColourSource::kImageAtPosts) {
    for (std::size_t b = 0; b < 2; ++b) {
      for (std::size_t a = 0; a < 2; ++a) {
        const float share = (a == 1 ? x.rest : 1.0F - x.rest) * (b == 1 ? y.rest : 1.0F - y.rest);
        at.image += static_cast<double>(share) * image_at(post(a, b), footprint_m, params.stretch, cursor);
      }
    }
  }
  return colour(at, params);
}

}  // namespace paging
