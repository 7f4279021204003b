// Coarse, conservative extent of a raster on the planet.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "mars/raster/gdal_georeference.h"
#include "mars/sources/source.h"

namespace mars {

class Footprint {
 public:
  // Divides the raster into parts and encloses each in a cap.
  explicit Footprint(const Georeference& georeference);

  bool is_empty() const { return parts_.empty(); }

  // Returns true if the cap may contain a place of the raster, false only if it contains none.
  bool touches(const Cap& cap) const;

 private:
  std::vector<Cap> parts_;
  Cap whole_;
};

}  // namespace mars
