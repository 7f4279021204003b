// Flying to a place by itself: after a double click, a click on the map, a bookmark.
#pragma once

#include "mars/geodesy/pose.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct FlyToLimits {
  static constexpr double kShortest_s = 0.8;
  static constexpr double kLongest_s = 4;
};

// A way from one pose to another: along the great circle, over an arc that rises with its length so that both
// ends are in sight in the middle, eased at both ends; angles the short way round. Immutable, pure.
class FlyTo {
 public:
  FlyTo(const mars::Pose& from, const mars::Pose& to, const TerrainQuery& ground);

  double duration_s() const { return duration_s_; }
  // Clear of the ground in between; at the end, and after it, `to` itself.
  mars::Pose at(double time_s, const TerrainQuery& ground) const;

 private:
  mars::Pose from_;
  mars::Pose to_;
  double hump_ = 0;  // of the logarithm of the height, in the middle
  double duration_s_ = 0;
};

}  // namespace vpe::explore
