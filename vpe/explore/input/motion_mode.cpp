#include "vpe/explore/input/motion_mode.h"

#include <array>

namespace vpe::explore {

namespace {

struct ModeInfo {
  MotionMode mode;
  std::string_view name;
  std::string_view meaning;
};

constexpr std::array kModeInfos{
    ModeInfo{MotionMode::kOrbit, "orbit", "drag holds the ground, W follows the view"},
    ModeInfo{MotionMode::kFly, "fly", "W keeps the height, drag looks around, wheel sets the speed"},
    ModeInfo{MotionMode::kWalk, "walk", "on foot, eyes 1.7 m above the ground; Shift runs"},
    ModeInfo{MotionMode::kDrive, "drive", "a vehicle on the ground; A and D steer"},
};
constexpr std::array kModes{MotionMode::kOrbit, MotionMode::kFly, MotionMode::kWalk, MotionMode::kDrive};

const ModeInfo& info_of(MotionMode mode) { return kModeInfos[static_cast<std::size_t>(mode)]; }

}  // namespace

std::span<const MotionMode> motion_modes() { return kModes; }
std::string_view to_string(MotionMode mode) { return info_of(mode).name; }
std::string_view meaning(MotionMode mode) { return info_of(mode).meaning; }

std::optional<MotionMode> parse_motion_mode(std::string_view name) {
  for (const ModeInfo& known : kModeInfos)
    if (known.name == name) return known.mode;
  return std::nullopt;
}

MotionMode next_mode(MotionMode mode) {
  switch (mode) {
    case MotionMode::kOrbit: return MotionMode::kFly;
    case MotionMode::kFly: return MotionMode::kWalk;
    case MotionMode::kWalk:
    case MotionMode::kDrive: break;
  }
  return MotionMode::kOrbit;
}

MotionMode previous_mode(MotionMode mode) {
  switch (mode) {
    case MotionMode::kOrbit:
    case MotionMode::kDrive: return MotionMode::kWalk;
    case MotionMode::kFly: return MotionMode::kOrbit;
    case MotionMode::kWalk: break;
  }
  return MotionMode::kFly;
}

}  // namespace vpe::explore
