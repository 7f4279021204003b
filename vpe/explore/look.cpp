#include "vpe/explore/look.h"

#include <glm/geometric.hpp>

#include "vpe/explore/steer.h"

namespace vpe::explore {

mars::HeadAngles head_of(const mars::Pose& platform, const mars::CameraPose& camera, double radius_m) {
  const mars::Axes axes = mars::to_camera(platform, radius_m).axes;
  // At longitude and latitude 0, up, east and north are the axes of the body-fixed frame.
  const auto local = [&axes](const glm::dvec3& v) {
    return glm::dvec3(glm::dot(v, axes.up), glm::dot(v, axes.right), glm::dot(v, axes.forward));
  };
  const mars::CameraPose head{{radius_m, 0, 0},
                              {local(camera.axes.right), local(camera.axes.up), local(camera.axes.forward)}};
  const mars::Pose pose = mars::to_pose(head, radius_m);
  return {pose.yaw_deg, pose.pitch_deg, pose.roll_deg};
}

mars::HeadAngles turned_look(const mars::Pose& platform, const mars::HeadAngles& look, double yaw_deg,
                             double pitch_deg, double radius_m) {
  const mars::Pose seen = mars::to_pose(mars::to_camera(platform, look, radius_m), radius_m);
  return head_of(platform, mars::to_camera(rotated(seen, yaw_deg, pitch_deg, 0.0), radius_m), radius_m);
}

}  // namespace vpe::explore
