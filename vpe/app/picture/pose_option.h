// Camera poses as values of options.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "mars/geodesy/pose.h"
#include "paging/planet/planet_file.h"

namespace vpe::app {

// A pose as the user gave it, parsed and checked. Only the planet can tell the altitude of a height above the
// terrain, so that is resolved later.
struct ParsedPose {
  mars::Pose pose;                 // alt_m has no meaning when height_m is set
  std::optional<double> height_m;  // above the terrain as drawn, in place of pose.alt_m
  std::string note;                // how a text was read that can be taken for another form; else empty
  std::string name;                // of the place of Mars that was given in place of numbers; else empty
};

// Parses "LON,LAT,ALT[,YAW[,PITCH[,ROLL]]]": degrees, ALT in metres above the sphere. With height_m the text is
// "LON,LAT", "LON,LAT,YAW,PITCH,ROLL" (with a note), or all six numbers, of which ALT is ignored. Throws UsageError that names the option: for text of
// another form, a longitude outside -360..360, a latitude outside -90..90, and an ALT farther than
// core::ViewLimits allow.
//
// A name is taken, too, from the program's list of places of Mars (named_places.h): the pose from which the place is seen
// whole; with height_m the place itself, looking north. Throws UsageError for names that are not there.
ParsedPose parse_pose(const std::string& option, const std::string& text,
                      std::optional<double> height_m = std::nullopt);

// Returns the pose over the planet, whose terrain is drawn with this vertical exaggeration. Reads the planet's
// tiles only for a height above the terrain; throws what paging::Surface throws, and UsageError for an ALT at or
// below the planet's centre, and for a name on another body than Mars.
mars::Pose resolve(const ParsedPose& parsed, const std::shared_ptr<const paging::PlanetFile>& planet,
                   double exaggeration);

}  // namespace vpe::app
