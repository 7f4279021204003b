// Layout of text and symbols on an image: sizes that follow the image's size, and boxes that are in use.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "vpe/overlay/canvas.h"

namespace vpe::overlay {

struct Box {
  double left, top, right, bottom;

  // Returns the smallest upright box that contains a box rotated about its centre.
  static Box about(glm::dvec2 centre, TextSize size, double angle_rad = 0);
  Box grown(double by_px) const { return {left - by_px, top - by_px, right + by_px, bottom + by_px}; }
  bool meets(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

inline constexpr Ink kWhite{1, 1, 1, 1};
inline constexpr Ink kShade{0, 0, 0, 0.65};

// Draws labels and lines on a canvas and records which boxes are in use, so that labels do not overlap.
//
// Typical usage:
//   LabelLayout layout(canvas);
//   const Box box = Box::about(centre, canvas.measure(text, layout.font()));
//   if (layout.is_free(box)) {
//     layout.take(box);
//     layout.label(text, centre, layout.font());
//   }
class LabelLayout {
 public:
  explicit LabelLayout(Canvas& canvas);
  // Lays out a part of an image. `unit` is the number of pixels for each pixel of an image with 720 rows.
  LabelLayout(Canvas& canvas, double unit);

  Canvas& canvas() { return canvas_; }
  // Converts a length from an image with 720 rows. line_px() and font() do not go below a visible minimum.
  double px(double at_720) const { return unit_ * at_720; }
  double line_px(double at_720) const;
  Font font(double at_720 = 16, bool bold = false) const;
  double margin_px() const { return px(16); }

  // Returns the area available to symbols that stand at the edges of the image.
  const Box& area() const { return area_; }
  void cut_top(double px) { area_.top += px; }
  void cut_bottom(double px) { area_.bottom -= px; }

  // Returns true if the box lies inside area() and meets no box in use.
  bool is_free(const Box& box) const;
  void take(const Box& box) { taken_.push_back(box); }
  const std::vector<Box>& taken() const { return taken_; }

  // Draws a line of white text with a dark halo.
  void label(std::string_view text, glm::dvec2 centre, const Font& font);
  // Draws lines of `ink` on wider lines of `halo`.
  void outlined(const std::vector<glm::dvec2>& points, double width_px, const Ink& ink, const Ink& halo);

 private:
  Canvas& canvas_;
  double unit_;
  Box area_;
  std::vector<Box> taken_;
};

}  // namespace vpe::overlay
