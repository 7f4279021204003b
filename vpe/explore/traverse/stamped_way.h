// Times and attitudes that a way's file tells, put into a traverse along it.
#pragma once

#include <span>

#include "vpe/explore/traverse/traverse.h"
#include "vpe/explore/traverse/way_file.h"

namespace vpe::explore {

// Describes how they are put in.
struct StampOptions {
  static constexpr double kLeastScale = 1e-3;
  static constexpr double kMostScale = 1e9;

  bool keeps_times = true;  // false: times are those of the traverse
  double scale = 1;         // seconds of the file's clock in one of the flight
};

// Returns whether all points have a time. Pure.
bool has_times(std::span<const WayPoint> points);

// Returns the flight of make_traverse() along the points, with what the file tells of them:
// - Times, if all points have one. The flight begins at 0 and is at each point at its time; between two points
//   its speed on the sphere is constant. Successive points at one place are a stop, for which the flight has
//   two poses.
// - Yaw, pitch and roll, each by itself, at points that have it, and between two that both have it interpolated
//   by the length of the way, yaw on the shorter side. Elsewhere they are along the ground, as without a file.
//   A vehicle stands on the ground with the yaw of the file, in pitch and roll that the file does not tell.
//   Throws std::invalid_argument for what make_traverse() refuses, for points of which some only have a time,
//   for times that do not ascend, a scale beyond its limits, and flights longer than
//   scripts::FlightLimits::kMaxTime_s. Pure.
Traverse make_stamped_traverse(std::span<const WayPoint> points, const TraverseOptions& options,
                               const StampOptions& stamps, const TerrainQuery& ground);

}  // namespace vpe::explore
