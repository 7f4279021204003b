// Colour of a place on the ground in an appearance, from its definition (vpe/core/appearance/shading.h,
// docs/design/appearance.md) and the planet's posts alone. Shares nothing with the renderers.
#pragma once

#include <optional>

#include "paging/surface/surface.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/core/appearance/shading.h"

namespace test_support {

struct GroundReference {
  const paging::Surface& surface;
  vpe::core::Appearance appearance;
  glm::dvec3 sun;

  GroundReference(const paging::Surface& of, const vpe::core::Appearance& appearance_of,
                  const glm::dvec3& to_sun)
      : surface(of), appearance(appearance_of), sun(to_sun) {}

  // Returns the colour, 0 to 255 but not clamped, or nullopt at the edge of a face and where tiles of two
  // depths meet.
  std::optional<glm::dvec3> at(const glm::dvec3& direction) const {
    const paging::PlanetFile& planet = surface.planet();
    const lod::TileKey key = surface.at(direction).tile;
    const int n = planet.meta().tile.intervals();
    const mars::ChartPoint place = mars::chart_on(key.face, direction);
    const lod::GridLines lines = lod::grid_lines(key, n);
    const int i = cell(lines.u, place.u);
    const int j = cell(lines.v, place.v);
    const double s = along(lines.u, i, place.u);
    const double t = along(lines.v, j, place.v);
    const std::int64_t first_i = std::int64_t{key.i} * n + i;
    const std::int64_t first_j = std::int64_t{key.j} * n + j;
    const Grid grid{key.face, key.level, n};
    const bool flat = appearance.shading == vpe::core::Shading::kFlat;
    const auto post = [&](int a, int b) { return this->post(grid, first_i + a, first_j + b); };
    double height_m = 0;
    glm::dvec3 normal(0), image_rgb(0), up = glm::normalize(direction), from = direction;
    if (flat || is_unlit_elevation()) {
      const bool lower = s >= t;
      const auto p00 = post(0, 0), p11 = post(1, 1), other = lower ? post(1, 0) : post(0, 1);
      if (!p00 || !p11 || !other) return std::nullopt;
      const glm::dvec3 a = drawn(*p00), b = drawn(*other), c = drawn(*p11);
      normal = glm::normalize(glm::cross(b - a, c - a));
      if (glm::dot(normal, up) < 0) normal = -normal;
      if (flat) {
        from = (a + b + c) / 3.0;
        up = glm::normalize(from);
        height_m = (p00->height_m + other->height_m + p11->height_m) / 3;
        image_rgb = image(up);
      } else {
        height_m =
            lower
                ? p00->height_m + s * (other->height_m - p00->height_m) + t * (p11->height_m - other->height_m)
                : p00->height_m + t * (other->height_m - p00->height_m) + s * (p11->height_m - other->height_m);
      }
    } else {
      for (int b = 0; b < 2; ++b) {
        for (int a = 0; a < 2; ++a) {
          const auto here = post(a, b);
          const auto east = post(a + 1, b), west = post(a - 1, b), north = post(a, b + 1),
                     south = post(a, b - 1);
          if (!here || !east || !west || !north || !south) return std::nullopt;
          const double weight = (a == 1 ? s : 1 - s) * (b == 1 ? t : 1 - t);
          normal +=
              weight * glm::normalize(glm::cross(drawn(*east) - drawn(*west), drawn(*north) - drawn(*south)));
          height_m += weight * here->height_m;
          if (appearance.colour == vpe::core::Colour::kImage) image_rgb += weight * image(here->direction);
        }
      }
      normal = glm::normalize(normal);
      if (appearance.mode == vpe::core::Mode::kTextured) image_rgb = image(up);
    }
    return painted(height_m, normal, up, image_rgb);
  }

  // Returns the planet file's image, linear between texels.
  glm::dvec3 image(const glm::dvec3& direction) const {
    const paging::PlanetFile& planet = surface.planet();
    const auto key = planet.image_key(lod::tile_at(mars::chart_point(direction), lod::kMaxLevel));
    if (!key) return glm::dvec3(0);
    if (!image_tile_ || image_key_ != *key) image_tile_ = planet.image(*key);
    image_key_ = *key;
    const mars::ChartPoint place = mars::chart_on(key->face, direction);
    const auto texel = [&](double x, std::int32_t index) {
      return (mars::face_parameter(x) * (1 << key->level) - index) * paging::kImageIntervals;
    };
    const double x = texel(place.u, key->i), y = texel(place.v, key->j);
    const auto get = [&](double a, double b) {
      const auto clamped = [](double c) {
        return static_cast<std::size_t>(std::clamp(c, 0.0, double{paging::kImageIntervals}));
      };
      const vpe::base::Rgb c = image_tile_->texels[clamped(b) * (paging::kImageIntervals + 1) + clamped(a)];
      const auto stretched = [this](double v) {
        if (appearance.image_low == 0 && appearance.image_high == 255 && appearance.image_gamma == 1) return v;
        const double share = (v - appearance.image_low) / (appearance.image_high - appearance.image_low);
        return std::floor(255 * std::pow(std::clamp(share, 0.0, 1.0), 1 / appearance.image_gamma) + 0.5);
      };
      return glm::dvec3(stretched(c.r), stretched(c.g), stretched(c.b));
    };
    const double i = std::floor(x), j = std::floor(y);
    return glm::mix(glm::mix(get(i, j), get(i + 1, j), x - i),
                    glm::mix(get(i, j + 1), get(i + 1, j + 1), x - i), y - j);
  }

 private:
  mutable std::optional<paging::ImageTile> image_tile_;
  mutable lod::TileKey image_key_;

  struct Grid {
    mars::Face face;
    int level;
    int intervals;
  };
  struct Post {
    glm::dvec3 direction;
    double height_m;
  };

  bool is_unlit_elevation() const {
    return appearance.mode == vpe::core::Mode::kUnlit && appearance.colour == vpe::core::Colour::kElevation;
  }

  static int cell(const std::vector<double>& line, double x) {
    int k = 0;
    while (k + 2 < static_cast<int>(line.size()) && line[static_cast<std::size_t>(k + 1)] <= x) ++k;
    return k;
  }
  static double along(const std::vector<double>& line, int k, double x) {
    const auto at = static_cast<std::size_t>(k);
    return (x - line[at]) / (line[at + 1] - line[at]);
  }

  std::optional<Post> post(const Grid& grid, std::int64_t i, std::int64_t j) const {
    const std::int64_t all = std::int64_t{grid.intervals} << grid.level;
    if (i < 1 || j < 1 || i >= all || j >= all) return std::nullopt;
    const auto line = [&](std::int64_t k) {
      const auto tile =
          static_cast<std::int32_t>(std::min<std::int64_t>(k / grid.intervals, (all - 1) / grid.intervals));
      const lod::TileKey key{grid.face, grid.level, tile, tile};
      return std::pair(lod::grid_lines(key, grid.intervals),
                       static_cast<std::size_t>(k - std::int64_t{tile} * grid.intervals));
    };
    const auto [lines_u, x] = line(i);
    const auto [lines_v, y] = line(j);
    const glm::dvec3 direction = mars::chart_direction(grid.face, lines_u.u[x], lines_v.v[y]);
    const paging::SurfacePoint found = surface.at(direction);
    if (found.tile.level != grid.level) return std::nullopt;
    return Post{direction, found.height_m};
  }

  glm::dvec3 drawn(const Post& post) const {
    return post.direction * (surface.planet_radius_m() + appearance.exaggeration * post.height_m);
  }

  glm::dvec3 painted(double height_m, const glm::dvec3& normal, const glm::dvec3& up,
                     const glm::dvec3& image_rgb) const {
    using vpe::core::Colour;
    using vpe::core::Mode;
    const auto shown = [&]() -> glm::dvec3 {
      if (appearance.colour == Colour::kNone) return {178, 142, 112};
      if (appearance.colour == Colour::kImage) return image_rgb;
      const vpe::core::ColourScale scale(appearance);
      if (appearance.colour == Colour::kElevation) return scale(height_m);
      const glm::dvec3 east = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), up));
      const glm::dvec3 north = glm::cross(up, east);
      if (appearance.colour == Colour::kSlope) return scale(std::acos(glm::dot(normal, up)) * 180 / mars::kPi);
      const double angle = std::atan2(glm::dot(normal, east), glm::dot(normal, north)) * 180 / mars::kPi;
      return scale(angle < 0 ? angle + 360 : angle);
    };
    glm::dvec3 c = appearance.mode == Mode::kLit ? glm::dvec3(178, 142, 112) : shown();
    if (appearance.mode == Mode::kTextured)
      c = appearance.colourise && appearance.colour != Colour::kNone ? colourised(image_rgb, shown())
                                                                     : image_rgb;
    if (appearance.mode == Mode::kUnlit || appearance.light == vpe::core::Light::kOff) return c;
    return c *
           std::sqrt(appearance.sun_ambient + appearance.sun_diffuse * std::max(0.0, glm::dot(normal, sun)));
  }

  // Keeps the largest channel of the image. The other channels keep their ratios to it in the colour.
  static glm::dvec3 colourised(const glm::dvec3& image_rgb, const glm::dvec3& c) {
    const double value = std::max({image_rgb.x, image_rgb.y, image_rgb.z});
    return c * (value / std::max({c.x, c.y, c.z}));
  }
};

}  // namespace test_support
