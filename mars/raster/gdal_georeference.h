// From directions to pixels of a raster in any CRS that PROJ knows, and back.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "mars/raster/gdal_grid.h"
#include "mars/raster/label_georeference.h"

class GDALDataset;

namespace mars {

class CrsTransformer;

// Pixel coordinates are those of PixelGrid. The raster's longitudes and latitudes are on its own body: its
// CRS's geographic part, whatever it is called, with planetocentric latitudes turned into that CRS's kind.
// Where columns and rows are linear in longitude and latitude (all plain cylindrical maps) PROJ is asked only
// at opening, to prove that. Every const member may be called from any number of threads at once.
class Georeference {
 public:
  // `place` overrides what GDAL says. `path` is for messages. Throws SourceError when there is no georeference
  // or it cannot be transformed.
  Georeference(const std::string& path, GDALDataset& dataset, const LabelPlace& place);
  ~Georeference();
  Georeference(Georeference&&) noexcept;

  const PixelGrid& grid() const { return grid_; }

  // Side of a pixel in metres where the map is true to scale; the smaller of the two.
  double resolution_m() const { return resolution_m_; }

  // True when pixels are linear in longitude and latitude.
  bool is_linear() const { return linear_.has_value(); }

  // Pixel of each direction, not reduced by the grid's period; NaN where the projection has no place for it.
  // On linear maps within kLinearError_px of what PROJ says.
  static constexpr double kLinearError_px = 1e-5;
  void to_pixels(std::span<const glm::dvec3> directions, std::span<glm::dvec2> pixels) const;

  // The same through PROJ at every point, for checks; not for grids from labels (LabelPlace::grid).
  void to_pixels_by_proj(std::span<const glm::dvec3> directions, std::span<glm::dvec2> pixels) const;

  // Unit direction of each pixel; NaN off the planet (beyond the rim of a sinusoidal map).
  void to_directions(std::span<const glm::dvec2> pixels, std::span<glm::dvec3> directions) const;

 private:
  // column = column0 + dx_column lon + dy_column lat, degrees; rows likewise.
  struct Linear {
    glm::dvec2 origin{0};
    glm::dvec2 per_lon{0};
    glm::dvec2 per_lat{0};
  };

  void find_linear();
  void find_wrap();
  glm::dvec2 pixel_at(double lon_deg, double lat_deg) const;

  std::unique_ptr<CrsTransformer> transformer_;
  PixelGrid grid_;
  double resolution_m_ = 0;
  double centric_scale_ = 1;  // tan(centric latitude) = centric_scale_ tan(latitude of the CRS)
  std::optional<Linear> linear_;
  std::optional<double> middle_lon_deg_;  // of turned linear maps, which have no period in columns
};

}  // namespace mars
