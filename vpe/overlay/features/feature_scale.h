// Sizes of features in an image, by their styles.
#pragma once

#include <algorithm>

#include "mars/vector/feature_style.h"

namespace vpe::overlay {

// Describes how large ground appears in an image.
struct FeatureScale {
  double unit = 1;      // pixels for each pixel of an image with 720 rows
  double focal_px = 1;  // a metre across the line of sight, d metres away, covers focal_px / d pixels

  // Returns the metres across the line of sight that a pixel of an image with 720 rows covers.
  double metres_a_pixel(double distance_m) const { return distance_m * unit / focal_px; }
  // Returns whether a feature is drawn where it is this far away.
  bool shows(const mars::FeatureStyle& style, double distance_m) const {
    const double metres = metres_a_pixel(distance_m);
    return metres >= style.min_scale_m && metres < style.max_scale_m;
  }
  // Returns whether it may be drawn somewhere between two distances.
  bool may_show(const mars::FeatureStyle& style, double least_m, double most_m) const {
    return metres_a_pixel(most_m) >= style.min_scale_m && metres_a_pixel(least_m) < style.max_scale_m;
  }
  // Returns a length of a style in pixels.
  double length_px(const mars::StyleLength& length, double distance_m) const {
    return length.on_ground ? length.value * focal_px / std::max(distance_m, 1e-3) : length.value * unit;
  }
};

}  // namespace vpe::overlay
