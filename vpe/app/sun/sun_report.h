// The answer of vpe sun: as text and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/sun_times.h"
#include "paging/surface/query.h"
#include "vpe/app/sun/sun_sky.h"

namespace vpe::app {

// Describes a rise or a set.
struct SunCrossing {
  mars::UnixSeconds time_s = 0;
  mars::SunPosition sun;          // of the centre of the disc
  std::optional<SunRidge> ridge;  // nullopt for the flat horizon
};

// Describes a period in which the sun is seen. A crossing that is nullopt lies outside of the sol.
struct SunOutlook {
  std::optional<SunCrossing> rise;
  std::optional<SunCrossing> set;
};

// Describes the sun at one moment of the table.
struct SunRow {
  mars::UnixSeconds time_s = 0;
  mars::SunPosition sun;
  double skyline_deg = 0;
  bool is_seen = false;
};

// Holds all that vpe sun answers about a place and a date.
struct SunReport {
  mars::LonLat place;
  double height_m = 0;  // of the viewpoint above the ground
  paging::PlaceAnswer ground;
  std::string datum;   // of the elevation
  std::string source;  // of the ground; empty: not known
  SunHorizon horizon = SunHorizon::kTerrain;
  bool is_upper_limb = false;
  double disc_radius_deg = 0;
  mars::UnixSeconds date_s = 0;
  mars::SunPosition sun;
  double skyline_deg = 0;
  bool is_seen = false;
  mars::Sol sol;
  double seen_s = 0;  // in the sol
  std::vector<SunOutlook> periods;
  std::vector<SunRow> table;
};

// Returns "2026-11-27T12:00:00.00Z" for a time of the years 1 to 9999, with this many decimals (0 to 3). Rounds.
std::string date_text(mars::UnixSeconds time_s, int decimals);

// Returns "06:01:12" for hours, rounded to the second; 24:00:00 becomes 00:00:00.
std::string hour_text(double hours);

// Returns the answer for people: lines, and the table in CSV after an empty line.
std::string to_text(const SunReport& report);
nlohmann::json to_json(const SunReport& report);

}  // namespace vpe::app
