#include "vpe/overlay/sprites.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace vpe::overlay {

SpriteLayer::SpriteLayer(std::int64_t width_px, std::int64_t height_px, std::int64_t turn_px)
    : width_(width_px), height_(height_px), turn_(turn_px) {}

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
  if (turn_ == 0 && (box.left < 0 || box.right > width)) return false;
  const auto turn = static_cast<double>(turn_);
  if (turn_ > 0 && box.right - box.left > turn) return false;
  return std::none_of(taken_.begin(), taken_.end(), [&](const Box& other) {
    const auto meets = [&](double shift) {
      return box.meets({other.left + shift, other.top, other.right + shift, other.bottom});
    };
    return meets(0) || (turn_ > 0 && (meets(turn) || meets(-turn)));
  });
}

void SpriteLayer::lay(const ImageRegion& part) const {
  if (part.pixels.size() != static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height)) {
    throw std::invalid_argument("a part of " + std::to_string(part.width) + "x" + std::to_string(part.height) +
                                " pixels with " + std::to_string(part.pixels.size()));
  }
  for (const Sprite& sprite : sprites_) {
    lay(sprite, 0, part);
    if (turn_ == 0) continue;
    lay(sprite, -turn_, part);
    lay(sprite, turn_, part);
  }
}

void SpriteLayer::lay(const Sprite& sprite, std::int64_t shift, const ImageRegion& part) const {
  const std::int64_t x = sprite.x + shift;
  const std::int64_t left = std::max(x, part.x);
  const std::int64_t right = std::min(x + sprite.width, part.x + part.width);
  const std::int64_t top = std::max(sprite.y, part.y);
  const std::int64_t bottom = std::min(sprite.y + sprite.height, part.y + part.height);
  if (left >= right || top >= bottom) return;
  // Never cut at the part's edges: what Cairo makes of a shape may depend on where it ends.
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
      base::Rgb& pixel = part.pixels[static_cast<std::size_t>((row - part.y) * part.width + column - part.x)];
      pixel = blend(over, pixel);
    }
  }
}

}  // namespace vpe::overlay
