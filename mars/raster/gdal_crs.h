// Transforms between a raster's geographic coordinates and its pixels with PROJ.
#pragma once

#include <ogr_spatialref.h>

#include <array>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "mars/raster/gdal/gdal_scope.h"

namespace mars {

// Uses degrees east and north in the geographic part of the raster's own CRS, whatever body and datum it names,
// so that no change of datum can occur. Handles axes in any order or pointing west, other units and prime
// meridians.
//
// Takes the latitude first, along the columns, where a geographic CRS counts longitudes to the west: so does GDAL
// 3.6.2 in gdalwarp -t_srs IAU_2015:49901; gdal_translate -a_srs leaves the longitude there. iau_crs.h tells these
// apart, and restores the directions that a GeoTIFF loses.
//
// Any number of threads may call const members at once.
class CrsTransformer {
 public:
  // `to_map` is the geotransform. A longitude L is taken for L - lon_shift_deg of the CRS, for files whose
  // central meridian GDAL misreads. `path` is for messages. Throws SourceError.
  CrsTransformer(const std::string& path, const OGRSpatialReference& crs, const std::array<double, 6>& to_map,
                 double lon_shift_deg);
  CrsTransformer(const CrsTransformer&) = delete;
  CrsTransformer& operator=(const CrsTransformer&) = delete;

  double semi_major_m() const { return target_.GetSemiMajor(); }

  // Returns k in: tan(planetocentric latitude) = k tan(latitude of the CRS).
  double centric_scale() const;

  // Returns the projection's central longitude, 0 if it has none.
  double central_lon_deg() const;

  // Converts degrees to pixel coordinates of PixelGrid, in place; NaN where PROJ finds none.
  void forward(std::vector<glm::dvec2>& points) const;

  // Converts pixels to degrees, in place. Pixels off the planet may become some place on it.
  void inverse(std::vector<glm::dvec2>& points) const;

 private:
  using Pool = GdalPool<OGRCoordinateTransformation>;

  void read_axes();
  Pool::Pointer make(bool inverse) const;

  OGRSpatialReference target_;
  OGRSpatialReference source_;
  std::array<double, 6> to_map_;
  std::array<double, 6> to_pixel_{};
  double lon_sign_ = 1;
  double unit_ = 1;          // angular units of the CRS per degree
  double meridian_deg_ = 0;  // degrees east of longitude 0 of the CRS
  bool centric_ = false;
  mutable Pool forward_;
  mutable Pool inverse_;
};

}  // namespace mars
