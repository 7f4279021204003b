// Regions of interest, which the user wants finer or coarser than the rest.
#pragma once

namespace vpe::core {

struct InterestLimits {
  static constexpr double kMaxRadius_m = 1e8;
  static constexpr int kMaxLevels = 30;
};

// A circle on the ground, with the levels of detail that it gets in addition (negative: fewer).
struct InterestRegion {
  double lon_deg = 0;   // of its centre; any finite number
  double lat_deg = 0;   // -90..90
  double radius_m = 0;  // along the planet's sphere, 0..kMaxRadius_m
  int levels = 0;       // -kMaxLevels..kMaxLevels; larger: finer, slower

  bool operator==(const InterestRegion&) const = default;
};

}  // namespace vpe::core
