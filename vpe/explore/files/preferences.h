// What vpe explore keeps: preferences, which people choose, and the last session, which the program remembers.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "vpe/base/user_folders.h"
#include "vpe/explore/files/key_file.h"
#include "vpe/explore/files/user_files.h"
#include "vpe/explore/input/gamepad.h"
#include "vpe/explore/input/head_tracker.h"
#include "vpe/explore/input/space_mouse.h"
#include "vpe/explore/input/udp_receiver.h"

namespace vpe::explore {

enum class LongitudeRange { kSigned, kPositive };  // -180..180, 0..360; east is positive in both

struct Preferences {
  double mouse_speed = 1;                              // factor on what a drag turns and tilts
  bool invert_wheel = false;                           // rolling away goes away
  double fly_speed = 1;                                // factor on moving, of all devices
  double turn_speed = 1;                               // factor on turning, of keys, gamepad and space mouse
  double draw_budget_ms = 40;                          // lod.frame_ms while the camera moves; 0 = none
  double ui_scale = 0;                                 // of letters and panels; 0 = as the display says
  LongitudeRange longitude = LongitudeRange::kSigned;  // in the status line
  bool use_gamepad = true;
  PadOptions gamepad;
  bool use_space_mouse = true;
  SpaceMouseOptions space_mouse;
  bool use_head_tracker = false;  // no port is opened unasked
  UdpOptions head_from;
  HeadTrackerOptions head;

  bool operator==(const Preferences&) const = default;
};

enum class SessionBackend { kPolygon, kVoxel };

struct LastSession {
  int window_width_px = 1280;
  int window_height_px = 720;
  std::string planet;              // the last one's file as it was given; empty = none
  std::optional<mars::Pose> pose;  // of the camera, there
  SessionBackend backend = SessionBackend::kPolygon;
  bool panels = true;  // map, panels and figures are shown
};

// All keys, bound to the members of the object.
std::vector<KeyEntry> keys_of(Preferences& preferences);
std::vector<KeyEntry> keys_of(LastSession& session);

// explore.toml in the user's folders of settings and of state, bookmarks in that of data (vpe/base/user_folders.h);
// an empty path where there is no such folder.
struct ExploreFiles {
  std::filesystem::path preferences;
  std::filesystem::path session;
  std::filesystem::path bookmarks;
};
ExploreFiles explore_files(const base::Environment& environment = base::process_environment());

// Defaults where there is no file and for an empty path. Throw KeyFileError and base::FileError; the window
// goes on with defaults and shows the message when it is the session that cannot be read.
Preferences read_preferences(const std::filesystem::path& file);
LastSession read_session(const std::filesystem::path& file);

// Keep them. Return what went wrong, empty when all is well; never throw. For an empty path they say that there
// is no folder. Comments that people wrote into the file are lost. A number beyond its range is brought within
// it.
[[nodiscard]] std::string save(const Preferences& preferences, const std::filesystem::path& file);
[[nodiscard]] std::string save(const LastSession& session, const std::filesystem::path& file);

// All keys with values in effect, ranges, defaults and meanings: TOML.
std::string to_text(const Preferences& preferences);

}  // namespace vpe::explore
