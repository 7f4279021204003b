// The ground that an image shows, pixel by pixel, from its range image.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "vpe/overlay/overlay.h"

namespace vpe::overlay {

// Refers to the scene. Pixels count row by row from the upper left one. Const members from any thread.
class VisibleTerrain {
 public:
  // Throws std::invalid_argument when the range image is not of the image's size.
  explicit VisibleTerrain(const Scene& scene);

  int width() const { return size_.x; }
  int height() const { return size_.y; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) + static_cast<std::size_t>(x);
  }
  bool is_ground(std::size_t pixel) const;
  // Body-fixed, metres from the planet's centre.
  glm::dvec3 point(int x, int y) const;
  // In the layer's pixels; nothing when it is behind the camera.
  std::optional<glm::dvec2> to_image(const glm::dvec3& point_m) const;
  // Whether the ground between the four pixels from (x, y) to (x + 1, y + 1) is one piece: no sky, and no edge
  // where near ground hides far ground.
  bool is_whole(int x, int y) const;

  // How far the drawn ground may be off the surface, by Scene::shift_px.
  double deviation_m(std::size_t pixel) const;
  // How far the range may be off at a pixel with ground, as a backend's depths and 32 bits make it.
  double noise_m(std::size_t pixel) const;

  const Scene& scene() const { return scene_; }

  // A number of every pixel with ground, NaN for sky. Longitude in (-180, 180], degrees; metres.
  std::vector<double> longitudes_deg() const;
  std::vector<double> latitudes_deg() const;
  std::vector<double> elevations_m() const;  // without exaggeration

 private:
  bool breaks(std::size_t pixel, int x, int side, std::size_t step) const;
  template <class Value>
  std::vector<double> values(const Value& value) const;

  const Scene& scene_;
  core::SubRectangle part_;
  glm::ivec2 size_;
  double nearest_m_;
  // Of a perspective view: the ray through a pixel is along corner_ + x * right_ + y * down_.
  bool is_flat_;
  glm::dvec3 corner_{0, 0, 1};
  glm::dvec3 right_{0, 0, 0};
  glm::dvec3 down_{0, 0, 0};
};

// Range of the middle 90 % of values, NaN not counted; nothing without any. `period`: values are angles of that
// turn, and the range, which may reach beyond it, holds the shorter way round.
struct Spread {
  double low;
  double high;
};
std::optional<Spread> spread_of(const std::vector<double>& values, double period = 0);

}  // namespace vpe::overlay
