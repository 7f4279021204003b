// The terrain that an image shows, pixel by pixel, from its range image.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "vpe/overlay/overlay.h"

namespace vpe::overlay {

// Converts between pixels and places on the terrain. Refers to the scene, which must outlive it. Pixels count
// row by row from the upper left one. Any thread may call const members.
class VisibleTerrain {
 public:
  // Throws std::invalid_argument if the range image does not have the image's size.
  explicit VisibleTerrain(const Scene& scene);

  int width() const { return size_.x; }
  int height() const { return size_.y; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x);
  }
  bool is_ground(std::size_t pixel) const;
  // Returns the point that a pixel shows: body-fixed, metres from the planet's centre.
  glm::dvec3 point(int x, int y) const;
  // Returns the position of a point in the layer's pixels, or nullopt if it is behind the camera.
  std::optional<glm::dvec2> to_image(const glm::dvec3& point_m) const;
  // Returns true if the terrain between the four pixels from (x, y) to (x + 1, y + 1) is continuous: no sky,
  // and no edge where near terrain hides far terrain.
  bool is_whole(int x, int y) const;

  // Returns how far the drawn terrain may be off the reference surface, from Scene::shift_px.
  double deviation_m(std::size_t pixel) const;
  // Returns the usual error of the range at a pixel with terrain: depth resolution of a backend, and rounding
  // to 32 bits.
  double noise_m(std::size_t pixel) const;

  const Scene& scene() const { return scene_; }

  // Return a value for every pixel with terrain, NaN for sky. Longitudes are in (-180, 180] degrees; elevations
  // are without exaggeration.
  std::vector<double> longitudes_deg() const;
  std::vector<double> latitudes_deg() const;
  std::vector<double> elevations_m() const;

 private:
  bool breaks(std::size_t pixel, int x, int side, std::size_t step) const;
  template <class Value>
  std::vector<double> values(Value value) const;

  const Scene& scene_;
  core::SubRectangle part_;
  glm::ivec2 size_;
  double nearest_m_;
  double focal_px_;
  glm::dvec2 principal_px_;
  // In a perspective view the ray through a pixel is along corner_ + x * right_ + y * down_.
  bool is_flat_;
  glm::dvec3 corner_{0, 0, 1};
  glm::dvec3 right_{0, 0, 0};
  glm::dvec3 down_{0, 0, 0};
};

// Returns the finer ranges where the image shows the same ground, and sky elsewhere: where no pixel of the
// image within its shift shows ground as far away, but for kHiddenShare, the finer terrain is another hill.
// Throws std::invalid_argument for ranges of another size.
std::vector<float> ranges_of_same_ground(const VisibleTerrain& image, const FinerRanges& finer);

// Range of the middle 90 % of values.
struct CentralRange {
  double low;
  double high;
};

// Computes the central range of the values that are not NaN; returns nullopt if there are none. period > 0: the
// values are angles with that period; the range covers the shorter arc, and may extend beyond one period.
std::optional<CentralRange> central_range(const std::vector<double>& values, double period = 0);

}  // namespace vpe::overlay
