#include "paging/ground_paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <type_traits>

#include "vpe/core/shading.h"
#include "vpe/core/slope.h"

namespace paging {

namespace {

constexpr std::size_t kImageSide = kImageIntervals + 1;

glm::vec3 rgb(const mars::Rgb& c) { return {c.r, c.g, c.b}; }

// At the poles north is along the meridian of longitude 0.
double downhill_deg(const glm::dvec3& normal, const glm::dvec3& up) {
  const double flat = std::hypot(up.x, up.y);
  const glm::dvec3 east = flat > 0.0 ? glm::dvec3(-up.y, up.x, 0) / flat : glm::dvec3(0, 1, 0);
  return vpe::core::aspect_deg(normal, up, glm::cross(up, east), east);
}

bool shows_image(Surfacing s) { return s == Surfacing::kImage || s == Surfacing::kImageAtPosts; }
Surfacing surfacing_of(vpe::core::Colour colour, bool has_image) {
  switch (colour) {
    case vpe::core::Colour::kElevation: return Surfacing::kElevation;
    case vpe::core::Colour::kSlope: return Surfacing::kSlope;
    case vpe::core::Colour::kAspect: return Surfacing::kAspect;
    case vpe::core::Colour::kImage: return has_image ? Surfacing::kImageAtPosts : Surfacing::kPlain;
    case vpe::core::Colour::kNone: break;
  }
  return Surfacing::kPlain;
}

bool shows_scale(Surfacing s) {
  return s == Surfacing::kElevation || s == Surfacing::kSlope || s == Surfacing::kAspect;
}

bool needs_vertical(Surfacing s) { return s == Surfacing::kSlope || s == Surfacing::kAspect; }

std::uint8_t to_byte(float x) { return static_cast<std::uint8_t>(std::clamp(x + 0.5F, 0.0F, 255.0F)); }

// Position in a coarser grid: `at` of `fine` steps inside piece `piece` of `pieces`, on a grid of `coarse`.
struct GridPosition {
  std::size_t index;
  float rest;
};
GridPosition grid_position(int offset, int at, int fine_total, int coarse) {
  const double x = static_cast<double>(offset + at) * coarse / fine_total;
  const auto index = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(coarse - 1));
  return {index, static_cast<float>(x - static_cast<double>(index))};
}

std::size_t nearest(const GridPosition& at) { return at.index + (at.rest >= 0.5F ? 1 : 0); }

template <typename T, typename Get>
T bilinear(const GridPosition& x, const GridPosition& y, std::size_t side, Get&& get) {
  const std::size_t at = y.index * side + x.index;
  const T south = get(at) * (1.0F - x.rest) + get(at + 1) * x.rest;
  const T north = get(at + side) * (1.0F - x.rest) + get(at + side + 1) * x.rest;
  return south * (1.0F - y.rest) + north * y.rest;
}

glm::dvec3 position(mars::Face face, double u, double v, double radius) {
  const glm::dvec3 p = mars::cube_point(face, u, v);
  return p * (radius / mars::cube_length(p));
}

double bilinear_height(const lod::Posts& posts, const lod::GridLines& lines, double u, double v) {
  const auto find = [](const std::vector<double>& line, double x) {
    const auto above = std::upper_bound(line.begin() + 1, line.end() - 1, x);
    const auto i = static_cast<std::size_t>(above - line.begin()) - 1;
    return std::pair(static_cast<int>(i), std::clamp((x - line[i]) / (line[i + 1] - line[i]), 0.0, 1.0));
  };
  const auto [i, s] = find(lines.u, u);
  const auto [j, t] = find(lines.v, v);
  return (posts.at(i, j) * (1 - s) + posts.at(i + 1, j) * s) * (1 - t) +
         (posts.at(i, j + 1) * (1 - s) + posts.at(i + 1, j + 1) * s) * t;
}

// Below level 5 a tile spans several knots of the warp: moves texels from post lines to lines even in u and v,
// so that texture coordinates are a projective function of the position on every flat triangle.
void make_even(const lod::TileKey& key, ShadedTile& tile) {
  const auto side = static_cast<std::size_t>(tile.intervals) + 1;
  const mars::ChartRect rect = lod::chart_rect(key);
  const double tiles = std::ldexp(1.0, key.level);
  const auto positions = [&](double from, double to, std::int32_t index) {
    std::vector<GridPosition> at(side);
    for (std::size_t x = 0; x < side; ++x) {
      const double u = from + (to - from) * static_cast<double>(x) / tile.intervals;
      const double s = (mars::face_parameter(u) * tiles - index) * tile.intervals;
      const auto cell = static_cast<std::size_t>(std::clamp(s, 0.0, tile.intervals - 1.0));
      at[x] = {cell, static_cast<float>(std::clamp(s - static_cast<double>(cell), 0.0, 1.0))};
    }
    return at;
  };
  const auto columns = positions(rect.u0, rect.u1, key.i);
  const auto rows = positions(rect.v0, rect.v1, key.j);
  const auto channels = static_cast<std::size_t>(tile.channels);
  std::vector<std::uint8_t> even(tile.texels.size());
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      std::uint8_t* texel = &even[channels * (y * side + x)];
      for (std::size_t c = 0; c < channels; ++c) {
        texel[c] = to_byte(bilinear<float>(columns[x], rows[y], side, [&](std::size_t at) {
          return static_cast<float>(tile.texels[channels * at + c]);
        }));
      }
      if (channels == 4) texel[3] = texel[3] < 128 ? 0 : 255;
    }
  }
  tile.texels = std::move(even);
}

}  // namespace

ShadeParams shade_params(const vpe::core::Appearance& a, const glm::dvec3& sun, bool has_image,
                         std::shared_ptr<const vpe::core::ColourScale> scale) {
  using vpe::core::Mode;
  ShadeParams look;
  const Surfacing shown = surfacing_of(a.colour, has_image);
  const bool of_vertices = a.mode == Mode::kWireframe || a.mode == Mode::kMarkers;
  look.exaggeration = a.exaggeration;
  look.flat = a.shading == vpe::core::Shading::kFlat && !of_vertices;
  look.lit = !of_vertices && a.mode != Mode::kUnlit;
  look.surfacing = a.mode == Mode::kWireframe || a.mode == Mode::kLit ? Surfacing::kPlain
                   : a.mode == Mode::kTextured && has_image           ? Surfacing::kImage
                                                                      : shown;
  if (look.surfacing == Surfacing::kImage && a.colourise) look.hue = shown;
  // What is not used is not set, so that it cannot change a look.
  if (look.lit) {
    look.sun = sun;
    look.ambient = a.sun_ambient;
    look.diffuse = a.sun_diffuse;
    look.shadows = a.shadows;
  }
  if (shows_scale(look.surfacing) || shows_scale(look.hue)) look.scale = std::move(scale);
  return look;
}

bool needs_scale(const vpe::core::Appearance& appearance, bool has_image) {
  const ShadeParams look = shade_params(appearance, {1, 0, 0}, has_image, nullptr);
  return shows_scale(look.surfacing) || shows_scale(look.hue);
}

std::size_t NormalTile::bytes() const {
  return sizeof(NormalTile) + normal.capacity() * sizeof(glm::vec3) + height_m.capacity() * sizeof(float) +
         sees_sun.capacity() * sizeof(std::uint8_t) + missing.capacity() / 8;
}

GroundPainter::GroundPainter(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes)
    : planet_(std::move(planet)),
      surface_(planet_, budget_bytes * 3 / 20),
      heights_(budget_bytes * 7 / 20),
      normals_(budget_bytes * 7 / 20),
      images_(budget_bytes * 3 / 20) {}

std::size_t GroundPainter::bytes_resident() const {
  return surface_.bytes_resident() + heights_.bytes() + normals_.bytes() + images_.bytes();
}

std::shared_ptr<const TileHeights> GroundPainter::heights(const lod::TileKey& key) const {
  return heights_.get(key, [&] {
    auto made = std::make_shared<const TileHeights>(planet_->heights(key));
    const std::size_t bytes =
        sizeof(*made) + made->posts.height_m.capacity() * sizeof(double) + made->missing.capacity() / 8;
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const ImageTile> GroundPainter::image(const lod::TileKey& key) const {
  return images_.get(key, [&] {
    auto made = std::make_shared<const ImageTile>(planet_->image(key));
    const std::size_t bytes = sizeof(*made) + made->texels.capacity() * sizeof(mars::Rgb);
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const NormalTile> GroundPainter::normals(const lod::TileKey& key,
                                                         const ShadeParams& params) const {
  const glm::dvec3 sun = params.lit && params.shadows ? params.sun : glm::dvec3(0);
  return normals_.get({key, params.exaggeration, sun}, [&] {
    auto made = std::make_shared<const NormalTile>(make_normals(key, params));
    const std::size_t bytes = made->bytes();
    return std::pair(std::move(made), bytes);
  });
}

lod::TileKey GroundPainter::deepest(const lod::TileKey& key) const {
  lod::TileKey at = key;
  while (at.level > 0 && planet_->tree().find(at) == nullptr) at = lod::parent(at);
  return at;
}

int GroundPainter::levels_below(const lod::TileKey& key, int limit) const {
  const lod::TileInfo* info = planet_->tree().find(key);
  if (info == nullptr || !info->has_children || limit == 0) return 0;
  int most = 0;
  for (int c = 0; c < 4; ++c) most = std::max(most, levels_below(lod::child(key, c), limit - 1));
  return most + 1;
}

int GroundPainter::useful_intervals(const lod::TileKey& key, Surfacing surfacing) const {
  constexpr int kMost = 3;
  const int posts = planet_->meta().tile.intervals();
  int levels = levels_below(key, kMost);
  if (surfacing == Surfacing::kImage) {
    const int image_levels = planet_->meta().finest_image_level - key.level;
    int intervals = kImageIntervals;
    for (int l = 0; l < std::min(image_levels, kMost); ++l) intervals *= 2;
    while (levels < kMost && image_levels >= 0 && posts << levels < intervals) ++levels;
  }
  return posts << levels;
}

// Heights of the row of posts just across an edge, in this tile's order along it, and where those posts are.
std::vector<double> GroundPainter::heights_across(const lod::TileKey& key, lod::Edge edge,
                                                  std::vector<glm::dvec3>& points) const {
  const int n = planet_->meta().tile.intervals();
  const lod::Neighbour across = lod::neighbour(key, edge);
  const lod::GridLines lines = lod::grid_lines(across.key, n);
  const lod::TileKey stored = deepest(across.key);
  const auto posts = heights(stored);
  const lod::GridLines stored_lines = lod::grid_lines(stored, n);
  std::vector<double> out(static_cast<std::size_t>(n) + 1);
  points.resize(out.size());
  for (int a = 0; a <= n; ++a) {
    const int along = across.reversed ? n - a : a;
    int i = along;
    int j = along;
    switch (across.edge) {
      case lod::Edge::kWest: i = 1; break;
      case lod::Edge::kEast: i = n - 1; break;
      case lod::Edge::kSouth: j = 1; break;
      case lod::Edge::kNorth: j = n - 1; break;
    }
    const double u = lines.u[static_cast<std::size_t>(i)];
    const double v = lines.v[static_cast<std::size_t>(j)];
    out[static_cast<std::size_t>(a)] =
        stored == across.key ? posts->posts.at(i, j) : bilinear_height(posts->posts, stored_lines, u, v);
    points[static_cast<std::size_t>(a)] = mars::cube_point(across.key.face, u, v);
  }
  return out;
}

NormalTile GroundPainter::make_normals(const lod::TileKey& key, const ShadeParams& params) const {
  const double exaggeration = params.exaggeration;
  const auto source = heights(key);
  const lod::Posts& posts = source->posts;
  const int n = posts.intervals;
  const auto side = static_cast<std::size_t>(n) + 1;
  const auto wide = side + 2;  // with one row of neighbours all around; the four corners are not used
  const double radius = planet_->radius_m();
  const lod::GridLines lines = lod::grid_lines(key, n);
  const mars::ChartRect rect = lod::chart_rect(key);
  const glm::dvec3 origin = position(key.face, 0.5 * (rect.u0 + rect.u1), 0.5 * (rect.v0 + rect.v1), radius);
  const auto place = [&](const glm::dvec3& p, double h) {
    return glm::vec3(p * ((radius + exaggeration * h) / mars::cube_length(p)) - origin);
  };

  std::vector<glm::vec3> points(wide * wide);
  for (std::size_t j = 0; j < side; ++j) {
    for (std::size_t i = 0; i < side; ++i) {
      points[(j + 1) * wide + i + 1] =
          place(mars::cube_point(key.face, lines.u[i], lines.v[j]), posts.height_m[j * side + i]);
    }
  }
  std::vector<glm::dvec3> across;
  for (const lod::Edge edge : lod::kEdges) {
    const std::vector<double> heights = heights_across(key, edge, across);
    for (std::size_t a = 0; a < side; ++a) {
      std::size_t at = 0;
      switch (edge) {
        case lod::Edge::kWest: at = (a + 1) * wide; break;
        case lod::Edge::kEast: at = (a + 1) * wide + wide - 1; break;
        case lod::Edge::kSouth: at = a + 1; break;
        case lod::Edge::kNorth: at = (wide - 1) * wide + a + 1; break;
      }
      points[at] = place(across[a], heights[a]);
    }
  }

  NormalTile out{key, static_cast<int>(side), {}, {}, {}, source->missing};
  out.normal.reserve(side * side);
  out.height_m.assign(posts.height_m.begin(), posts.height_m.end());
  for (std::size_t j = 1; j <= side; ++j) {
    const glm::vec3* row = &points[j * wide];
    for (std::size_t i = 1; i <= side; ++i) {
      out.normal.push_back(glm::normalize(glm::cross(row[i + 1] - row[i - 1], row[i + wide] - row[i - wide])));
    }
  }
  if (!params.lit || !params.shadows) return out;
  const double spacing_m = lod::nominal_side_m(key.level, radius) / n;
  out.sees_sun.reserve(side * side);
  for (std::size_t j = 0; j < side; ++j) {
    for (std::size_t i = 0; i < side; ++i) {
      const glm::dvec3 post = glm::dvec3(points[(j + 1) * wide + i + 1]) + origin;
      const bool faces = glm::dot(glm::dvec3(out.normal[j * side + i]), params.sun) > 0.0;
      out.sees_sun.push_back(faces && sees_sun(post, spacing_m, params) ? 1 : 0);
    }
  }
  return out;
}

// From a little above the ground, since the ray's own facets meet it there.
bool GroundPainter::sees_sun(const glm::dvec3& place_m, double spacing_m, const ShadeParams& params) const {
  constexpr double kLift = 1e-3;
  const double radius = glm::length(place_m);
  const glm::dvec3 eye = place_m * ((radius + kLift * spacing_m) / radius);
  return std::isinf(surface_.cast(eye, params.sun, params.exaggeration));
}

// What a surfacing shows of a place on the ground.
glm::dvec3 GroundPainter::shown(Surfacing what, const Ground& at, const ShadeParams& params) const {
  switch (what) {
    case Surfacing::kElevation: return (*params.scale)(at.height_m);
    case Surfacing::kSlope: return (*params.scale)(vpe::core::slope_deg(at.normal, at.up));
    case Surfacing::kAspect: return (*params.scale)(downhill_deg(at.normal, at.up));
    case Surfacing::kImage:
    case Surfacing::kImageAtPosts: return at.image;
    case Surfacing::kPlain: break;
  }
  return vpe::core::kPlainGround;
}

glm::dvec3 GroundPainter::colour(const Ground& at, const ShadeParams& params) const {
  glm::dvec3 out = shown(params.surfacing, at, params);
  if (params.hue != Surfacing::kPlain) out = vpe::core::colourised(out, shown(params.hue, at, params));
  return params.lit ? out * vpe::core::light(params.ambient, params.diffuse,
                                             at.sun * glm::dot(glm::normalize(at.normal), params.sun))
                    : out;
}

// The image's texels over a block or a part of it, or none.
GroundPainter::Picture GroundPainter::picture(const lod::TileKey& block, const ShadeParams& params) const {
  if (!shows_image(params.surfacing)) return {};
  const auto found = planet_->image_key(block);
  if (!found) throw PlanetError(planet_->path() + ": has no image; use --set mode=coloured");
  return {image(*found), *found};
}

void GroundPainter::shade_block(const lod::TileKey& block, int x0, int y0, int side, const ShadeParams& params,
                                ShadedTile& out) const {
  const int n = planet_->meta().tile.intervals();
  const lod::TileKey stored = deepest(block);
  const std::shared_ptr<const NormalTile> ground = normals(stored, params);
  const Picture picture = this->picture(block, params);
  // Where this block lies inside what is stored, in steps of the block's own texels.
  const auto offset = [&](std::int32_t index, const lod::TileKey& outer) {
    const int levels = block.level - outer.level;
    return (index - ((index >> levels) << levels)) * n;
  };
  const int ground_steps = n << (block.level - stored.level);
  const int gx = offset(block.i, stored);
  const int gy = offset(block.j, stored);
  const int picture_steps = picture.tile ? n << (block.level - picture.key.level) : 1;
  const int px = picture.tile ? offset(block.i, picture.key) : 0;
  const int py = picture.tile ? offset(block.j, picture.key) : 0;
  const bool direct = stored == block;
  const bool needs_up = needs_vertical(params.surfacing) || needs_vertical(params.hue);
  const lod::GridLines lines = needs_up ? lod::grid_lines(block, n) : lod::GridLines{};

  const auto ground_side = static_cast<std::size_t>(ground->side);
  const auto channels = static_cast<std::size_t>(out.channels);
  Ground at;
  for (int y = 0; y <= n; ++y) {
    const GridPosition gyp = grid_position(gy, y, ground_steps, ground->side - 1);
    const GridPosition pyp = grid_position(py, y, picture_steps, kImageIntervals);
    std::uint8_t* texel =
        &out.texels[channels * (static_cast<std::size_t>(y0 + y) * static_cast<std::size_t>(side) +
                                static_cast<std::size_t>(x0))];
    for (int x = 0; x <= n; ++x, texel += channels) {
      const GridPosition gxp = grid_position(gx, x, ground_steps, ground->side - 1);
      const auto between = [&](const auto& values) {
        using T = std::decay_t<decltype(values[0])>;
        using Sum = std::conditional_t<std::is_same_v<T, std::uint8_t>, float, T>;
        return bilinear<Sum>(gxp, gyp, ground_side, [&](std::size_t k) { return static_cast<Sum>(values[k]); });
      };
      at.height_m = between(ground->height_m);
      at.normal = direct
                      ? ground->normal[static_cast<std::size_t>(y) * ground_side + static_cast<std::size_t>(x)]
                      : between(ground->normal);
      if (!ground->sees_sun.empty()) at.sun = between(ground->sees_sun);
      if (needs_up)
        at.up = mars::chart_direction(block.face, lines.u[static_cast<std::size_t>(x)],
                                      lines.v[static_cast<std::size_t>(y)]);
      if (picture.tile) {
        const GridPosition pxp = grid_position(px, x, picture_steps, kImageIntervals);
        at.image = bilinear<glm::vec3>(pxp, pyp, kImageSide,
                                       [&](std::size_t k) { return rgb(picture.tile->texels[k]); });
      }
      if (channels == 1) {
        texel[0] = to_byte(
            static_cast<float>(255.0 / out.brightest *
                               vpe::core::light(params.ambient, params.diffuse,
                                                at.sun * glm::dot(glm::normalize(at.normal), params.sun))));
        continue;
      }
      const glm::vec3 c(colour(at, params));
      texel[0] = to_byte(c.x);
      texel[1] = to_byte(c.y);
      texel[2] = to_byte(c.z);
      texel[3] = 255;
      if (!ground->missing.empty() && ground->missing[nearest(gyp) * ground_side + nearest(gxp)]) {
        texel[3] = 0;
        out.gaps = true;
      }
    }
  }
}

namespace {

// The level from which on posts, `intervals` a tile, are no farther apart.
int level_for(double footprint_m, int intervals, double radius_m) {
  const double root_m = lod::nominal_side_m(0, radius_m) / intervals;
  return std::clamp(static_cast<int>(std::ceil(std::log2(root_m / footprint_m))), 0, lod::kMaxLevel);
}

// Place between the lines of a tile's grid, which are even in the face's parameter.
GridPosition between_lines(double x, int level, std::int32_t index, int intervals) {
  const double line =
      std::clamp(mars::face_parameter(x) * std::ldexp(1.0, level) - index, 0.0, 1.0) * intervals;
  const auto before = std::min(static_cast<std::size_t>(line), static_cast<std::size_t>(intervals - 1));
  return {before, static_cast<float>(line - static_cast<double>(before))};
}

}  // namespace

glm::dvec3 GroundPainter::image_at(const glm::dvec3& direction, double footprint_m, Cursor& cursor) const {
  const mars::ChartPoint place = mars::chart_point(direction);
  const int level = level_for(footprint_m, kImageIntervals, planet_->radius_m());
  const auto key = planet_->image_key(lod::tile_at(place, level));
  if (!key) throw PlanetError(planet_->path() + ": has no image; use --set mode=coloured");
  if (!cursor.image || cursor.image_key != *key) {
    cursor.image = image(*key);
    cursor.image_key = *key;
  }
  return bilinear<glm::vec3>(between_lines(place.u, key->level, key->i, kImageIntervals),
                             between_lines(place.v, key->level, key->j, kImageIntervals), kImageSide,
                             [&](std::size_t k) { return rgb(cursor.image->texels[k]); });
}

std::optional<glm::dvec3> GroundPainter::colour_at(const glm::dvec3& direction, double footprint_m,
                                                   const ShadeParams& params, Cursor& cursor) const {
  const int n = planet_->meta().tile.intervals();
  const double radius = planet_->radius_m();
  const mars::ChartPoint place = mars::chart_point(direction);
  const int level = params.flat ? lod::kMaxLevel : level_for(footprint_m, n, radius);
  const lod::TileKey key = deepest(lod::tile_at(place, level));
  if (!cursor.ground || cursor.ground_key != key) {
    cursor.ground = normals(key, params);
    cursor.ground_key = key;
  }
  const NormalTile& ground = *cursor.ground;
  const auto side = static_cast<std::size_t>(ground.side);
  const GridPosition x = between_lines(place.u, key.level, key.i, n);
  const GridPosition y = between_lines(place.v, key.level, key.j, n);
  if (!ground.missing.empty() && ground.missing[nearest(y) * side + nearest(x)]) return std::nullopt;
  Ground at;
  at.up = direction;
  const lod::GridLines lines =
      params.flat || params.surfacing == Surfacing::kImageAtPosts ? lod::grid_lines(key, n) : lod::GridLines{};
  const auto post = [&](std::size_t a, std::size_t b) {
    return mars::chart_direction(key.face, lines.u[x.index + a], lines.v[y.index + b]);
  };
  if (params.flat) {
    const bool lower = x.rest >= y.rest;
    std::array<glm::dvec3, 3> corners;
    at.height_m = 0;
    const std::array<std::array<std::size_t, 2>, 3> posts{
        {{0, 0}, {lower ? std::size_t{1} : std::size_t{0}, lower ? std::size_t{0} : std::size_t{1}}, {1, 1}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = posts[k];
      const double height = static_cast<double>(ground.height_m[(y.index + b) * side + x.index + a]);
      corners[k] = post(a, b) * (radius + params.exaggeration * height);
      at.height_m += height / 3;
    }
    const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    at.up = glm::normalize(middle);
    at.normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    if (glm::dot(at.normal, at.up) < 0.0) at.normal = -at.normal;
    if (params.lit && params.shadows && glm::dot(at.normal, params.sun) > 0.0)
      at.sun = sees_sun(middle, lod::nominal_side_m(key.level, radius) / n, params) ? 1.0 : 0.0;
    if (shows_image(params.surfacing)) at.image = image_at(at.up, footprint_m, cursor);
    return colour(at, params);
  }
  at.height_m = bilinear<float>(x, y, side, [&](std::size_t k) { return ground.height_m[k]; });
  at.normal = bilinear<glm::vec3>(x, y, side, [&](std::size_t k) { return ground.normal[k]; });
  if (!ground.sees_sun.empty())
    at.sun = bilinear<float>(x, y, side, [&](std::size_t k) { return static_cast<float>(ground.sees_sun[k]); });
  if (params.surfacing == Surfacing::kImage) at.image = image_at(direction, footprint_m, cursor);
  if (params.surfacing == Surfacing::kImageAtPosts) {
    for (std::size_t b = 0; b < 2; ++b) {
      for (std::size_t a = 0; a < 2; ++a) {
        const float share = (a == 1 ? x.rest : 1.0F - x.rest) * (b == 1 ? y.rest : 1.0F - y.rest);
        at.image += static_cast<double>(share) * image_at(post(a, b), footprint_m, cursor);
      }
    }
  }
  return colour(at, params);
}

ShadedTile GroundPainter::shade_facets(const lod::TileKey& key, const lod::TileMesh& mesh,
                                       std::span<const double> height_m, const ShadeParams& params) const {
  const double radius = planet_->radius_m();
  const lod::GridLines lines = lod::grid_lines(key, mesh.intervals);
  const double spacing_m = lod::nominal_side_m(key.level, radius) / mesh.intervals;
  const Picture picture = this->picture(key, params);
  const std::shared_ptr<const TileHeights> posts = planet_->has_missing(key) ? heights(deepest(key)) : nullptr;
  const bool gaps = posts && !posts->missing.empty();
  std::vector<glm::dvec3> places;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    places.push_back(mars::chart_direction(key.face, lines.u[mesh.vertices[v].i], lines.v[mesh.vertices[v].j]) *
                     (radius + params.exaggeration * height_m[v]));
  }
  ShadedTile out;
  Ground at;
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const std::array<std::uint32_t, 3> v{mesh.triangles[t], mesh.triangles[t + 1], mesh.triangles[t + 2]};
    at.normal = glm::normalize(glm::cross(places[v[1]] - places[v[0]], places[v[2]] - places[v[0]]));
    const glm::dvec3 middle = (places[v[0]] + places[v[1]] + places[v[2]]) / 3.0;
    at.up = glm::normalize(middle);
    if (glm::dot(at.normal, at.up) < 0.0) at.normal = -at.normal;
    at.height_m = (height_m[v[0]] + height_m[v[1]] + height_m[v[2]]) / 3.0;
    at.sun = 1.0;
    if (params.lit && params.shadows && glm::dot(at.normal, params.sun) > 0.0)
      at.sun = sees_sun(middle, spacing_m, params) ? 1.0 : 0.0;
    if (picture.tile) {
      const mars::ChartPoint place = mars::chart_on(key.face, middle);
      // Image texels are on lines even in the face's parameter.
      const auto along = [&](double x, std::int32_t index) {
        const double tiles = std::ldexp(1.0, picture.key.level);
        const double texel = std::clamp(mars::face_parameter(x) * tiles - index, 0.0, 1.0) * kImageIntervals;
        const auto before = std::min(static_cast<std::size_t>(texel), std::size_t{kImageIntervals - 1});
        return GridPosition{before, static_cast<float>(texel - static_cast<double>(before))};
      };
      at.image = bilinear<glm::vec3>(along(place.u, picture.key.i), along(place.v, picture.key.j), kImageSide,
                                     [&](std::size_t k) { return rgb(picture.tile->texels[k]); });
    }
    const glm::vec3 c(colour(at, params));
    bool missing = false;
    for (const std::uint32_t corner : v) {
      if (!gaps) break;
      // A parent's mesh is over the posts of its children.
      const int finer = mesh.intervals / posts->posts.intervals;
      const auto side = static_cast<std::size_t>(posts->posts.intervals) + 1;
      const auto post = [&](int of_mesh) { return static_cast<std::size_t>((of_mesh + finer / 2) / finer); };
      missing = missing || posts->missing[post(mesh.vertices[corner].j) * side + post(mesh.vertices[corner].i)];
    }
    out.gaps = out.gaps || missing;
    for (const std::uint8_t byte : {to_byte(c.x), to_byte(c.y), to_byte(c.z), std::uint8_t(missing ? 0 : 255)})
      out.texels.push_back(byte);
  }
  return out;
}

ShadedTile GroundPainter::shade(const lod::TileKey& key, int intervals, const ShadeParams& params) const {
  const int n = planet_->meta().tile.intervals();
  int levels = 0;
  while (n << levels < intervals) ++levels;
  ShadedTile out;
  out.intervals = n << levels;
  const int side = out.intervals + 1;
  // Light alone takes a quarter; alpha would tell what has no data.
  if (params.surfacing == Surfacing::kPlain && params.lit && !planet_->has_missing(key)) {
    out.channels = 1;
    out.brightest = vpe::core::light(params.ambient, params.diffuse, 1.0);
  }
  out.texels.resize(static_cast<std::size_t>(out.channels) * static_cast<std::size_t>(side) *
                    static_cast<std::size_t>(side));
  const int blocks = 1 << levels;
  for (int by = 0; by < blocks; ++by) {
    for (int bx = 0; bx < blocks; ++bx) {
      const lod::TileKey block{key.face, key.level + levels, (key.i << levels) + bx, (key.j << levels) + by};
      shade_block(block, bx * n, by * n, side, params, out);
    }
  }
  if (key.level < 5) make_even(key, out);
  return out;
}

}  // namespace paging
