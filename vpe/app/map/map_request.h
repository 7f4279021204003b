// Holds what a map shows, and what its file says about it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mars/raster/output/map_crs.h"
#include "mars/raster/output/raster_writer.h"
#include "paging/planet/planet_file.h"
#include "vpe/map/map_bands.h"
#include "vpe/map/map_grid.h"
#include "vpe/map/map_sampler.h"

namespace vpe::app {

// Holds all that decides the pixels of a map, but the planet.
struct MapRequest {
  std::string crs;  // as given or chosen
  map::PlaceBox box;
  double spacing_m = 0;
  std::vector<map::MapBand> bands;
  std::string shade;         // AZIMUTH,ELEVATION in degrees; empty: the default
  std::string sun;           // date, season, or AZIMUTH,ELEVATION in degrees; empty: none
  std::string image_layers;  // of the band colour, as the setting image.layers; empty: as the planet was built
  bool year = false;         // sun_hours are the mean of sols through a year
};

// Returns the light of a request at the middle of its box. Throws UsageError for texts that are none, for a band without
// its light, and for dates on other bodies than Mars.
map::MapLight light_of(const MapRequest& request, const paging::PlanetMeta& meta);

// Returns what a raster of the whole map says: bands, CRS, the planet's datum, body and sources, and the light. Nothing
// of it depends on the way in which the map is made.
mars::RasterInfo raster_info(const MapRequest& request, const mars::MapCrs& crs, const map::MapGrid& grid,
                             const paging::PlanetMeta& meta);

// Returns what lies under pixels as JSON, for files beside unfinished strips.
nlohmann::json to_json(const map::MapGround& ground);
// Returns what to_json() wrote. Throws nlohmann::json::exception for other texts.
map::MapGround ground_from_json(const nlohmann::json& json);

// Adds what lies under the pixels to the file's metadata.
void describe_ground(const map::MapGround& ground, const paging::PlanetMeta& meta, mars::RasterInfo& info);

// Returns a map's description for people and programs.
nlohmann::json map_json(const MapRequest& request, const mars::MapCrs& crs, const map::MapGrid& grid,
                        const map::MapGround& ground, const paging::PlanetMeta& meta);

}  // namespace vpe::app
