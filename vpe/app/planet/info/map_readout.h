// The read-out of the maps of a planet's page: longitude, latitude and elevation under the pointer.
//
// The page is complete without it: the script adds a line of text below each map when a pointer moves over one.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/base/parallel.h"

namespace vpe::app {

inline constexpr double kReadoutStep_deg = 1.5;
inline constexpr std::uint16_t kReadoutNodata = 0xFFFF;

// Holds elevations at the middles of cells that are linear in longitude and latitude, row 0 at the north, column 0 at 180 degrees
// west. An elevation is low_m + step_m * value; kReadoutNodata: no data.
struct ElevationGrid {
  int width = 0;
  int height = 0;
  double low_m = 0;
  double step_m = 1;
  std::vector<std::uint16_t> values;
};

// Returns the elevations of the reference surface every kReadoutStep_deg, rounded to a 65 000th of the planet's range. Keeps at
// most about `budget_bytes` of tiles. Does not depend on the pool. Throws paging::PlanetError.
ElevationGrid elevation_grid(const std::shared_ptr<const paging::PlanetFile>& planet, std::size_t budget_bytes,
                             base::ThreadPool& pool);

// Returns the element that holds a grid for the script, and shows nothing.
std::string readout_markup(const ElevationGrid& grid);

// Returns the script. It needs no network and has none of the characters that XML reserves. It finds maps by their attribute
// data-map: plain, north or south. Between the points of the grid it interpolates, so narrow hills are lower than they are.
std::string readout_script();

// Returns the CSS of the read-out.
std::string readout_style();

}  // namespace vpe::app
