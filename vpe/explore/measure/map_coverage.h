// Areas, lines and discs on a flat image: the share of each pixel that they cover.
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "vpe/base/rgb.h"
#include "vpe/core/image/image.h"

namespace vpe::explore {

// Collects what one feature covers, and paints it once, so that overlapping parts are not painted twice. Positions are in
// pixels; pixel centres are at +0.5. For one thread at a time.
class MapCoverage {
 public:
  MapCoverage(int width, int height);

  // Adds what lies within an odd number of rings. Each row of pixels has kRows lines, on which coverage is exact; a pixel's
  // coverage is their mean. Areas that touch leave no gap.
  void add_area(std::span<const std::vector<glm::dvec2>> rings);
  static constexpr int kRows = 4;
  // Adds a line of this width with round ends. Coverage is that of the distance of a pixel's centre, within 0.15.
  void add_line(glm::dvec2 from, glm::dvec2 to, double width_px);
  // Adds a disc.
  void add_disc(glm::dvec2 middle, double radius_px) { add_line(middle, middle, 2 * radius_px); }

  // Returns the coverage of a pixel, 0 to 1.
  double at(int x, int y) const;
  // Paints all that was added with a colour at an opacity, and forgets it.
  void paint(base::Rgb colour, double opacity, core::RgbImage& image);

 private:
  float& pixel(int x, int y);
  void add_span(int y, double from, double to);

  int width_;
  int height_;
  std::vector<float> share_;
  std::vector<std::size_t> touched_;  // pixels with a share
};

}  // namespace vpe::explore
