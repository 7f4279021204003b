// Where on the planet a raster lies, coarsely and never too small.
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

  // True when the cap may hold a place of the raster; false only when it holds none.
  bool touches(const Cap& cap) const;

 private:
  std::vector<Cap> parts_;
  Cap whole_;
};

}  // namespace mars
