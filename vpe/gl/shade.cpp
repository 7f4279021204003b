#include "vpe/gl/shade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace vpe::gl {

namespace {

// Ground that faces a sun 50 degrees up keeps its colour.
constexpr float kSunGain = 1.3F;

constexpr std::size_t kImageSide = paging::kImageIntervals + 1;

struct Stop {
  double height_m;
  glm::vec3 colour;
};
constexpr std::array<Stop, 11> kRamp{{{-8200, {42, 26, 90}},
                                      {-6000, {58, 60, 148}},
                                      {-4500, {62, 110, 168}},
                                      {-3000, {84, 150, 150}},
                                      {-1500, {128, 172, 118}},
                                      {0, {186, 186, 108}},
                                      {1500, {206, 160, 88}},
                                      {3500, {190, 116, 72}},
                                      {7000, {160, 84, 68}},
                                      {12000, {204, 174, 160}},
                                      {21500, {250, 248, 244}}}};

glm::vec3 ramp(double height_m) {
  if (height_m <= kRamp.front().height_m) return kRamp.front().colour;
  for (std::size_t s = 1; s < kRamp.size(); ++s) {
    if (height_m > kRamp[s].height_m) continue;
    const double t = (height_m - kRamp[s - 1].height_m) / (kRamp[s].height_m - kRamp[s - 1].height_m);
    return glm::mix(kRamp[s - 1].colour, kRamp[s].colour, static_cast<float>(t));
  }
  return kRamp.back().colour;
}

// Ramp by table: one entry a 16 m step covers -16 km .. 48 km.
class RampTable {
 public:
  RampTable() {
    for (std::size_t n = 0; n < table_.size(); ++n) table_[n] = ramp(-16384.0 + 16.0 * static_cast<double>(n));
  }
  const glm::vec3& operator()(float height_m) const {
    const float at = (height_m + 16384.0F) * (1.0F / 16.0F);
    return table_[static_cast<std::size_t>(std::clamp(at, 0.0F, static_cast<float>(table_.size() - 1)))];
  }

 private:
  std::array<glm::vec3, 4096> table_;
};

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
  std::vector<std::uint8_t> even(tile.rgba.size());
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      for (std::size_t c = 0; c < 4; ++c) {
        even[4 * (y * side + x) + c] = to_byte(bilinear<float>(columns[x], rows[y], side, [&](std::size_t at) {
          return static_cast<float>(tile.rgba[4 * at + c]);
        }));
      }
      std::uint8_t& alpha = even[4 * (y * side + x) + 3];
      alpha = alpha < 128 ? 0 : 255;
    }
  }
  tile.rgba = std::move(even);
}

}  // namespace

mars::Rgb elevation_colour(double height_m) {
  const glm::vec3 c = ramp(height_m);
  return {to_byte(c.x), to_byte(c.y), to_byte(c.z)};
}

std::size_t NormalTile::bytes() const {
  return sizeof(NormalTile) + normal.capacity() * sizeof(glm::vec3) + height_m.capacity() * sizeof(float) +
         missing.capacity() / 8;
}

Shader::Shader(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes)
    : planet_(std::move(planet)),
      heights_(budget_bytes * 2 / 5),
      normals_(budget_bytes * 2 / 5),
      images_(budget_bytes / 5) {}

std::size_t Shader::bytes_resident() const { return heights_.bytes() + normals_.bytes() + images_.bytes(); }

std::shared_ptr<const paging::TileHeights> Shader::heights(const lod::TileKey& key) const {
  return heights_.get(key, [&] {
    auto made = std::make_shared<const paging::TileHeights>(planet_->heights(key));
    const std::size_t bytes =
        sizeof(*made) + made->posts.height_m.capacity() * sizeof(double) + made->missing.capacity() / 8;
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const paging::ImageTile> Shader::image(const lod::TileKey& key) const {
  return images_.get(key, [&] {
    auto made = std::make_shared<const paging::ImageTile>(planet_->image(key));
    const std::size_t bytes = sizeof(*made) + made->texels.capacity() * sizeof(mars::Rgb);
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const NormalTile> Shader::normals(const lod::TileKey& key, double exaggeration) const {
  return normals_.get({key, exaggeration}, [&] {
    auto made = std::make_shared<const NormalTile>(make_normals(key, exaggeration));
    const std::size_t bytes = made->bytes();
    return std::pair(std::move(made), bytes);
  });
}

lod::TileKey Shader::deepest(const lod::TileKey& key) const {
  lod::TileKey at = key;
  while (at.level > 0 && planet_->tree().find(at) == nullptr) at = lod::parent(at);
  return at;
}

int Shader::levels_below(const lod::TileKey& key, int limit) const {
  const lod::TileInfo* info = planet_->tree().find(key);
  if (info == nullptr || !info->has_children || limit == 0) return 0;
  int most = 0;
  for (int c = 0; c < 4; ++c) most = std::max(most, levels_below(lod::child(key, c), limit - 1));
  return most + 1;
}

int Shader::useful_intervals(const lod::TileKey& key, Surfacing surfacing) const {
  constexpr int kMost = 3;
  const int posts = planet_->meta().tile.intervals();
  int levels = levels_below(key, kMost);
  if (surfacing == Surfacing::kImage) {
    const int image_levels = planet_->meta().finest_image_level - key.level;
    int intervals = paging::kImageIntervals;
    for (int l = 0; l < std::min(image_levels, kMost); ++l) intervals *= 2;
    while (levels < kMost && image_levels >= 0 && posts << levels < intervals) ++levels;
  }
  return posts << levels;
}

// Heights of the row of posts just across an edge, in this tile's order along it, and where those posts are.
std::vector<double> Shader::heights_across(const lod::TileKey& key, lod::Edge edge,
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

NormalTile Shader::make_normals(const lod::TileKey& key, double exaggeration) const {
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

  NormalTile out{key, static_cast<int>(side), {}, {}, source->missing};
  out.normal.reserve(side * side);
  out.height_m.assign(posts.height_m.begin(), posts.height_m.end());
  for (std::size_t j = 1; j <= side; ++j) {
    const glm::vec3* row = &points[j * wide];
    for (std::size_t i = 1; i <= side; ++i) {
      out.normal.push_back(glm::normalize(glm::cross(row[i + 1] - row[i - 1], row[i + wide] - row[i - wide])));
    }
  }
  return out;
}

void Shader::shade_block(const lod::TileKey& block, int x0, int y0, int side, const ShadeParams& params,
                         ShadedTile& out) const {
  static const RampTable ramp_table;
  const int n = planet_->meta().tile.intervals();
  const lod::TileKey stored = deepest(block);
  const std::shared_ptr<const NormalTile> ground = normals(stored, params.exaggeration);
  std::shared_ptr<const paging::ImageTile> picture;
  lod::TileKey picture_key;
  if (params.surfacing == Surfacing::kImage) {
    const auto found = planet_->image_key(block);
    if (!found) throw paging::PlanetError(planet_->path() + ": has no image; use --set mode=coloured");
    picture_key = *found;
    picture = image(picture_key);
  }
  // Where this block lies inside what is stored, in steps of the block's own texels.
  const auto offset = [&](std::int32_t index, const lod::TileKey& outer) {
    const int levels = block.level - outer.level;
    return (index - ((index >> levels) << levels)) * n;
  };
  const int ground_steps = n << (block.level - stored.level);
  const int gx = offset(block.i, stored);
  const int gy = offset(block.j, stored);
  const int picture_steps = picture ? n << (block.level - picture_key.level) : 1;
  const int px = picture ? offset(block.i, picture_key) : 0;
  const int py = picture ? offset(block.j, picture_key) : 0;
  const bool direct = stored == block;

  const glm::vec3 sun(params.sun);
  const auto ambient = static_cast<float>(params.ambient);
  const auto ground_side = static_cast<std::size_t>(ground->side);
  for (int y = 0; y <= n; ++y) {
    const GridPosition gyp = grid_position(gy, y, ground_steps, ground->side - 1);
    const GridPosition pyp = grid_position(py, y, picture_steps, paging::kImageIntervals);
    std::uint8_t* texel = &out.rgba[4 * (static_cast<std::size_t>(y0 + y) * static_cast<std::size_t>(side) +
                                         static_cast<std::size_t>(x0))];
    for (int x = 0; x <= n; ++x, texel += 4) {
      const GridPosition gxp = grid_position(gx, x, ground_steps, ground->side - 1);
      glm::vec3 colour(178, 142, 112);
      if (params.surfacing == Surfacing::kElevation) {
        colour = ramp_table(
            bilinear<float>(gxp, gyp, ground_side, [&](std::size_t at) { return ground->height_m[at]; }));
      } else if (picture) {
        const GridPosition pxp = grid_position(px, x, picture_steps, paging::kImageIntervals);
        colour = bilinear<glm::vec3>(pxp, pyp, kImageSide, [&](std::size_t at) {
          const mars::Rgb& t = picture->texels[at];
          return glm::vec3(t.r, t.g, t.b);
        });
      }
      if (params.lit) {
        const glm::vec3 normal =
            direct ? ground->normal[static_cast<std::size_t>(y) * ground_side + static_cast<std::size_t>(x)]
                   : bilinear<glm::vec3>(gxp, gyp, ground_side,
                                         [&](std::size_t at) { return ground->normal[at]; });
        const float light = std::max(0.0F, glm::dot(normal, sun));
        // The square root stands for the display's gamma.
        colour *= std::sqrt(ambient + (1.0F - ambient) * kSunGain * light);
      }
      texel[0] = to_byte(colour.x);
      texel[1] = to_byte(colour.y);
      texel[2] = to_byte(colour.z);
      texel[3] = 255;
      if (!ground->missing.empty() && ground->missing[nearest(gyp) * ground_side + nearest(gxp)]) {
        texel[3] = 0;
        out.gaps = true;
      }
    }
  }
}

ShadedTile Shader::shade(const lod::TileKey& key, int intervals, const ShadeParams& params) const {
  const int n = planet_->meta().tile.intervals();
  int levels = 0;
  while (n << levels < intervals) ++levels;
  ShadedTile out;
  out.intervals = n << levels;
  const int side = out.intervals + 1;
  out.rgba.resize(4 * static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
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

}  // namespace vpe::gl
