// Sites of Mars where spacecraft landed, fell, or were to land.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "vpe/core/appearance/gazetteer.h"

namespace vpe::explore {

// Names the file of the sites (read_landing_sites()), which is carried beside mars::kPlacesFile.
inline constexpr const char* kLandingsFile = "places/mars-landings.csv";

// Describes one site.
struct LandingSite {
  std::string name;     // of the lander
  mars::LonLat place;   // longitude in (-180, 180], planetocentric latitude
  std::string mission;  // that brought it
  std::string landed;   // date of the arrival, UTC, as 2012-08-06
  std::string
      kind;  // "landing", "impact", "predicted" (computed from the flight), or "target" (it was never found)
  std::optional<double> accuracy_m;  // as published; nullopt: not known
  std::string source;                // who published the place, and in which figures
};

// Reads a CSV file with the columns name, lon, lat, mission, landed, kind, accuracy_m and source; accuracy_m is
// a number of metres or "unknown". Throws mars::SourceError for files that cannot be read, and
// std::runtime_error that names the file, the line and what was expected for missing columns, other kinds and
// other accuracies. Thread-safe.
std::vector<LandingSite> read_landing_sites(const std::string& file);

// Returns a site as a place without a diameter. Pure.
core::Place to_place(const LandingSite& site);

// Returns the kind, mission, date and accuracy for people: "landing of Mars Science Laboratory, 2012-08-06,
// accuracy unknown". Pure.
std::string describe(const LandingSite& site);

}  // namespace vpe::explore
