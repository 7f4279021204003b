#include "vpe/explore/input/controls.h"

#include <algorithm>
#include <cmath>

namespace vpe::explore {

namespace {

double finite_or(double value, double otherwise) { return std::isfinite(value) ? value : otherwise; }

double joined(double sum, double next) { return std::clamp(sum + finite_or(next, 0.0), -1.0, 1.0); }

}  // namespace

bool any(const Controls& controls) {
  return controls.right != 0 || controls.up != 0 || controls.forward != 0 || controls.yaw_right != 0 ||
         controls.pitch_up != 0 || controls.roll_right != 0;
}

Controls combine(std::span<const Controls> devices) {
  Controls all;
  for (const Controls& device : devices) {
    all.right = joined(all.right, device.right);
    all.up = joined(all.up, device.up);
    all.forward = joined(all.forward, device.forward);
    all.yaw_right = joined(all.yaw_right, device.yaw_right);
    all.pitch_up = joined(all.pitch_up, device.pitch_up);
    all.roll_right = joined(all.roll_right, device.roll_right);
    all.speed = std::clamp(all.speed * finite_or(device.speed, 1.0), 0.01, 100.0);
  }
  return all;
}

double stick_rate(double deflection, double dead_zone, double curve) {
  if (!std::isfinite(deflection) || deflection <= dead_zone || dead_zone >= 1) return 0;
  return std::pow((std::min(deflection, 1.0) - dead_zone) / (1.0 - dead_zone), curve);
}

double axis_rate(double deflection, double dead_zone, double curve) {
  return std::copysign(stick_rate(std::abs(deflection), dead_zone, curve), deflection);
}

glm::dvec2 stick_rates(const glm::dvec2& deflection, double dead_zone, double curve) {
  const double length = std::hypot(deflection.x, deflection.y);
  const double rate = stick_rate(length, dead_zone, curve);
  return rate > 0 ? deflection * (rate / length) : glm::dvec2(0);
}

}  // namespace vpe::explore
