// Vertical alignment: removes offset and tilt of an inset relative to its base, fitted along the inset's data
// boundary.
#pragma once

#include <memory>
#include <optional>

#include "mars/geodesy/sphere.h"
#include "mars/sources/adjusted.h"
#include "mars/sources/source.h"

namespace mars {

// Describes how an inset lies above its base: by offset_m at `centre`, growing by tilt_east and tilt_north
// metres per metre of arc along the great circles east and north there (a plane in azimuthal equidistant
// coordinates).
struct VerticalAlignment {
  LonLat centre;
  double offset_m = 0;
  double tilt_east = 0;
  double tilt_north = 0;
  double radius_m = 0;        // of the sphere on which arcs are measured
  double rms_before_m = 0;    // inset minus base over the boundary
  double rms_after_m = 0;     // the same after the alignment
  std::int64_t posts = 0;     // number of boundary posts used
  std::int64_t left_out = 0;  // number of posts that kAlignmentOutlier excluded
};

// Number of robust standard deviations (1.4826 times the median absolute deviation) beyond which a post is left
// out of the fit.
inline constexpr double kAlignmentOutlier = 6;

// Fits inset - base by least squares over the inset's posts within `within_posts` of its data boundary where
// the base has data. Three rounds are made; each leaves out the posts that lie farther from the last fit (at
// first: from the median) than kAlignmentOutlier robust deviations. Looks at most at about max_posts posts of
// the inset. The result is a function of both sources alone. If the boundary lies along one line, only the
// offset is fitted. Returns nullopt if fewer than 12 posts remain or if the boundary is more than 60 degrees
// across. Throws SourceError on read errors.
std::optional<VerticalAlignment> fit_alignment(const ElevationSource& inset, const ElevationSource& base,
                                               double radius_m, double within_posts = 16,
                                               std::size_t max_posts = 1'000'000);

// Returns the height of the inset above the base at a direction.
double misalignment_m(const VerticalAlignment& alignment, const glm::dvec3& direction);

// Returns the adjustment of the inset: it subtracts misalignment_m() from heights.
HeightAdjustment alignment_adjustment(const VerticalAlignment& alignment);

// Returns the treatment that planet files store. The text identifies the planet: it must not change.
std::string to_string(const VerticalAlignment& alignment);

}  // namespace mars
