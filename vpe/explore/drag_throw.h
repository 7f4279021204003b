// The motion that goes on after a drag that ended in motion, and dies off.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "mars/geodesy/pose.h"
#include "vpe/explore/foresight.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct ThrowLimits {
  static constexpr double kTime_s = 0.5;        // until the motion has died off
  static constexpr double kRest_s = 0.1;        // a longer rest before the release throws nothing
  static constexpr double kWindow_s = 0.1;      // the speed is that of this time before the last motion
  static constexpr double kOldest_s = 0.3;      // or of the last two samples, if they are not farther apart
  static constexpr double kSlowest_px_s = 150;  // of the cursor, on an image of 720 rows; slower throws nothing
  static constexpr double kShortest_px = 8;     // from the press, likewise; shorter drags are clicks
};

// Follows a drag and returns its motion at the end. Times are seconds of one clock, which only the caller reads.
class DragSamples {
 public:
  void clear() {
    samples_.clear();
    is_begun_ = false;
  }
  // Adds the cursor and the pose after a motion. Samples within 5 ms count as one: window systems deliver several
  // at once.
  void add(double time_s, glm::dvec2 xy, const mars::Pose& pose);
  // Returns the motion that a release at this time leaves, or nullopt for a rest, and for a slow or short
  // drag.
  std::optional<Motion> motion(double release_s, double image_rows) const;

 private:
  struct Sample {
    double time_s = 0;
    glm::dvec2 xy{0, 0};
    mars::Pose pose;
  };
  std::vector<Sample> samples_;  // oldest first
  bool is_begun_ = false;
  glm::dvec2 begun_xy_{0, 0};  // of the first sample after clear()
};

// Returns the pose at a time after the release. The speed begins with that of the motion and falls with the square
// of the time left to 0 at kTime_s, so that the way is that of a sixth of a second at full speed. Altitude (but above
// the ground) and roll stay. Pure.
mars::Pose thrown(const Motion& motion, double time_s, const TerrainQuery& ground);

}  // namespace vpe::explore
