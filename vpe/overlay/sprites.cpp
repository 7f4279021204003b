#include "vpe/overlay/sprites.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace vpe::overlay {

SpriteLayer::SpriteLayer(std::int64_t width_px, std::int64_t height_px, std::int64_t full_circle_px)
    : width_(width_px), height_(height_px), full_circle_(full_circle_px) {}

void SpriteLayer::add(const Box& box, Paint paint) {
  const auto x = static_cast<std::int64_t>(std::floor(box.left));
  const auto y = static_cast<std::int64_t>(std::floor(box.top));
  sprites_.push_back({x,
                      y,
                      static_cast<std::int64_t>(std::ceil(box.right)) - x,
                      static_cast<std::int64_t>(std::ceil(box.bottom)) - y,
                      std::move(paint),
                      {}});
}

void SpriteLayer::fill(const Box& box, const core::Rgba& colour) {
  add(box, nullptr);
  sprites_.back().colour = colour;
}

bool SpriteLayer::is_free(const Box& box) const {
  const double width = static_cast<double>(width_);
  if (box.top < 0 || box.bottom > static_cast<double>(height_)) return false;
  if (full_circle_ == 0 && (box.left < 0 || box.right > width)) return false;
  const auto period = static_cast<double>(full_circle_);
  if (full_circle_ > 0 && box.right - box.left > period) return false;
  return std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) {
    const auto meets = [&](double shift) {
      return box.meets({other.left + shift, other.top, other.right + shift, other.bottom});
    };
    return meets(0) || (full_circle_ > 0 && (meets(period) || meets(-period)));
  });
}

void SpriteLayer::composite(const ImageRegion& region) const {
  if (region.pixels.size() !=
      static_cast<std::size_t>(region.width) * static_cast<std::size_t>(region.height)) {
    throw std::invalid_argument("a region of " + std::to_string(region.width) + "x" +
                                std::to_string(region.height) + " pixels with " +
                                std::to_string(region.pixels.size()));
  }
  for (const Sprite& sprite : sprites_) {
    composite(sprite, 0, region);
    if (full_circle_ == 0) continue;
    composite(sprite, -full_circle_, region);
    composite(sprite, full_circle_, region);
  }
}

void SpriteLayer::composite(const Sprite& sprite, std::int64_t shift, const ImageRegion& region) const {
  const std::int64_t x = sprite.x + shift;
  const std::int64_t left = std::max(x, region.x);
  const std::int64_t right = std::min(x + sprite.width, region.x + region.width);
  const std::int64_t top = std::max(sprite.y, region.y);
  const std::int64_t bottom = std::min(sprite.y + sprite.height, region.y + region.height);
  if (left >= right || top >= bottom) return;
  // Draws the whole sprite even if the region shows a part of it: Cairo's pixels may depend on clipping.
  Layer layer;
  if (sprite.paint) {
    Canvas canvas(static_cast<int>(sprite.width), static_cast<int>(sprite.height));
    sprite.paint(canvas, {static_cast<double>(sprite.x), static_cast<double>(sprite.y)});
    layer = canvas.layer();
  }
  for (std::int64_t row = top; row < bottom; ++row) {
    for (std::int64_t column = left; column < right; ++column) {
      const core::Rgba over =
          sprite.paint ? layer.pixels[static_cast<std::size_t>((row - sprite.y) * sprite.width + column - x)]
                       : sprite.colour;
      if (over.a == 0) continue;
      base::Rgb& pixel =
          region.pixels[static_cast<std::size_t>((row - region.y) * region.width + column - region.x)];
      pixel = blend(over, pixel);
    }
  }
}

}  // namespace vpe::overlay
