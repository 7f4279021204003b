// Automatic flight to a pose, after a double click, a click on the map, or a bookmark.
#pragma once

#include "mars/geodesy/pose.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct FlyToLimits {
  static constexpr double kShortest_s = 0.8;
  static constexpr double kLongest_s = 4;
};

// Interpolates between two poses along the great circle. The path rises with its length, so that both ends are
// in sight in the middle, and is eased at both ends. Angles take the shorter direction. Immutable.
class FlyTo {
 public:
  FlyTo(const mars::Pose& from, const mars::Pose& to, const TerrainQuery& ground);

  double duration_s() const { return duration_s_; }
  // Returns the pose at a time: above the ground on the way, and exactly `to` at the end and later.
  mars::Pose at(double time_s, const TerrainQuery& ground) const;

 private:
  mars::Pose from_;
  mars::Pose to_;
  double climb_ = 0;  // of the logarithm of the height, in the middle
  double duration_s_ = 0;
};

}  // namespace vpe::explore
