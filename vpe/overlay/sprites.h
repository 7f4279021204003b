// What is laid over an image that is too large to be held at once: small images at fixed places, laid over
// any part of it. A pixel is the same however the image is cut into parts.
//
// Places are in pixels of the whole image, x right, y down.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "vpe/overlay/canvas.h"
#include "vpe/overlay/label_layout.h"

namespace vpe::overlay {

// Whole pixels of the image, row by row in `pixels`.
struct ImageRegion {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::span<base::Rgb> pixels;
};

class SpriteLayer {
 public:
  // Draws on a canvas whose upper left corner is at `corner` of the image.
  using Paint = std::function<void(Canvas& canvas, glm::dvec2 corner)>;

  // turn_px > 0: the image's left edge follows its right one at that width, so that what reaches over one
  // edge shows at the other.
  SpriteLayer(std::int64_t width_px, std::int64_t height_px, std::int64_t turn_px);

  // The first is lowest. What is painted outside of the box does not show.
  void add(const Box& box, Paint paint);
  // One colour.
  void fill(const Box& box, const core::Rgba& colour);
  bool empty() const { return sprites_.empty(); }

  // Whether the box lies in the image (of a whole turn: in its rows), off everything taken.
  bool is_free(const Box& box) const;
  void take(const Box& box) { taken_.push_back(box); }

  // Throws std::invalid_argument when there are not as many pixels as the part has, and what Canvas throws.
  void lay(const ImageRegion& part) const;

 private:
  struct Sprite {
    std::int64_t x;
    std::int64_t y;
    std::int64_t width;
    std::int64_t height;
    Paint paint;  // left out: all of `colour`
    core::Rgba colour;
  };
  void lay(const Sprite& sprite, std::int64_t shift, const ImageRegion& part) const;

  std::int64_t width_;
  std::int64_t height_;
  std::int64_t turn_;
  std::vector<Sprite> sprites_;
  std::vector<Box> taken_;
};

}  // namespace vpe::overlay
