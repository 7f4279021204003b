// The grid of a warped raster: where its pixels lie on the ground, chosen from those of the raster itself.
#pragma once

#include <ogr_spatialref.h>

#include <array>
#include <glm/vec2.hpp>
#include <span>
#include <string>
#include <vector>

class GDALDataset;

namespace mars {

// Transforms between pixels of a raster ((0, 0) is the outer corner of the first) and the ground, by one of GDAL's
// methods. Only one thread at a time may use it.
class PixelMapper {
 public:
  // `options` are those of GDALCreateGenImgProjTransformer2, such as METHOD=RPC. `path` is for messages. Throws
  // SourceError. Must be called inside a GdalScope, like all members.
  PixelMapper(const std::string& path, GDALDataset& dataset, const std::vector<std::string>& options);
  ~PixelMapper();
  PixelMapper(const PixelMapper&) = delete;
  PixelMapper& operator=(const PixelMapper&) = delete;

  // Transform in place; NaN where the method gives no place. The method fits each direction on its own: to_pixels() is
  // the one that warping uses, and to_ground() inverts it only roughly.
  void to_pixels(std::vector<glm::dvec2>& points) const;
  void to_ground(std::vector<glm::dvec2>& points) const;

  // Gives GDAL's transformer away. The caller destroys it, or what it is handed to does.
  void* release();

 private:
  void run(bool to_pixels, std::vector<glm::dvec2>& points) const;

  void* transformer_ = nullptr;
};

// Metres of a coordinate system's units.
class GroundUnits {
 public:
  // The latitude of a geographic system is the second coordinate. Where it counts longitudes to the west, whose order
  // GDAL does not keep, it is the first one if only that can be a latitude at all `places`.
  GroundUnits(const OGRSpatialReference& crs, std::span<const glm::dvec2> places);

  // Returns metres per unit of both coordinates at a place.
  glm::dvec2 metres(const glm::dvec2& place) const;

  // Returns the number of the coordinate that is a latitude, or -1 in a projected system.
  int latitude() const { return latitude_; }

 private:
  double unit_m_ = 1;
  double radians_ = 1;  // of a unit
  int latitude_ = -1;
};

struct GroundGrid {
  int width = 0;
  int height = 0;
  std::array<double, 6> to_ground{};  // geotransform, rows from north to south
  double pixel_m = 0;
};

// Largest number of pixels of the grid for each pixel of the raster. A strip that lies askew needs many.
inline constexpr double kMostGrowth = 1000;

// Chooses a grid that covers a raster with pixels of the same size: the median over the raster, in degrees of
// longitude as many more as these are shorter in the middle. Throws SourceError with `path` if less than half of a
// lattice over the raster has a place on the ground, if the placement is folded (one part of the raster is mirrored
// against another), reaches beyond a pole, or needs more pixels than kMostGrowth says. `advice` says what to do
// about all but the pole.
GroundGrid choose_grid(const std::string& path, const PixelMapper& mapper, int width, int height,
                       const OGRSpatialReference& crs, const std::string& advice);

}  // namespace mars
