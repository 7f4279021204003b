// What is laid over a picture that is too large to be held at once: small pictures at fixed places, laid over
// any part of it. A pixel is the same however the picture is cut into parts.
//
// Places are in pixels of the whole picture, x right, y down.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "vpe/overlay/canvas.h"
#include "vpe/overlay/label_layout.h"

namespace vpe::overlay {

// Whole pixels of the picture, row by row in `pixels`.
struct PicturePart {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t width = 0;
  std::int64_t height = 0;
  std::span<base::Rgb> pixels;
};

class Decals {
 public:
  // Draws on a canvas whose upper left corner is at `corner` of the picture.
  using Paint = std::function<void(Canvas& canvas, glm::dvec2 corner)>;

  // turn_px > 0: the picture's left edge follows its right one at that width, so that what reaches over one
  // edge shows at the other.
  Decals(std::int64_t width_px, std::int64_t height_px, std::int64_t turn_px);

  // The first is lowest. What is painted outside of the box does not show.
  void add(const Box& box, Paint paint);
  // One colour.
  void fill(const Box& box, const core::Rgba& colour);
  bool empty() const { return decals_.empty(); }

  // Whether the box lies in the picture (of a whole turn: in its rows), off everything taken.
  bool is_free(const Box& box) const;
  void take(const Box& box) { taken_.push_back(box); }

  // Throws std::invalid_argument when there are not as many pixels as the part has, and what Canvas throws.
  void lay(const PicturePart& part) const;

 private:
  struct Decal {
    std::int64_t x;
    std::int64_t y;
    std::int64_t width;
    std::int64_t height;
    Paint paint;  // left out: all of `colour`
    core::Rgba colour;
  };
  void lay(const Decal& decal, std::int64_t shift, const PicturePart& part) const;

  std::int64_t width_;
  std::int64_t height_;
  std::int64_t turn_;
  std::vector<Decal> decals_;
  std::vector<Box> taken_;
};

}  // namespace vpe::overlay
