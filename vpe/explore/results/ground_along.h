// The ground below places of a measurement: resolution, error, sources, and which part is nodata or made up.
//
// Typical usage:
//   const GroundAlong ground = ground_along(surface, places);
//   tell(ground.nodata_share(), ground.finest_spacing_m);
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "paging/surface/profile.h"
#include "paging/surface/query.h"
#include "vpe/explore/measure/read_out.h"

namespace vpe::explore {

// Describes the ground at points, which are all of the same weight.
struct GroundAlong {
  std::int64_t points = 0;
  std::int64_t nodata = 0;     // points of nodata: the ground there is a filling
  std::int64_t synthetic = 0;  // points whose height is made up
  double finest_spacing_m = std::numeric_limits<double>::infinity();  // of posts, at the points
  double coarsest_spacing_m = 0;
  std::int64_t resampling_posts = 0;  // posts that resampling_max_m was measured on; 0: it is not known
  double resampling_max_m = 0;        // largest at the points: of the ground against the posts of its sources
  std::set<std::string> sources;      // names of those that decide at the points

  // Adds a point.
  void add(const paging::PlaceAnswer& answer, const paging::PlanetMeta& meta);
  // Return shares of the points, 0 without any.
  double nodata_share() const;
  double synthetic_share() const;
};

inline constexpr int kMostGroundPoints = 1000;

// Computes the description along the great circles through places, which are valid and not on opposite sides of the
// planet: at points at equal distances on each circle, one a post of the finer end, and 2 to kMostGroundPoints of them
// for each circle. At one place: of that. Throws paging::PlanetError. Any thread may call it.
GroundAlong ground_along(const paging::Surface& surface, std::span<const mars::LonLat> places);

// Computes the description at the points of a profile. Throws paging::PlanetError. Any thread may call it.
GroundAlong ground_of_profile(const paging::Surface& surface, std::span<const paging::ProfilePoint> points);

// Returns datum, radius, resolution, error, sources, and the shares of nodata and of made-up ground, as the results of
// all commands name them. Pure.
nlohmann::json ground_json(const GroundAlong& ground, const paging::PlanetMeta& meta);

// Returns the same as lines for people: "Datum", "Posts", "Error", "Nodata", "Synthetic". Pure.
std::vector<ReadOutLine> ground_lines(const GroundAlong& ground, const paging::PlanetMeta& meta);

}  // namespace vpe::explore
