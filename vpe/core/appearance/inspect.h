// The colours of levels of detail for `inspect=levels`.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "vpe/base/rgb.h"

namespace vpe::core {

struct LevelColour {
  std::string_view name;
  base::Rgb colour;
};

// The colours of levels 0, 1, ...; after the last the first follows again. Neighbouring levels differ in hue
// and in brightness. Levels count from 0, one tile for each face of the cube.
inline constexpr std::array<LevelColour, 8> kLevelColours{{{"red", {230, 50, 40}},
                                                           {"yellow", {250, 225, 70}},
                                                           {"blue", {40, 90, 220}},
                                                           {"orange", {250, 150, 40}},
                                                           {"green", {40, 150, 60}},
                                                           {"pink", {250, 150, 200}},
                                                           {"purple", {130, 50, 170}},
                                                           {"cyan", {100, 230, 230}}}};

// Returns the colour of a level >= 0.
constexpr const LevelColour& level_colour(int level) {
  return kLevelColours[static_cast<std::size_t>(level) % kLevelColours.size()];
}

}  // namespace vpe::core
