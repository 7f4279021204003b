// Places with names, from a CSV file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vpe::core {

struct Place {
  std::string name;  // UTF-8 as in the file
  double lon_deg = 0;
  double lat_deg = 0;
  double diameter_m = 0;  // 0 = not known

  bool operator==(const Place&) const = default;
};

// CSV as RFC 4180 has it (quotes, also around commas and line ends; LF or CRLF; a byte order mark is skipped),
// UTF-8. The first record names the columns, in any order and case; other columns are not used:
//   name, lon, lat              degrees, east-positive (-360 to 360), planetocentric; diameter_km may be there
//   Feature_Name, Center_Longitude, Center_Latitude, Diameter (km), Coordinate_System
//                               as the gazetteer of the IAU has them; west-positive where the last one says
//                               +West
// Larger places first; those of the same or no diameter in the order of the file. Empty lines are skipped.
// `file` is what errors call it. Throws std::runtime_error: file, line, what was expected and found.
std::vector<Place> parse_gazetteer(std::string_view text, const std::string& file);

// The same of a file. Throws FileError too.
std::vector<Place> read_gazetteer(const std::filesystem::path& path);

// A value of Overlays::names: empty when the file is there and may be read. Its content is not looked at.
std::string gazetteer_problem(const std::string& path);

}  // namespace vpe::core
