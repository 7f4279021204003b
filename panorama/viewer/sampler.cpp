#include "panorama/viewer/sampler.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace panorama {

namespace {

// Limits the samples along the longer axis of a footprint.
constexpr double kMaxPlaces = 16;

glm::vec3 colour(const vpe::base::Rgb& p) {
  return {static_cast<float>(p.r), static_cast<float>(p.g), static_cast<float>(p.b)};
}

}  // namespace

Sampler::Sampler(const TiledImage& image, const PanoramaMap& map, const ImageOrigin& origin)
    : image_(image), origin_px_(static_cast<double>(origin.x_px), static_cast<double>(origin.y_px)) {
  const ImageLevel& full = image.levels().front();
  const auto width_px = static_cast<double>(map.width_px);
  const auto height_px = static_cast<double>(map.height_px);
  const bool is_closed = width_px > map.turn_px - 1.0;
  for (const ImageLevel& size : image.levels()) {
    Level level;
    level.size = size;
    level.scale = {static_cast<double>(size.width_px) / static_cast<double>(full.width_px),
                   static_cast<double>(size.height_px) / static_cast<double>(full.height_px)};
    level.reduction = 1.0 / std::min(level.scale.x, level.scale.y);
    level.turn = is_closed ? std::llround(map.turn_px * level.scale.x) : 0;
    const auto last = [](double end) { return static_cast<std::int64_t>(std::ceil(end - 1e-6)) - 1; };
    level.left = static_cast<std::int64_t>(origin_px_.x * level.scale.x);
    level.top = static_cast<std::int64_t>(origin_px_.y * level.scale.y);
    level.right = std::clamp(last((origin_px_.x + width_px) * level.scale.x), level.left, size.width_px - 1);
    level.bottom = std::clamp(last((origin_px_.y + height_px) * level.scale.y), level.top, size.height_px - 1);
    levels_.push_back(level);
  }
}

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

std::int64_t Sampler::wrapped(const Level& level, std::int64_t x) const {
  if (level.turn > 0 && x < level.left) x += level.turn;
  if (level.turn > 0 && x > level.right) x -= level.turn;
  return std::clamp(x, level.left, level.right);
}

glm::vec3 Sampler::pixel(int level, std::int64_t x, std::int64_t y) {
  const Level& l = levels_[static_cast<std::size_t>(level)];
  x = wrapped(l, x);
  y = std::clamp(y, l.top, l.bottom);
  const std::int64_t column = x / l.size.tile_width_px;
  const std::int64_t row = y / l.size.tile_height_px;
  const Tile& t = tile(level, column, row);
  return colour(t.pixels[static_cast<std::size_t>((y - row * l.size.tile_height_px) * t.width_px + x -
                                                  column * l.size.tile_width_px)]);
}

glm::vec3 Sampler::between_pixels(int level, const glm::dvec2& at) {
  const Level& l = levels_[static_cast<std::size_t>(level)];
  const glm::dvec2 place = (at + origin_px_) * l.scale - 0.5;
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
  int level = 0;
  const int coarsest = static_cast<int>(levels_.size()) - 1;
  while (level < coarsest && levels_[static_cast<std::size_t>(level) + 1].reduction <= footprint_px) ++level;
  const double here = levels_[static_cast<std::size_t>(level)].reduction;
  if (level == coarsest || footprint_px <= here) return between_pixels(level, at);
  const double next = levels_[static_cast<std::size_t>(level) + 1].reduction;
  const double share = std::log(footprint_px / here) / std::log(next / here);
  return glm::mix(between_pixels(level, at), between_pixels(level + 1, at), static_cast<float>(share));
}

glm::vec3 Sampler::mean(const glm::dvec2& at, const glm::dvec2& across, const glm::dvec2& down) {
  const double across_px = glm::length(across);
  const double down_px = glm::length(down);
  const glm::dvec2& longer = across_px > down_px ? across : down;
  const double longest_px = std::max(across_px, down_px);
  // A sheared footprint is thinner than its shorter side.
  const double area_px = std::abs(across.x * down.y - across.y * down.x);
  const double thin_px =
      std::max({longest_px > 0.0 ? area_px / longest_px : 0.0, longest_px / kMaxPlaces, 1.0});
  const int places = static_cast<int>(std::clamp(std::ceil(longest_px / thin_px - 1e-6), 1.0, kMaxPlaces));
  if (places == 1) return between_levels(thin_px, at);
  glm::vec3 sum(0.0F);
  for (int n = 0; n < places; ++n) sum += between_levels(thin_px, at + longer * ((n + 0.5) / places - 0.5));
  return sum / static_cast<float>(places);
}

}  // namespace panorama
