// Ways in vector files: lines, tracks, and points one after the other.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mars/geodesy/sphere.h"

namespace vpe::explore {

// Holds a point of a way, with what the file tells of it.
struct WayPoint {
  mars::LonLat place;               // longitude in (-180, 180], planetocentric latitude
  std::optional<double> time_s;     // of the file's clock, of which differences count
  std::optional<double> yaw_deg;    // clockwise from north, -360 to 360
  std::optional<double> pitch_deg;  // -90 to 90
  std::optional<double> roll_deg;   // -180 to 180
};

struct FileWay {
  std::string kind;  // "line" or "points", for messages
  std::vector<WayPoint> points;
};

// Returns the ways of a file that mars::read_features() reads, in its order; there is at least one. Of a GPX
// file these are the segments of its tracks, else its routes, else its waypoints as one way. Of other files
// they are the lines, each part of a line for itself, or if there are none the points of each layer as one way.
// `layer` chooses one layer; empty: all.
//
// Points have the time of a field time, timestamp, datetime or time_s, as seconds or as a date
// (parse_time_stamp()), and the attitude of fields yaw or heading, pitch and roll in degrees, also with the
// ending _deg or the beginning ogr_; upper and lower case do not matter. Lines have no such values for their
// vertices. Throws mars::SourceError for files that cannot be read, and std::runtime_error that names the file,
// the layer and the feature for values that are no numbers or beyond their range, and for files without ways.
// Thread-safe.
std::vector<FileWay> read_ways(const std::string& file, const std::string& layer, double planet_radius_m);

// Returns the seconds of a number, or since 1970-01-01 of a date: "2026-11-27T12:00:00.5Z", "2026/11/27
// 12:00:00+01", with a blank or T between, seconds and zone optional. Returns nullopt for other texts. Pure.
std::optional<double> parse_time_stamp(std::string_view text);

}  // namespace vpe::explore
