// Files of `vpe explore`: preferences, which people edit, and the last session, which the program remembers.
//
// Typical usage:
//   const ExploreFiles files = explore_files();
//   Preferences preferences = read_preferences(files.preferences);  // defaults if there is no file
//   preferences.ui_scale = 2;
//   if (const std::string problem = save(preferences, files.preferences); !problem.empty()) show(problem);
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "mars/geodesy/pose.h"
#include "vpe/base/user_folders.h"
#include "vpe/core/drawn_by.h"
#include "vpe/core/registry/key_registry.h"
#include "vpe/explore/files/key_file.h"
#include "vpe/explore/files/user_files.h"
#include "vpe/explore/input/gamepad.h"
#include "vpe/explore/input/head_tracker.h"
#include "vpe/explore/input/mouse_choices.h"
#include "vpe/explore/input/space_mouse.h"
#include "vpe/explore/input/udp_receiver.h"

namespace vpe::explore {

enum class Warp {
  kOff,         // not at all: it stands still
  kPolynomial,  // by two polynomials for the whole image (warp::fit_motion)
  kGrid,        // as a grid whose vertices have ranges of their own (warp::ImageGrid)
  kCarry,       // pixel by pixel (warp::Carrier), before the grid
};
enum class DrawContextChoice {
  kAuto,    // the window's, where there is a GPU
  kShared,  // the window's: images of triangles stay in its textures
  kOwn,     // one without a window: all images are pixels
};
enum class LongitudeRange { kSigned, kPositive };  // -180..180, 0..360; east is positive in both

// Choices of the user. preferences.cpp declares the key, the limits and the meaning of each.
struct Preferences {
  double mouse_speed = 1;       // factor on the angles of a drag
  bool invert_wheel = false;    // rolling forward moves away from the ground
  bool throws = true;           // a drag of the ground that ends in motion goes on and dies off
  bool tilt_on_arrival = true;  // the wheel tilts a camera that it brings down from straight above
  double fly_speed = 1;         // factor on the speed of motion, for all devices
  double turn_speed = 1;        // factor on the speed of turning, for keys, gamepad and space mouse
  // lod.frame_ms while the camera moves; 0: no limit. Smaller: smoother motion, coarser images.
  double draw_budget_ms = 40;
  // Says how the last image is moved to the newest pose until the next one is there.
  Warp warp = Warp::kGrid;
  DrawContextChoice context = DrawContextChoice::kAuto;  // in which triangles are drawn
  double ui_scale = 0;                                 // size of letters and panels; 0: the display's own scale
  LongitudeRange longitude = LongitudeRange::kSigned;  // in the status line
  bool use_gamepad = true;
  PadOptions gamepad;
  bool use_space_mouse = true;
  SpaceMouseOptions space_mouse;
  bool use_head_tracker = false;  // off, because it opens a port
  UdpOptions head_from;
  HeadTrackerOptions head;

  bool operator==(const Preferences&) const = default;
};

// The state of the window at its end, from which the next session starts.
struct LastSession {
  int window_width_px = 1280;
  int window_height_px = 720;
  std::string planet;              // path of the planet as it was given; empty: none
  std::optional<mars::Pose> pose;  // of the camera
  core::DrawnBy drawn_by = core::DrawnBy::kAuto;
  bool panels = true;    // map, panels and figures are shown
  double side_px = 0;    // width of the side panel at scale 1; 0: the usual one
  double letters = 0;    // scale of letters and panels that was chosen in the window; 0: none was
  std::string overlays;  // settings of overlays that are on, one a line, as "overlay.scale=on"
  std::string recent;    // paths of the files opened last, one a line, the newest first
};

MouseChoices mouse_choices(const Preferences& preferences);

// Return the keys of the two files.
const core::KeyRegistry<Preferences>& preference_keys();
const core::KeyRegistry<LastSession>& session_keys();

// Paths of the files: explore.toml in the user's folders of settings and of state, bookmarks in that of data
// (vpe/base/user_folders.h). A path is empty if there is no such folder.
struct ExploreFiles {
  std::filesystem::path preferences;
  std::filesystem::path session;
  std::filesystem::path bookmarks;
};
ExploreFiles explore_files(const base::Environment& environment = base::process_environment());

// Return defaults if there is no file, and for an empty path. Throw KeyFileError and base::FileError.
Preferences read_preferences(const std::filesystem::path& file);
LastSession read_session(const std::filesystem::path& file);

// Write the file. Return "", or what went wrong; never throw. For an empty path they report that there is no
// folder. Comments that people wrote into the file are lost. Numbers beyond their range are brought within it.
[[nodiscard]] std::string save(const Preferences& preferences, const std::filesystem::path& file);
[[nodiscard]] std::string save(const LastSession& session, const std::filesystem::path& file);

// Returns all keys as TOML, with the values in effect, ranges, defaults and meanings.
std::string to_text(const Preferences& preferences);

}  // namespace vpe::explore
