// Modes of motion: what keys, mouse and wheel do with the camera.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace vpe::explore {

enum class MotionMode : std::uint8_t { kOrbit, kFly, kWalk, kDrive };

// Returns every mode once, in the order of the enumeration.
std::span<const MotionMode> motion_modes();

// Returns the name of a mode: "orbit", "fly", "walk", "drive".
std::string_view to_string(MotionMode mode);
// Parses a name. Returns nullopt for other text.
std::optional<MotionMode> parse_motion_mode(std::string_view name);

// Returns what the mode does, in one line for tooltips and messages.
std::string_view meaning(MotionMode mode);

// Return the mode after and before a mode in the circle orbit, fly, walk. Drive is not in the circle: after it
// comes orbit, before it walk.
MotionMode next_mode(MotionMode mode);
MotionMode previous_mode(MotionMode mode);

}  // namespace vpe::explore
