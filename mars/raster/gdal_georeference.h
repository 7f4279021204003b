// Maps directions to pixels of a raster in any CRS that PROJ supports, and back.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
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

// Uses the pixel coordinates of PixelGrid. Longitudes and latitudes are those of the raster's own body, i.e. of
// the geographic part of its CRS; planetocentric latitudes are converted to the kind of that CRS. Where columns
// and rows are linear in longitude and latitude (all plain cylindrical maps), PROJ is used only at opening, to
// prove that. Any number of threads may call const members at once.
class Georeference {
 public:
  // `label` overrides GDAL's georeference. `path` is for messages. Throws SourceError if there is no
  // georeference or it cannot be transformed.
  Georeference(const std::string& path, GDALDataset& dataset, const LabelGeoreference& label);
  ~Georeference();
  Georeference(Georeference&&) noexcept;

  const PixelGrid& grid() const { return grid_; }

  // Returns what the user should know about an assumption on the axes, without the file's name, or "".
  const std::string& note() const { return note_; }

  // Returns the smaller side of a pixel in metres where the map is true to scale.
  double resolution_m() const { return resolution_m_; }

  // Returns true if pixels are linear in longitude and latitude.
  bool is_linear() const { return linear_.has_value(); }

  // Bounds the difference between to_pixels() and PROJ on linear maps.
  static constexpr double kLinearError_px = 1e-5;

  // Sets the pixel position of each direction, not reduced by the grid's period; NaN if the projection does not
  // include it.
  void to_pixels(std::span<const glm::dvec3> directions, std::span<glm::dvec2> pixels) const;

  // Does the same with PROJ at every point, for tests. Ignores grids from labels (LabelGeoreference::grid).
  void to_pixels_by_proj(std::span<const glm::dvec3> directions, std::span<glm::dvec2> pixels) const;

  // Sets the unit direction of each pixel; NaN off the planet (outside the outline of a sinusoidal map).
  void to_directions(std::span<const glm::dvec2> pixels, std::span<glm::dvec3> directions) const;

 private:
  // pixel = origin + per_lon * longitude + per_lat * latitude, in degrees.
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
  std::string note_;
  double resolution_m_ = 0;
  double centric_scale_ = 1;  // k in: tan(planetocentric latitude) = k tan(latitude of the CRS)
  std::optional<Linear> linear_;
  std::optional<double> middle_lon_deg_;  // of rotated linear maps, which have no period in columns
};

// Calls use(start, pixels) for consecutive parts of `directions`: pixels[i] is the position of directions[start
// + i]. Works in small parts, so that no buffer grows with the batch.
template <class Use>
void for_pixels(const Georeference& georeference, std::span<const glm::dvec3> directions, const Use& use) {
  constexpr std::size_t kPart = 1024;
  std::array<glm::dvec2, kPart> pixels;
  for (std::size_t start = 0; start < directions.size(); start += kPart) {
    const std::size_t count = std::min(kPart, directions.size() - start);
    georeference.to_pixels(directions.subspan(start, count), std::span(pixels).first(count));
    use(start, std::span<const glm::dvec2>(pixels).first(count));
  }
}

}  // namespace mars
