#include "vpe/app/film/flight_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace vpe::app {

scripts::Flight read_flight(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw std::runtime_error(path + ": cannot open the flight: " + std::strerror(errno) + "; check the name");
  std::ostringstream text;
  text << in.rdbuf();
  scripts::ParsedFlight parsed = scripts::parse_flight(text.str(), path);
  if (parsed.flight) return *parsed.flight;
  std::string all;
  for (const scripts::FlightError& e : parsed.errors)
    all += (all.empty() ? "" : "\n     ") + scripts::to_string(e);
  throw std::runtime_error(all);
}

}  // namespace vpe::app
