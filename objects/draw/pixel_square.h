// A square of pixels of an image: the unit of work of compose().
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "objects/draw/object_rays.h"
#include "vpe/core/frame.h"

namespace objects {

// Pixels of a drawn part, [x0, x1) x [y0, y1).
struct PixelSquare {
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;
};

// Gives the rays of a view's pixels: those of core::pixel_ray(), for perspective views in a fraction of the time.
class ViewRays {
 public:
  // The view must outlive this.
  explicit ViewRays(const vpe::core::View& view);

  // Returns the unit direction through a place of the full image. Differs from pixel_ray() by rounding, 1e-15.
  glm::dvec3 at(double x, double y) const {
    if (!is_perspective_) return vpe::core::pixel_ray(view_, x, y);
    const glm::dvec3 d = corner_ + x * right_ + y * down_;
    return d / glm::length(d);
  }

 private:
  const vpe::core::View& view_;
  bool is_perspective_;
  glm::dvec3 corner_{0, 0, 0};
  glm::dvec3 right_{0, 0, 0};
  glm::dvec3 down_{0, 0, 0};
};

// Returns a cone that holds the rays of a square's pixels and of `margin_px` around them. Pure.
ViewCone cone_of(const vpe::core::View& view, const ViewRays& rays, const PixelSquare& square,
                 double margin_px);

// Returns a cone that holds the rays of all pixels of the drawn part. Pure.
ViewCone cone_of_view(const vpe::core::View& view, const ViewRays& rays);

// Returns the solid angle of a pixel in a direction (unit, body-fixed) that the view shows, steradians. Pure.
double pixel_solid_angle(const vpe::core::View& view, const glm::dvec3& direction);

// Holds the ranges of a square's ground and of one pixel around it, as they were before objects were drawn.
class GroundRanges {
 public:
  GroundRanges(const vpe::core::Frame& frame, const PixelSquare& square);

  // Pixels of the square or beside it; beyond the image those at its border.
  float at(int x, int y) const {
    return range_m_[static_cast<std::size_t>(y - square_.y0 + 1) * static_cast<std::size_t>(side_) +
                    static_cast<std::size_t>(x - square_.x0 + 1)];
  }
  // Returns the ranges of a row from a pixel of the square on. Also what a block of kPad_px pixels reaches beyond the square
  // may be read. Rows are stride() apart.
  const float* from(int x, int y) const {
    return range_m_.data() + static_cast<std::size_t>(y - square_.y0 + 1) * stride() +
           static_cast<std::size_t>(x - square_.x0 + 1);
  }
  std::size_t stride() const { return static_cast<std::size_t>(side_); }
  static constexpr int kPad_px = 16;
  // Returns the range of the ground beside a pixel's centre, `offset` in pixels: on the plane through the pixel and its
  // neighbours where they show one surface, else that of the pixel.
  double beside(int x, int y, const glm::dvec2& offset) const;
  // Return the least range, and the largest one with that of the sky or without.
  double nearest_m() const { return nearest_m_; }
  double farthest_m() const { return has_sky_ ? std::numeric_limits<double>::infinity() : farthest_ground_m_; }
  double farthest_ground_m() const { return farthest_ground_m_; }
  bool has_ground() const { return nearest_m_ < std::numeric_limits<double>::infinity(); }

 private:
  PixelSquare square_;
  int side_;
  std::vector<float> range_m_;
  double nearest_m_ = std::numeric_limits<double>::infinity();  // of the square alone
  double farthest_ground_m_ = 0;
  bool has_sky_ = false;
};

}  // namespace objects
