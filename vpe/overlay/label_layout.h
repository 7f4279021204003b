// The image as a sheet to draw on: sizes that suit it, and which places are taken.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "vpe/overlay/canvas.h"

namespace vpe::overlay {

struct Box {
  double left, top, right, bottom;

  static Box about(glm::dvec2 centre, TextSize size, double angle_rad = 0);  // that holds the turned box
  Box grown(double by_px) const { return {left - by_px, top - by_px, right + by_px, bottom + by_px}; }
  bool meets(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
};

inline constexpr Ink kWhite{1, 1, 1, 1};
inline constexpr Ink kShade{0, 0, 0, 0.65};

class LabelLayout {
 public:
  explicit LabelLayout(Canvas& canvas);
  // Of a part of an image, where a pixel at 720 rows is `unit` pixels.
  LabelLayout(Canvas& canvas, double unit);

  Canvas& canvas() { return canvas_; }
  // Pixels that are one pixel at 720 rows, and the least that can be seen where that matters.
  double px(double at_720) const { return unit_ * at_720; }
  double line_px(double at_720) const;
  Font font(double at_720 = 16, bool bold = false) const;
  double margin_px() const { return px(16); }

  // What is left of the image for what stands at its edges.
  const Box& area() const { return area_; }
  void cut_top(double px) { area_.top += px; }
  void cut_bottom(double px) { area_.bottom -= px; }

  // Whether the box lies in the area, off everything taken.
  bool is_free(const Box& box) const;
  void take(const Box& box) { taken_.push_back(box); }
  const std::vector<Box>& taken() const { return taken_; }

  // A line of text in white with a dark halo.
  void label(std::string_view text, glm::dvec2 centre, const Font& font);
  // Lines of `ink` on wider ones of `halo`.
  void outlined(const std::vector<glm::dvec2>& points, double width_px, const Ink& ink, const Ink& halo);

 private:
  Canvas& canvas_;
  double unit_;
  Box area_;
  std::vector<Box> taken_;
};

}  // namespace vpe::overlay
