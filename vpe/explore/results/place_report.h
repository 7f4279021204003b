// Tells what is at a place: its ground, and the name that is nearest to it.
//
// Typical usage:
//   const PlaceReport here = what_is_here(surface, place, names);
//   for (const ReadOutLine& line : place_lines(here)) list(line.label, line.text);
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vpe/core/appearance/gazetteer.h"
#include "vpe/explore/measure/read_out.h"

namespace vpe::explore {

// Holds the named place that says best where something is.
struct NearestName {
  std::string name;
  double distance_m =
      0;  // on the planet's sphere to the circle of the place, or to its middle where it has none
  bool is_inside = false;  // of the circle; then the distance is 0
};

// Returns the smallest place whose circle holds `place`, or else the one whose circle, or middle where it has none, is
// nearest; nullopt without places. Pure.
std::optional<NearestName> nearest_name(std::span<const core::Place> places, mars::LonLat place,
                                        double radius_m);

// Says what kind of ground is at a place.
enum class GroundKind { kMeasured, kSynthetic, kNodata, kUnknown };

struct PlaceReport {
  ReadOut ground;
  GroundKind kind = GroundKind::kUnknown;
  std::optional<NearestName> name;
};

// Reads the ground at a place, and finds its name. Elevations are not exaggerated. Throws paging::PlanetError. Any thread
// may call it.
PlaceReport what_is_here(const paging::Surface& surface, mars::LonLat place,
                         std::span<const core::Place> places);

// Returns the report as lines: "Name" where there is one, "Place", "Elevation", "Slope", "Source", "Posts", "Error",
// "Ground". Pure.
std::vector<ReadOutLine> place_lines(const PlaceReport& report);

}  // namespace vpe::explore
