// Taking offset and tilt out of an inset, by its rim.
#pragma once

#include <memory>
#include <optional>

#include "mars/geodesy/sphere.h"
#include "mars/sources/adjusted.h"
#include "mars/sources/source.h"

namespace mars {

// What an inset lies above its base: offset_m at `centre`, growing by tilt_east and tilt_north metres a metre
// of arc along the great circles east and north there (an azimuthal equidistant plane).
struct VerticalAlignment {
  LonLat centre;
  double offset_m = 0;
  double tilt_east = 0;
  double tilt_north = 0;
  double radius_m = 0;      // of the sphere that arcs are measured on
  double rms_before_m = 0;  // inset less base over the rim
  double rms_after_m = 0;
  std::int64_t posts = 0;     // of the rim that were used
  std::int64_t left_out = 0;  // farther from the fit than kLevelOutlier robust deviations
};

inline constexpr double kAlignmentOutlier = 6;

// Least squares of inset - base over the inset's posts within `within_posts` of its rim where the base has
// data, in three rounds, each without the posts that lie farther from the last one (at first: from the median)
// than kLevelOutlier times its median absolute deviation times 1.4826. Of at most about max_posts posts of the
// inset; a function of both sources alone. Nothing when fewer than 12 posts remain, or the rim is more than 60
// degrees across or all along one line (then only the offset is fitted). Throws SourceError on read errors.
std::optional<VerticalAlignment> fit_alignment(const ElevationSource& inset, const ElevationSource& base,
                                               double radius_m, double within_posts = 16,
                                               std::size_t max_posts = 1'000'000);

// Its height above the base at a direction.
double height_m(const VerticalAlignment& level, const glm::dvec3& direction);

// Takes that from heights, and says so in words.
Adjust aligning(const VerticalAlignment& level);
std::string to_string(const VerticalAlignment& level);

}  // namespace mars
