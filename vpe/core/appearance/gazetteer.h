// Named places from a CSV file.
//
// Typical usage:
//   for (const Place& place : read_gazetteer("mars.csv")) mark(place.lon_deg, place.lat_deg, place.name);
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vpe::core {

// A place with a name.
struct Place {
  std::string name;  // UTF-8 as in the file
  double lon_deg = 0;
  double lat_deg = 0;
  double diameter_m = 0;  // 0: unknown

  bool operator==(const Place&) const = default;
};

// Returns unit directions of points spread over the circle of a place on a planet: four rings of 16
// points, at 0.25, 0.5, 0.75 and 0.95 of its radius. Returns none if the diameter is not known, or a quarter of the planet or more.
std::vector<glm::dvec3> points_within(const Place& place, double planet_radius_m);

// Reads CSV by RFC 4180: quotes, also around commas and line ends; LF or CRLF; UTF-8, a byte order mark is
// skipped. The first record names the columns, in any order and case; other columns are ignored:
//   name, lon, lat              degrees, east-positive (-360 to 360), planetocentric; diameter_km is optional
//   Feature_Name, Center_Longitude, Center_Latitude, Diameter (km), Coordinate_System
//                               the columns of the gazetteer of the IAU; west-positive if the last one says
//                               +West
// Returns larger places first, and those of the same or no diameter in the order of the file. Empty lines are
// skipped. `file` is the name in messages. Throws std::runtime_error with file, line, what was expected and
// what was found.
std::vector<Place> parse_gazetteer(std::string_view text, const std::string& file);

// Does the same for a file. Throws FileError too.
std::vector<Place> read_gazetteer(const std::filesystem::path& path);

// Returns "" if the file of Overlays::names exists and can be read, else what is wrong. Does not check its
// content.
std::string gazetteer_problem(const std::string& path);

}  // namespace vpe::core
