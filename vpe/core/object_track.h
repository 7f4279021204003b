// Ways of objects of a scene over the time of a flight.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vpe::core {

struct ObjectTrackLimits {
  static constexpr std::size_t kMostNameBytes = 200;
  static constexpr double kMostHeight_m = 1e8;
};

// Describes where an object is: above the ground, at a heading or, without one, along its way.
struct ObjectPlace {
  double lon_deg = 0;
  double lat_deg = 0;
  double height_m = 0;                               // of the model's origin above the ground
  std::optional<double> heading_deg = std::nullopt;  // clockwise from north

  bool operator==(const ObjectPlace&) const = default;
};

// Holds the way of one object over the time of a flight (DrawRequest::time_s). Between two points it moves at constant
// speed along the great circle.
struct ObjectTrack {
  struct Point {
    double time_s = 0;
    ObjectPlace place;

    bool operator==(const Point&) const = default;
  };
  struct Showing {
    double time_s = 0;
    bool is_shown = true;

    bool operator==(const Showing&) const = default;
  };

  std::string name;               // of the scene file
  std::vector<Point> points;      // times ascend strictly; empty: it stays where the scene file has it
  std::vector<Showing> showings;  // times ascend strictly; it is shown before the first

  bool operator==(const ObjectTrack&) const = default;
};

// Returns whether an object is shown at a time. Pure.
inline bool is_shown(const ObjectTrack& track, double time_s) {
  bool shown = true;
  for (const ObjectTrack::Showing& change : track.showings) {
    if (change.time_s <= time_s) shown = change.is_shown;
  }
  return shown;
}

}  // namespace vpe::core
