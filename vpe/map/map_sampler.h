// The values of a planet at the pixels of a map.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "paging/shading/terrain_shader.h"
#include "paging/surface/surface.h"
#include "vpe/map/map_bands.h"
#include "vpe/map/map_grid.h"
#include "vpe/map/place_block.h"

namespace vpe::map {

// Counts what lies under the pixels of a map.
struct MapGround {
  std::int64_t pixels = 0;      // on the planet
  std::int64_t off_planet = 0;  // beyond the rim of the map's planet
  std::int64_t nodata = 0;
  std::int64_t synthetic = 0;
  double finest_spacing_m = std::numeric_limits<double>::infinity();  // of the planet's posts
  double coarsest_spacing_m = 0;
  double error_max_m = -1;  // largest known; below 0: none is known
  std::set<int> sources;    // indices

  void add(const MapGround& other);
};

// Says what the bands are made with.
struct MapLight {
  double shade_azimuth_deg = 315;
  double shade_elevation_deg = 45;
  std::optional<glm::dvec3> sun;  // unit, body-fixed; needed for MapBand::sun
  // Directions of the sun at equal times of a sol, its ends among them; of several sols the hours are the mean. Needed for
  // MapBand::sun_hours.
  std::vector<std::vector<glm::dvec3>> sols;
  double sol_s = 0;
};

// Holds rows of all channels: channels[c][row * columns + column]. NaN is nodata, and off the planet.
using MapRows = std::vector<std::vector<float>>;

// Computes maps of one surface. Values are those of paging::query() at the middle of a pixel, rounded to float; colours
// those of TerrainShader::colour_at() without light, at least 1. Any thread may call const members.
//
// PROJ is asked for few pixels: PlaceBlock gives the directions of all others within kPlaceBlockError_rad, and where that
// error leaves the rounding of a value open, PROJ is asked after all. So no value depends on the blocks. Maps with colours or
// with the sun are made by PROJ alone.
class MapSampler {
 public:
  // `shader` is needed for colours alone, else null. All must outlive the sampler. Throws std::invalid_argument where the
  // light that a band needs is missing.
  MapSampler(const paging::Surface& surface, const paging::TerrainShader* shader, const mars::MapCrs& crs,
             MapGrid grid, std::vector<MapBand> bands, MapLight light);

  const MapGrid& grid() const { return grid_; }
  std::size_t channels() const { return channels_; }

  // Returns the number of rows, a power of two, that rows() makes fastest when it begins at a multiple of it.
  int rows_at_once() const;

  // Computes whole rows, and adds up what lies under them. Throws PlanetError.
  MapRows rows(int first_row, int count, MapGround& ground) const;

 private:
  struct Pixel;
  struct Pass;
  void fill_block(const PixelRect& block, int first_row, int end_row, Pass& pass) const;
  bool fill_near(const glm::dvec3& direction, std::size_t index, Pass& pass) const;
  void fill_exact(const std::vector<std::size_t>& pixels, Pass& pass) const;
  Pixel look(const mars::LonLat* place, const glm::dvec3& direction, const paging::SurfacePoint& point,
             Pass& pass) const;
  void keep(const Pixel& pixel, std::size_t index, Pass& pass) const;
  bool fill(const Pixel& pixel, std::span<float> values) const;
  float sun_hours(const glm::dvec3& place_m, const glm::dvec3& normal) const;
  double seen_share(const std::vector<glm::dvec3>& sol, const glm::dvec3& place_m,
                    const glm::dvec3& normal) const;
  bool sees(const glm::dvec3& place_m, const glm::dvec3& sun) const;

  const paging::Surface& surface_;
  const paging::TerrainShader* shader_;
  const mars::MapCrs& crs_;
  MapGrid grid_;
  std::vector<MapBand> bands_;
  MapLight light_;
  std::size_t channels_ = 0;
  paging::ShadingParams image_;  // of colours
  double footprint_m_ = 1;
  int block_side_ = 0;  // 0: without blocks
};

}  // namespace vpe::map
