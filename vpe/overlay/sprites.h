// Overlay of an image that is too large to be in memory at once: small images at fixed positions, composited
// onto any region of it. A pixel does not depend on how the image is divided into regions.
//
// Positions are in pixels of the whole image, x right, y down.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "vpe/overlay/canvas.h"
#include "vpe/overlay/label_layout.h"

namespace vpe::overlay {

// Describes a rectangle of whole pixels; `pixels` holds it row by row.
struct ImageRegion {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::span<base::Rgb> pixels;
};

// Holds sprites and boxes in use.
//
// Typical usage:
//   SpriteLayer sprites(width, height, 0);
//   if (sprites.is_free(box)) {
//     sprites.take(box);
//     sprites.add(box, [=](Canvas& c, glm::dvec2 corner) { c.text(text, centre - corner, 0, style); });
//   }
//   for (ImageRegion& region : regions) sprites.composite(region);
class SpriteLayer {
 public:
  // Draws on a canvas whose upper left corner is at `corner` of the image.
  using Paint = std::function<void(Canvas& canvas, glm::dvec2 corner)>;

  // full_circle_px > 0: the image repeats horizontally with that period, so that a sprite that extends over one
  // edge shows at the other.
  SpriteLayer(std::int64_t width_px, std::int64_t height_px, std::int64_t full_circle_px);

  // Adds a sprite above all earlier ones. What it paints outside of the box does not show.
  void add(const Box& box, Paint paint);
  // Adds a box of one colour.
  void fill(const Box& box, const core::Rgba& colour);
  bool empty() const { return sprites_.empty(); }

  // Returns true if the box lies in the image (horizontally only if the image does not repeat) and meets no box
  // in use.
  bool is_free(const Box& box) const;
  void take(const Box& box) { taken_.push_back(box); }

  // Composites the sprites onto a region. Throws std::invalid_argument if the number of pixels does not match
  // the region's size, and what Canvas throws.
  void composite(const ImageRegion& region) const;

 private:
  struct Sprite {
    std::int64_t x;
    std::int64_t y;
    std::int64_t width;
    std::int64_t height;
    Paint paint;  // empty: the box is filled with `colour`
    core::Rgba colour;
  };
  void composite(const Sprite& sprite, std::int64_t shift, const ImageRegion& region) const;

  std::int64_t width_;
  std::int64_t height_;
  std::int64_t full_circle_;
  std::vector<Sprite> sprites_;
  std::vector<Box> taken_;
};

}  // namespace vpe::overlay
