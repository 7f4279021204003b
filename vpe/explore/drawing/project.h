// Project files of `vpe explore`: a planet, the view, settings, drawings, bookmarks and a flight in one TOML
// file.
//
// TOML, as the other key files of the window: people can edit it, and errors have lines. Files below the
// project's own folder are named relative to it, so that a folder can be moved; others by their absolute path.
// Unknown keys are errors, so that a later save loses nothing.
//
//   format = 1
//   planet = "mars.vpe"          # "": the embedded Mars
//   flight = "tour.flight"       # or flight_text with the flight itself
//   hotspots = "spots.txt"
//
//   [view]
//   pose = [137.4, -4.6, -3500.0, 0.0, -5.0, 0.0]
//   fov_deg = 50.0
//   drawn_by = "auto"
//   panels = true
//   large_map = false
//   map = "elevation"
//
//   [settings]                   # those that differ from the defaults
//   "sun.azimuth" = "90"
//
//   [[region]]
//   lon_deg = 137.0
//   lat_deg = -4.0
//   radius_m = 20000.0
//   levels = 1
//
//   [[bookmark]]
//   key = 1                      # 0: none
//   name = "Gale"
//   pose = [137.4, -4.6, -3500.0, 0.0, -5.0, 0.0]
//   fov_deg = 60.0
//
//   [[drawing]]
//   kind = "polygon"
//   name = "Rim"
//   colour = "#ffd65a"
//   visible = true
//   vertices = [[137.0, -4.0], [138.0, -4.0], [138.0, -5.0]]
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scripts/flight.h"
#include "vpe/core/drawn_by.h"
#include "vpe/core/interest.h"
#include "vpe/explore/drawing/drawing.h"
#include "vpe/explore/files/bookmarks.h"
#include "vpe/explore/measure/map_painter.h"

namespace vpe::explore {

struct ProjectLimits {
  static constexpr int kFormat = 1;  // the newest that can be read
  static constexpr std::size_t kMostBytes = std::size_t{128} << 20;
  static constexpr std::size_t kMostErrors = 20;
  static constexpr std::size_t kMostRegions = 1000;
  static constexpr std::size_t kMostBookmarks = 1000;
};

struct Project {
  std::filesystem::path planet;  // empty: the embedded Mars
  std::optional<mars::Pose> pose;
  double fov_deg = 50;
  core::DrawnBy drawn_by = core::DrawnBy::kAuto;
  bool panels = true;
  bool large_map = false;
  MapStyle map_style = MapStyle::kElevation;
  std::vector<std::pair<std::string, std::string>> settings;  // keys and values of core::Settings, all valid
  std::vector<core::InterestRegion> regions;
  std::vector<Bookmark> bookmarks;
  std::vector<Drawing> drawings;  // ids are not part of the file
  std::filesystem::path flight;   // file; empty: none, or the one that follows
  std::optional<scripts::Flight> flight_text;
  std::filesystem::path hotspots;  // file; empty: none
};

// Returns true for the name of a project file: *.vpeproj.
bool is_project_file(const std::filesystem::path& file);

// Returns the text of a project file that lies in a folder. parse_project() reads the same back, numbers to the
// bit. Throws std::invalid_argument for a path that is not UTF-8.
std::string to_text(const Project& project, const std::filesystem::path& folder);

// Holds either a project, or errors (the first kMostErrors), each "FILE:LINE: what is wrong, and what is
// allowed".
struct ParsedProject {
  std::optional<Project> project;
  std::vector<std::string> errors;
};

// Parses any text. Relative paths are relative to the folder of `file`, which is the name in messages too. Does
// not check that the files exist.
ParsedProject parse_project(std::string_view text, const std::filesystem::path& file);

// Reads a file. Throws base::FileError if it cannot be read.
ParsedProject load_project(const std::filesystem::path& file);

// Replaces the file atomically. Throws base::FileError, and std::invalid_argument as to_text().
void save_project(const Project& project, const std::filesystem::path& file);

}  // namespace vpe::explore
