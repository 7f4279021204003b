// Outliers: posts of an inset that contradict the base below it, as blunders of stereo correlation do.
#pragma once

#include <cstdint>
#include <memory>

#include "mars/geodesy/sphere.h"
#include "mars/sources/adjusted.h"
#include "mars/sources/source.h"

namespace mars {

// Defines an outlier: a post that differs from the base by more than each of the three bounds below. Smaller
// values find more outliers, but also take steep ground for them; larger values miss blunders. Where the base
// has nodata, no post is an outlier.
struct OutlierOptions {
  double floor_m = 150;  // difference that is always accepted
  // Accepted difference relative to the range of the base's heights within one base post of the place (eight
  // samples around it).
  double relief_share = 1;
  // Slope of the ground that is accepted over half a base post: a base with posts 7 km apart cannot contradict
  // a peak of 2 km.
  double slope = 0.6;
};

struct OutlierReport {
  std::int64_t posts = 0;        // number of posts compared
  std::int64_t implausible = 0;  // number of outliers
  double worst_m = 0;            // inset minus base at the largest outlier by magnitude
  LonLat worst_at;
};

// Compares at most about max_posts posts of the inset with the base. Both must have the same datum. Throws
// SourceError on read errors.
OutlierReport find_outliers(const ElevationSource& inset, const ElevationSource& base, double radius_m,
                            const OutlierOptions& options = {}, std::size_t max_posts = 400'000);

// Returns a mask that sets the heights of outliers to NaN. The mask keeps `base` alive.
PostMask outlier_mask(std::shared_ptr<const ElevationSource> base, double radius_m,
                      const OutlierOptions& options);

}  // namespace mars
