// The map of a viewshed: its grid, its file, and what is said about it.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "mars/raster/output/map_crs.h"
#include "paging/planet/planet_meta.h"
#include "vpe/app/viewshed/observers.h"
#include "vpe/map/map_grid.h"

namespace vpe::app {

// Returns the azimuthal equidistant system around a place, as a PROJ string.
std::string equidistant_crs(mars::LonLat centre, double radius_m);

// Returns the grid whose pixels are the posts of a frame, in equidistant_crs() of its centre.
map::MapGrid grid_of_frame(const map::GridFrame& frame);

// Returns the smallest grid that holds the reaches of all observers; its edges are multiples of the spacing. Throws
// std::invalid_argument for more than map::kMostGridPosts pixels, as for a reach that the map's edge divides.
map::MapGrid grid_of_observers(const mars::MapCrs& crs, const ViewshedRequest& request, double radius_m);

// Describes a finished map.
struct ViewshedMap {
  std::string crs;  // as given or chosen
  map::MapGrid grid;
  double unit_m = 1;  // metres for a unit of the grid
  std::vector<float>
      value;  // by rows: numbers of observers that see the place, or metres; NaN where it is not known
  map::MapGround ground;             // under the posts of all observers
  std::vector<double> elevations_m;  // of the observers' ground

  // Return the share of pixels that are known and seen by an observer, or known; of `value`.
  double seen_share(bool needed) const;
  double known_share() const;
};

// Writes a cloud-optimised GeoTIFF: bytes with 255 as nodata, or float32 with NaN. Throws mars::SourceError.
void write_viewshed(const std::filesystem::path& path, const ViewshedMap& viewshed,
                    const ViewshedRequest& request, const paging::PlanetMeta& meta);

// Returns the description for people and programs.
nlohmann::json viewshed_json(const ViewshedMap& viewshed, const ViewshedRequest& request,
                             const paging::PlanetMeta& meta);

}  // namespace vpe::app
