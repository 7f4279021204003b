// PROJ between a raster's geographic CRS and its pixels.
#pragma once

#include <ogr_spatialref.h>

#include <array>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "mars/raster/gdal_scope.h"

namespace mars {

// Degrees east and north in the geographic part of the raster's own CRS: whatever body and datum it names, no
// change of datum can come in. Handles axes in any order or pointing west, other units and prime meridians.
// GDAL 3.6.2 puts the latitude first, along the columns, where a geographic CRS counts longitudes to the west:
// so does gdalwarp -t_srs IAU_2015:49901, and so it is read here. In a GeoTIFF GDAL then loses which is which;
// projected ones (IAU_2015:49911: x grows to the west) lose their direction there. A VRT keeps both. Every
// const member may be called from any number of threads at once.
class CrsTransformer {
 public:
  // `to_map` is the geotransform. A place of longitude L is taken for L - lon_turn_deg of the CRS: for files
  // whose central meridian GDAL reads wrongly. `path` is for messages. Throws SourceError.
  CrsTransformer(const std::string& path, const OGRSpatialReference& crs, const std::array<double, 6>& to_map,
                 double lon_turn_deg);
  CrsTransformer(const CrsTransformer&) = delete;
  CrsTransformer& operator=(const CrsTransformer&) = delete;

  double semi_major_m() const { return target_.GetSemiMajor(); }

  // tan(planetocentric latitude) = centric_scale() tan(latitude of the CRS).
  double centric_scale() const;

  // The projection's central longitude, 0 where it has none.
  double central_lon_deg() const;

  // In place, degrees to pixel coordinates of PixelGrid; NaN where PROJ finds none.
  void forward(std::vector<glm::dvec2>& points) const;

  // In place, pixels to degrees; pixels off the planet may come out as some other place on it.
  void inverse(std::vector<glm::dvec2>& points) const;

 private:
  using Pool = LeasePool<OGRCoordinateTransformation>;

  void read_axes();
  Pool::Pointer make(bool inverse) const;

  OGRSpatialReference target_;
  OGRSpatialReference source_;
  std::array<double, 6> to_map_;
  std::array<double, 6> to_pixel_{};
  double lon_sign_ = 1;
  double unit_ = 1;          // angular units of the CRS in a degree
  double meridian_deg_ = 0;  // degrees east of the CRS's longitude 0
  bool centric_ = false;
  mutable Pool forward_;
  mutable Pool inverse_;
};

}  // namespace mars
