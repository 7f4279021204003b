#include "vpe/app/planet/places.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"

namespace vpe::app {

namespace {

mars::LonLat checked_place(const std::string& text, const std::string& where) {
  const auto place = parse_place(text);
  if (!place) throw UsageError(where + "'" + text + "': expected LON,LAT in degrees");
  if (!mars::is_valid(*place)) throw UsageError(where + "'" + text + "': latitude must be within -90..90");
  return *place;
}

}  // namespace

std::vector<mars::LonLat> read_places(std::istream& in) {
  std::vector<mars::LonLat> places;
  std::string line;
  bool first = true;
  for (int number = 1; std::getline(in, line); ++number) {
    line.erase(
        std::remove_if(line.begin(), line.end(), [](char c) { return c == ' ' || c == '\r' || c == '\t'; }),
        line.end());
    if (number == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    if (line.empty() || line.front() == '#') continue;
    const bool header = std::exchange(first, false) && line.find_first_of("0123456789") == std::string::npos;
    if (!header) places.push_back(checked_place(line, "standard input, line " + std::to_string(number) + ": "));
  }
  return places;
}

PlanetAndPlaces split_places(const std::vector<std::string>& arguments) {
  PlanetAndPlaces out;
  for (std::size_t n = 0; n < arguments.size(); ++n) {
    if (n == 0 && !parse_place(arguments[0])) {
      out.planet = arguments[0];
      std::error_code none;
      if (out.planet.find(',') != std::string::npos && !std::filesystem::exists(out.planet, none)) {
        throw UsageError("'" + out.planet + "': neither a file nor LON,LAT in degrees");
      }
    } else {
      out.places.push_back(checked_place(arguments[n], ""));
    }
  }
  return out;
}

}  // namespace vpe::app
