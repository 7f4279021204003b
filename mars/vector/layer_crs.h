// Converts coordinates of a vector layer to places on the planet.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string>

#include "mars/vector/axis_order.h"

class OGRSpatialReference;

namespace mars {

class CrsTransformer;

// Bounds the coordinates of a layer.
struct CoordinateRange {
  glm::dvec2 low{0};
  glm::dvec2 high{0};
};

// Holds the coordinate reference system of a layer. One thread uses it at a time.
class LayerCrs {
 public:
  // `crs` is the layer's own, or null. Without one, and with WGS 84 on a planet that is not the Earth, coordinates are
  // degrees east and planetocentric degrees north of the planet: so are Mars data written in GeoJSON, KML and GPX, which
  // can name nothing else. Otherwise the body of the CRS must have the planet's radius within 1 %, and its own degrees
  // are taken: latitudes of an ellipsoid become planetocentric, nothing else is converted. The systems of IAU_2015 whose
  // directions a file format has lost get these back by their codes and names. `where` names file and layer in
  // messages. Throws SourceError.
  LayerCrs(const std::string& where, const OGRSpatialReference* crs, double radius_m,
           const CoordinateRange& range, AxisOrder order);
  ~LayerCrs();
  LayerCrs(LayerCrs&&) noexcept;

  // Converts coordinates to degrees, in place; NaN where PROJ finds no place. Longitudes may be in any turn.
  void to_places(std::span<glm::dvec2> points) const;

 private:
  std::unique_ptr<CrsTransformer> transformer_;  // null: coordinates are degrees already
  double centric_scale_ = 1;                     // tan(planetocentric latitude) = k tan(latitude)
};

}  // namespace mars
