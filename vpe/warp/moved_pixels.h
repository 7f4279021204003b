// The pixels of a finished image, moved to another view. Private to vpe/warp.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/core/frame.h"
#include "vpe/core/ray_lengths.h"
#include "vpe/core/view.h"

namespace vpe::warp {

// Computes where the new camera sees what the first one saw. Everything is relative to the new camera, in float: positions
// are within 1e-6 of the focal length and of the image's sides.
class Motion {
 public:
  // Points with a smaller share of their distance before the new camera count as beside or behind it.
  static constexpr float kLeastForward = 1e-3F;

  Motion(const core::View& from, const core::View& to);

  int width() const { return part_.width; }
  int height() const { return part_.height; }
  bool moves() const { return exact_.shift_m != glm::dvec3(0, 0, 0); }
  const core::RayLengths& lengths() const { return lengths_; }
  const core::RayLengths& new_lengths() const { return new_lengths_; }

  // Returns the ray through a pixel of the first image in the new camera's axes, `focal` long along the first one's.
  glm::vec3 ray(int x, int y) const {
    return first_ + static_cast<float>(x) * right_ - static_cast<float>(y) * up_;
  }
  // Returns a point in homogeneous coordinates: divided by `nearness` it is in metres from the new camera.
  glm::vec3 moved(const glm::vec3& ray, float nearness) const { return ray - nearness * shift_; }
  // Returns the place of a point, or of a direction, in pixels of the new image's drawn part.
  glm::vec2 place(const glm::vec3& point) const {
    const float scale = new_focal_ / point.z;
    return {new_cx_ + point.x * scale, new_cy_ - point.y * scale};
  }
  bool is_ahead(const glm::vec3& point) const { return point.z > kLeastForward * focal_; }
  float focal() const { return focal_; }

  // Describes the same in double: the ray of pixel (0, 0) and its steps by column and by row; the shift; and the new image.
  struct Exact {
    glm::dvec3 first{}, by_column{}, by_row{}, shift_m{};
    double focal = 1;
    double new_focal = 1;
    glm::dvec2 new_centre_px{};
  };
  const Exact& exact() const { return exact_; }

  // Returns how far the ray of a pixel of the new image runs before it enters what the first image shows, metres.
  double entry_m(int x, int y) const;

 private:
  core::SubRectangle part_;
  Exact exact_;
  float focal_ = 1;
  float new_focal_ = 1;
  float new_cx_ = 0;
  float new_cy_ = 0;
  core::RayLengths lengths_;
  core::RayLengths new_lengths_;
  glm::vec3 first_{};  // ray of pixel (0, 0), and the steps to the next pixel and row, in the new camera's axes
  glm::vec3 right_{};
  glm::vec3 up_{};
  glm::vec3 shift_{};  // from the first camera to the new one, metres
  // Planes through the first camera and the borders of its image: a point is within where the product with the normal is
  // not negative.
  std::array<glm::dvec3, 4> borders_{};
  std::array<double, 4> outside_m_{};  // how far the new camera is outside of each, times the normal's length
};

// Holds the pixels of the first image, row by row, each member as an array of its own. Arrays have kPad entries more than
// pixels, so that vectors may reach beyond the end.
struct MovedPixels {
  static constexpr std::size_t kPad = 16;

  // Replaces the pixels: their inverse depths and colours; where they move is not computed yet.
  void take(const Motion& motion, const core::Frame& frame, base::ThreadPool& pool);
  // Computes where the pixels of [x, end_x) in row y move.
  void move(const Motion& motion, int x, int end_x, int y);

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
  glm::vec2 xy(std::size_t n) const { return {x_px[n], y_px[n]}; }
  glm::vec2 parallax(std::size_t n) const { return {parallax_x_px[n], parallax_y_px[n]}; }

  int width = 0;
  int height = 0;
  // Along the first camera's axis, 1 / m; 0 for sky, no number where the range is none.
  std::vector<float> first_inverse_depth;
  std::vector<std::uint32_t> word;  // colour with red in the lowest byte; empty if the image has none
  std::vector<float> x_px;          // in the new image's drawn part; no number for points that are not ahead
  std::vector<float> y_px;
  std::vector<float> parallax_x_px;  // less the place of a point at infinity in the same direction
  std::vector<float> parallax_y_px;
  std::vector<float> inverse_depth;  // 1 / m along the new camera's axis; 0 for sky
};

}  // namespace vpe::warp
