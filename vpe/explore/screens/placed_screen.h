// Screens that stand still in a room, and lenses that a head wears.
//
// The frame of the room has the axes of the head tracker: x to the right, y up, z backwards, away from what the person
// faces, in metres (vpe/explore/input/head_tracker.h). Its origin is where the maker of the file wants it.
//
// Typical usage:
//   PlacedScreen table;
//   table.name = "table";
//   table.width_px = 1920;
//   table.height_px = 1080;
//   table.place = ScreenCorners{{-0.3, 0, -0.2}, {0.3, 0, -0.2}, {-0.3, 0, 0.1375}};
//   if (const FittedScreen fitted = fit(table); fitted.problem.empty()) use(fitted.screen);
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <variant>
#include <vector>

#include "vpe/core/view.h"
#include "vpe/explore/screens/lens.h"

namespace vpe::explore {

// Limits of what a screen may be.
struct ScreenLimits {
  static constexpr int kMostScreens = 16;
  static constexpr int kLeastSide_px = 16;
  static constexpr int kMostSide_px = 8192;
  static constexpr double kLeastSide_m = 0.01;
  static constexpr double kMostCoordinate_m = 1000;
  static constexpr double kMostEyeBase_m = 0.5;
  static constexpr double kLeastScale = 1e-3;
  static constexpr double kMostScale = 1e8;
  static constexpr int kMostPlace_px = 100'000;
  static constexpr int kMostMonitors = 64;
  // Measured corners are corrected so far: the sine of what a right angle is off, and the ratio of a pixel's sides.
  static constexpr double kSquareTolerance = 0.005;
  static constexpr double kExact = 1e-9;  // the same of corners that are taken as they are
};

// Says which eye a screen is for. kBoth is a pair in turn, for glasses with shutters.
enum class ScreenEye : std::uint8_t { kMiddle, kLeft, kRight, kBoth };

// Returns "middle", "left", "right" or "both".
const char* to_string(ScreenEye eye);

// Holds three corners as the viewer sees them. The fourth one completes a rectangle.
struct ScreenCorners {
  glm::dvec3 upper_left_m{0, 0, 0};
  glm::dvec3 upper_right_m{0, 0, 0};
  glm::dvec3 lower_left_m{0, 0, 0};
};

// Says where the window of a screen is: on a whole monitor, or at a position in screen coordinates.
struct MonitorNumber {
  int number = 1;  // in the order of the system, from 1
};
struct MonitorName {
  std::string name;  // as the system calls it, such as "DP-1"
};
using WindowPlace = std::variant<MonitorNumber, MonitorName, glm::ivec2>;

// Describes a screen: pixels, the window that shows them, and where it is, in the room or before an eye.
struct PlacedScreen {
  std::string name;
  ScreenEye eye = ScreenEye::kMiddle;
  WindowPlace window;
  int width_px = 0;  // of the window
  int height_px = 0;
  std::variant<ScreenCorners, ScreenLens> place;
};

// Returns "" if screen_view() may be asked about the screen, else what is wrong: sides out of ScreenLimits, corners
// that are not at right angles or pixels that are not square within 1e-9, a lens that cannot be inverted. Pure.
std::string check(const PlacedScreen& screen);

// Holds a screen that check() accepts, or says why there is none.
struct FittedScreen {
  PlacedScreen screen;
  glm::ivec2 drawn_px{0, 0};  // size of its image, which is stretched to the window
  std::string problem;        // "": there is a screen
};

// Returns the screen with corners as core::View has them: right angles and square pixels. Corners that were measured
// are moved by at most kSquareTolerance of a side: the lower ones sideways, then all four up or down. Where a window's
// pixels are not square beyond that, its image gets square ones, as fine as the finer side of the window's, and
// `drawn_px` is its size; width_px and height_px of the result are `drawn_px`. Pure.
FittedScreen fit(const PlacedScreen& screen);

// Holds the screens of a file and what they have in common.
struct ScreenSet {
  struct Entry {
    PlacedScreen screen;         // fitted
    glm::ivec2 window_px{0, 0};  // size of its window
  };
  std::vector<Entry> screens;
  glm::dvec3 rest_m{0, 0, 0};  // place of the head in the room while the tracker says zero, or nothing
  double eye_base_m = 0.063;   // distance between the eyes
  double scale = 1;            // metres of the world for a metre of the room
  // The room's up is that of the place: of the attitude of the platform only the heading is used.
  bool is_level = false;
};

}  // namespace vpe::explore
