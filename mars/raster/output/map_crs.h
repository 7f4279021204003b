// Converts between places on a planet and coordinates of a map, in any CRS of PROJ.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

namespace mars {

// Holds a coordinate reference system for maps of a sphere. Any number of threads may call const members at once.
class MapCrs {
 public:
  // `text` is what GDAL takes for a CRS: IAU_2015:49910, a PROJ string, WKT, a file of it. `radius_m` is that of the
  // planet's sphere. The body of the CRS must have that radius within 1 %: a system of another one is an error.
  // Latitudes of an ellipsoid count as the CRS says; nothing else is converted. Throws SourceError.
  MapCrs(const std::string& text, double radius_m);
  ~MapCrs();
  MapCrs(const MapCrs&) = delete;
  MapCrs& operator=(const MapCrs&) = delete;

  // Converts degrees east and planetocentric degrees north to coordinates of the map (x east or right, y north or up),
  // in place; NaN where PROJ finds none.
  void to_map(std::vector<glm::dvec2>& points) const;

  // Converts coordinates of the map to degrees, in place; NaN where they are off the planet.
  void to_place(std::vector<glm::dvec2>& points) const;

  // Returns whether the coordinates are degrees; else they are metres or the CRS's own unit.
  bool geographic() const;
  // Returns metres for a unit of the map's coordinates; of a geographic CRS, on the equator.
  double unit_m() const;
  // Returns the length of a turn around the planet along x where it is the same at every latitude, as on cylinders;
  // else 0. Coordinates a turn apart are the same place.
  double period() const;
  // Returns the CRS as WKT.
  std::string wkt() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mars
