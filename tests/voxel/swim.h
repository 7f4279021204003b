// Measures how far drawn ground moves between two images of a flight.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/core/view.h"

namespace test_support {

struct RangeImage {
  vpe::core::View view;  // the whole image is drawn
  std::vector<float> range_m;

  float range(int x, int y) const {
    return range_m[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) +
                   static_cast<std::size_t>(x)];
  }
};

// Returns for each pixel of `now` how much higher its ground is drawn than in `before`, in pixels: the
// difference of radii in one direction from the planet's centre, times focal_px(now.view) / range. The radius
// in `before` is that of the triangle through three of the four pixels about the point's position there, so it
// includes what interpolation makes of terrain within a pixel.
//
// NaN where there is nothing to measure: sky; a position outside `before`; four pixels that see more than one
// surface (their ranges differ by more than 1 %, and the inverse ranges are not even along either side); a
// point more than 2 px from that triangle, which was hidden before.
std::vector<float> pops_px(const RangeImage& before, const RangeImage& now, vpe::base::ThreadPool& pool);

// Accumulates the distribution of |pop|.
class Pops {
 public:
  // Adds all values but NaN.
  void add(std::span<const float> pops_px);
  void add(const Pops& other);

  std::int64_t measured() const { return measured_; }
  double max_px() const { return max_px_; }
  // Returns the smallest bound that this share of the pops keeps, within 1/1000 px up to 8 px.
  double quantile_px(double share) const;
  // Returns the share of pops above a size.
  double share_over(double px) const;

 private:
  static constexpr int kPerPixel = 1000;
  std::vector<std::int64_t> bins_ = std::vector<std::int64_t>(8 * kPerPixel + 1);
  std::int64_t measured_ = 0;
  double max_px_ = 0;
};

}  // namespace test_support
