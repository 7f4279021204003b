// Views in which a named place fills the image.
#pragma once

#include "mars/geodesy/pose.h"
#include "vpe/core/appearance/gazetteer.h"
#include "vpe/explore/mouse.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct ArrivalLimits {
  static constexpr double kUnknown_m = 5000;    // diameter of places without one, as landing sites
  static constexpr double kFill = 0.7;          // of the image's shorter side
  static constexpr double kTilt_deg = -35;      // pitch for diameters up to kTilted_m
  static constexpr double kTilted_m = 200'000;  // larger places are seen more from above,
  static constexpr double kFromAbove_m = 3e6;   // and from this diameter on straight from above
};

// Returns the pose from which a place is seen at its size: north up, its middle in the middle of the image, tilted
// if it is small. The pose is above the ground. Pure.
mars::Pose arrival(const core::Place& place, const Screen& screen, const TerrainQuery& ground);

}  // namespace vpe::explore
