// Looking around from a platform whose own attitude is given, as in a flight or on a vehicle.
#pragma once

#include "mars/geodesy/pose.h"

namespace vpe::explore {

// Returns the head's angles with which the camera of a platform has the axes of `camera`: the inverse of
// mars::to_camera() in the head. Pure.
mars::HeadAngles head_of(const mars::Pose& platform, const mars::CameraPose& camera, double radius_m);

// Returns the head's angles after a turn of the view about the vertical of the place (not the platform's axis) and
// up. The horizon keeps its tilt in the image. The pitch of the view is clamped to straight up and down. Pure.
mars::HeadAngles turned_look(const mars::Pose& platform, const mars::HeadAngles& look, double yaw_deg,
                             double pitch_deg, double radius_m);

}  // namespace vpe::explore
