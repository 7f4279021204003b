#include "panorama/viewer/sampler.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace panorama {

namespace {

glm::vec3 colour(const vpe::base::Rgb& p) {
  return {static_cast<float>(p.r), static_cast<float>(p.g), static_cast<float>(p.b)};
}

}  // namespace

Sampler::Sampler(const TiledImage& image, const PanoramaMap& map, const ImageOrigin& origin)
    : image_(image), levels_(level_grids(image.levels(), map, origin)) {}

const Tile& Sampler::tile(int level, std::int64_t column, std::int64_t row) {
  // Neighbouring tiles of neighbouring levels fall into different slots.
  Slot& slot = slots_[static_cast<std::size_t>((column & 1) | (row & 1) << 1 | (level & 3) << 2)];
  if (slot.level != level || slot.column != column || slot.row != row || slot.tile == nullptr) {
    slot.tile = image_.tile(level, column, row);
    slot.level = level;
    slot.column = column;
    slot.row = row;
  }
  return *slot.tile;
}

glm::vec3 Sampler::pixel(int level, std::int64_t x, std::int64_t y) {
  const LevelGrid& l = levels_[static_cast<std::size_t>(level)];
  x = l.wrapped(x);
  y = std::clamp(y, l.top, l.bottom);
  const std::int64_t column = x / l.size.tile_width_px;
  const std::int64_t row = y / l.size.tile_height_px;
  const Tile& t = tile(level, column, row);
  return colour(t.pixels[static_cast<std::size_t>((y - row * l.size.tile_height_px) * t.width_px + x -
                                                  column * l.size.tile_width_px)]);
}

glm::vec3 Sampler::between_pixels(int level, const glm::dvec2& at) {
  const LevelGrid& l = levels_[static_cast<std::size_t>(level)];
  const glm::dvec2 place = (at + l.origin_px) * l.scale - 0.5;
  const auto x = static_cast<std::int64_t>(std::floor(place.x));
  const auto y = static_cast<std::int64_t>(std::floor(place.y));
  const auto right = static_cast<float>(place.x - static_cast<double>(x));
  const auto below = static_cast<float>(place.y - static_cast<double>(y));
  if (x >= l.left && y >= l.top && x < l.right && y < l.bottom) {
    const std::int64_t column = x / l.size.tile_width_px;
    const std::int64_t row = y / l.size.tile_height_px;
    const std::int64_t in_x = x - column * l.size.tile_width_px;
    const std::int64_t in_y = y - row * l.size.tile_height_px;
    if (in_x + 1 < l.size.tile_width_px && in_y + 1 < l.size.tile_height_px) {
      const Tile& t = tile(level, column, row);
      const vpe::base::Rgb* p = t.pixels.data() + in_y * t.width_px + in_x;
      return glm::mix(glm::mix(colour(p[0]), colour(p[1]), right),
                      glm::mix(colour(p[t.width_px]), colour(p[t.width_px + 1]), right), below);
    }
  }
  return glm::mix(glm::mix(pixel(level, x, y), pixel(level, x + 1, y), right),
                  glm::mix(pixel(level, x, y + 1), pixel(level, x + 1, y + 1), right), below);
}

glm::vec3 Sampler::between_levels(double footprint_px, const glm::dvec2& at) {
  const int level = level_of_footprint(levels_, footprint_px);
  const int coarsest = static_cast<int>(levels_.size()) - 1;
  const double here = levels_[static_cast<std::size_t>(level)].reduction;
  if (level == coarsest || footprint_px <= here) return between_pixels(level, at);
  const double next = levels_[static_cast<std::size_t>(level) + 1].reduction;
  const double share = std::log(footprint_px / here) / std::log(next / here);
  return glm::mix(between_pixels(level, at), between_pixels(level + 1, at), static_cast<float>(share));
}

glm::vec3 Sampler::mean(const glm::dvec2& at, const glm::dvec2& across, const glm::dvec2& down) {
  const Footprint footprint = footprint_of(across, down);
  if (footprint.samples == 1) return between_levels(footprint.thin_px, at);
  const glm::dvec2& longer = glm::length(across) > glm::length(down) ? across : down;
  glm::vec3 sum(0.0F);
  for (int n = 0; n < footprint.samples; ++n)
    sum += between_levels(footprint.thin_px, at + longer * ((n + 0.5) / footprint.samples - 0.5));
  return sum / static_cast<float>(footprint.samples);
}

}  // namespace panorama
