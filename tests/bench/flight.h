// A flight for a benchmark.
#pragma once

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "paging/surface/surface.h"
#include "scripts/path.h"

namespace bench {

// Throws std::runtime_error that names the file.
inline scripts::Flight read_flight(const char* file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(std::string(file) + ": cannot open the flight");
  const scripts::ParsedFlight parsed =
      scripts::parse_flight(std::string(std::istreambuf_iterator<char>(in), {}), file);
  if (!parsed.flight) throw std::runtime_error(scripts::to_string(parsed.errors.front()));
  return *parsed.flight;
}

// `surface` must outlive the path.
inline scripts::Path path_over(const scripts::Flight& flight, const paging::Surface& surface) {
  return {flight, surface.planet_radius_m(), [&surface](mars::LonLat place, double exaggeration) {
            return surface.at(mars::direction(place), exaggeration).height_m;
          }};
}

}  // namespace bench
