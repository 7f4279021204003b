// A walker on the surface as drawn: eyes at the height of a man, speed by the slope, momentum.
//
// Speed: Tobler's hiking function (W. Tobler, Three presentations on geographical analysis and modeling, NCGIA
// technical report 93-1, 1993): 6 km/h * exp(-3.5 |rise / run + 0.05|), that is 1.4 m/s on level ground, 1.67 m/s
// on a slope of 3 degrees downwards, 0.3 m/s on 25 degrees upwards. Two limits are added: the walker does not climb
// slopes of more than kSteepest_deg, and descends with at least kScramble_m_s, so that every place can be left.
//
// Typical usage:
//   Walker walker{standing(pose, ground), {}};
//   walker = walked(walker, controls, dt_s, ground);  // in each frame
#pragma once

#include <glm/vec2.hpp>

#include "mars/geodesy/pose.h"
#include "vpe/explore/input/controls.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

struct WalkLimits {
  static constexpr double kEye_m = 1.7;         // height of the eye above the ground that it comes to
  static constexpr double kLeastEye_m = 1.0;    // least height of the eye above the ground, in every frame
  static constexpr double kSteepest_deg = 35;   // slope in the direction of walking that is not climbed
  static constexpr double kScramble_m_s = 0.3;  // least speed downwards
  static constexpr double kFastest = 10;        // limit of Controls::speed
  static constexpr double kBase_m = 1;          // distance ahead over which the slope is measured
  static constexpr double kStarts_s = 0.1;      // time constant of the speed
  static constexpr double kSlides_s = 0.3;      // time constant of the speed before a slope that is too steep
  static constexpr double kFollows_s = 0.12;    // time constant of the eye's height
};

// Holds a walker. The pose is that of the eye.
struct Walker {
  mars::Pose pose;
  glm::dvec2 velocity_m_s{0, 0};  // to the right and ahead
  bool is_settled = true;         // the eye is at its height above the ground
  bool is_blocked = false;        // by a slope that is too steep
};

// Returns the speed on a slope (rise over run in the direction of walking, positive upwards), metres a second;
// 0 beyond the limit. Pure.
double stride_m_s(double slope);

// Returns the pose with the eye at its height above the ground, without roll. One query of the ground.
mars::Pose standing(const mars::Pose& pose, const TerrainQuery& ground);

// Walks for dt_s seconds (at most SteerLimits::kLongestStep_s): `forward` and `right` along the horizon whatever
// the pitch, yaw and pitch turn the eye in place. Controls::speed multiplies the stride. `up` and roll are
// ignored. The eye is at least kLeastEye_m above the ground afterwards. At most three queries of the ground. Pure.
Walker walked(const Walker& walker, const Controls& controls, double dt_s, const TerrainQuery& ground);

// Returns true if the next step without controls changes the pose.
bool is_moving(const Walker& walker);

}  // namespace vpe::explore
