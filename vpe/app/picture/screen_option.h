// --screens, --screen, --head, --screen-eye: the image of a screen in a room, as 'vpe explore --screens' shows it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "vpe/core/image/image.h"
#include "vpe/core/view.h"
#include "vpe/explore/input/head_tracker.h"
#include "vpe/explore/screens/placed_screen.h"

namespace vpe::app {

struct ScreenArguments {
  std::string file;
  std::string name;
  std::string head;
  std::string eye;
};

// Adds the options.
void add_screen_options(CLI::App& command, ScreenArguments& arguments);

// Holds a screen of a file, and the head before it.
struct ChosenScreen {
  explore::ScreenSet set;  // without its other screens
  explore::HeadPlace head;
  int side = 0;  // of the eye: -1, 0, 1

  const explore::PlacedScreen& screen() const { return set.screens.front().screen; }
  // Returns the lens before the screen, or null.
  const explore::ScreenLens* lens() const { return std::get_if<explore::ScreenLens>(&screen().place); }
};

// Reads the screen that the arguments name; nullopt if they name no file. Throws UsageError, and what read_screens_file()
// throws.
std::optional<ChosenScreen> choose_screen(const ScreenArguments& arguments);

// Returns the view of the screen for a camera where the head rests: with a lens that of the undistorted image. Throws
// UsageError if the eye sees nothing of the screen.
core::View screen_view_of(const ChosenScreen& chosen, const mars::Pose& pose, double radius_m);

// Returns the image of the screen from one of that view: with a lens it is bent.
core::RgbImage image_of_screen(const ChosenScreen& chosen, core::RgbImage drawn);

}  // namespace vpe::app
