// Coverage of an image's pixels by thin lines. Positions are in pixels: x right, y down, pixel centres at +0.5.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "vpe/overlay/stroke_kernel.h"

namespace vpe::overlay {

// Wider lines take longer than Cairo's strokes.
inline constexpr double kWidestThinLine_px = 6;

// Holds how much of each pixel strokes cover, 0 to 255. Ends are cut off square, corners are round. Along straight pieces the
// coverage is exact but for rounding; at corners, ends and crossings of a line it is that of the piece that covers most of the
// pixel, so that a line that comes back within a pixel of itself may be up to a half too light there. Bits are equal with any
// instruction set.
//
// Typical usage:
//   StrokeMask mask(width, height);
//   mask.add(points, false, 1.5);
//   mask.take_rows([&](int y, int x, std::span<const std::uint8_t> coverage) { ... });
class StrokeMask {
 public:
  StrokeMask(int width, int height);
  StrokeMask(const StrokeMask&) = delete;
  StrokeMask& operator=(const StrokeMask&) = delete;

  // Adds a line of at most kWidestThinLine_px. What lies outside of the image is left out, and so are points that are not finite; fewer
  // than two different points cover nothing.
  void add(std::span<const glm::dvec2> points, bool closed, double width_px);

  // Calls use(y, x, coverage) for each row that was touched, from its first touched pixel x on, and empties the mask.
  template <class Use>
  void take_rows(const Use& use) {
    for (int y = rows_.top; y < rows_.bottom; ++y) {
      TouchedRow& touched = touched_[static_cast<std::size_t>(y)];
      if (touched.begin >= touched.end) continue;
      const std::span<std::uint8_t> coverage = std::span(coverage_).subspan(
          static_cast<std::size_t>(y) * rows_.stride + static_cast<std::size_t>(touched.begin),
          static_cast<std::size_t>(touched.end - touched.begin));
      use(y, touched.begin, std::span<const std::uint8_t>(coverage));
      std::ranges::fill(coverage, std::uint8_t{0});
      touched = {rows_.width, 0};
    }
    rows_.top = rows_.height;
    rows_.bottom = 0;
  }

 private:
  std::vector<std::uint8_t> coverage_;
  std::vector<TouchedRow> touched_;
  StrokeRows rows_;
  std::vector<StrokePiece> pieces_;
};

// Returns the parts of a line that strokes and gaps in turn of these lengths leave, each at least two points; without lengths, or
// where none is above 0, the whole line.
std::vector<std::vector<glm::dvec2>> dashes(std::span<const glm::dvec2> points,
                                            std::span<const double> lengths_px);

}  // namespace vpe::overlay
