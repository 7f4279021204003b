// Posts of an inset that cannot be right by what lies below it.
#pragma once

#include <cstdint>
#include <memory>

#include "mars/geodesy/sphere.h"
#include "mars/sources/adjusted.h"
#include "mars/sources/source.h"

namespace mars {

struct OutlierOptions {
  double floor_m = 150;     // differences up to this are always taken as terrain,
  double relief_share = 1;  // and up to this share of the base's relief around the place,
  double slope = 0.6;       // and up to what such a slope makes of half a base post
};

// A post is implausible when it lies farther from the base than floor_m, than relief_share times the range of the
// base's heights within one base post of it (eight places around), and than a slope of `slope` over half a base
// post: a base with posts 7 km apart cannot contradict a peak of 2 km. Where the base has no data nothing is.
struct OutlierReport {
  std::int64_t posts = 0;  // compared
  std::int64_t implausible = 0;
  double worst_m = 0;  // inset less base, the largest by size
  LonLat worst_at;
};

// Both in the same datum. Compares at most about max_posts posts. Throws SourceError on read errors.
OutlierReport find_blunders(const ElevationSource& inset, const ElevationSource& base, double radius_m,
                            const OutlierOptions& options = {}, std::size_t max_posts = 400'000);

// Sets implausible heights to NaN. `base` is kept alive by the mask.
PostMask blunder_mask(std::shared_ptr<const ElevationSource> base, double radius_m,
                      const OutlierOptions& options);

}  // namespace mars
