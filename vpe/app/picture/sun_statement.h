// The sun of a date in the sky of a place.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "mars/geodesy/sphere.h"
#include "mars/geodesy/sun.h"
#include "vpe/core/appearance/settings.h"

namespace vpe::app {

// Describes the sun of a date, or of a season and hour, in the sky of a place.
struct SunStatement {
  double solar_longitude_deg = 0;  // Ls
  double true_solar_time_h = 0;    // LTST at the place
  mars::SunPosition position;

  bool is_night() const { return position.elevation_deg < 0; }
};

// Returns where the sun of the settings stands at a place; nullopt if it is given by azimuth and elevation.
std::optional<SunStatement> sun_statement(const core::SettingsValues& settings, mars::LonLat place);

// Returns "Ls 16.1, LTST 00:12, azimuth 3.2, elevation -86.0 degrees".
std::string to_text(const SunStatement& sun);
// Returns null for nullopt.
nlohmann::json to_json(const std::optional<SunStatement>& sun);

// Prints the statement on stderr, with a note at night. Does nothing for nullopt.
void print_sun(const std::optional<SunStatement>& sun);

// Throws UsageError if the sun is given by a date or season, of which only those of Mars are known, and the
// body is another one.
void require_known_sun(const core::SettingsValues& settings, const std::string& body);

}  // namespace vpe::app
