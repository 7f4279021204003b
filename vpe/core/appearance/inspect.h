// How the inspector paints levels of detail.
#pragma once

#include <array>
#include <string_view>

#include "mars/sources/source.h"

namespace vpe::core {

// People count levels as in 1992: 1 is the coarsest (a whole cube face), N the finest.
constexpr int shown_level(int level) { return level + 1; }

struct LevelColour {
  std::string_view name;
  base::Rgb colour;
};

// Neighbouring levels differ in hue and in brightness; the order starts again after the last.
inline constexpr std::array<LevelColour, 8> kLevelColours{{{"red", {230, 50, 40}},
                                                           {"yellow", {250, 225, 70}},
                                                           {"blue", {40, 90, 220}},
                                                           {"orange", {250, 150, 40}},
                                                           {"green", {40, 150, 60}},
                                                           {"pink", {250, 150, 200}},
                                                           {"purple", {130, 50, 170}},
                                                           {"cyan", {100, 230, 230}}}};

constexpr const LevelColour& level_colour(int level) {
  return kLevelColours[static_cast<std::size_t>(level) % kLevelColours.size()];
}

}  // namespace vpe::core
