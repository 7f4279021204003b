// Charts: where a point of space lies in the plane of a shape.
//
// A chart is a pair of ratios x = X(p) / W(p), y = Y(p) / W(p) of functions of first degree, in a convex domain. Both
// kinds keep straight lines straight, so that rays are bounded by their ends.
//
//   parallel   W = 1: orthogonal projection along an axis. The support of a shape is the infinite parallelepiped of
//              Vyatkin and Dolgovesov 2002 (section 2, Fig. 1). Lengths are true across the axis; on a base whose
//              normal has the angle t from the axis, lengths down the slope are shortened to cos t.
//   central    projection from a centre: x = scale * right . d / out . d. Great circles are straight. Lengths are true
//              where d = out; at the angle t from there they are stretched by 1 / cos t across and by 1 / cos^2 t
//              outwards: on a face of a cube by up to 1.73 and 3 at its corners.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "mars/geodesy/cube.h"
#include "relief/shape.h"

namespace relief {

inline constexpr double kEndless_m = std::numeric_limits<double>::infinity();
inline constexpr Rect kEverywhere{-kEndless_m, -kEndless_m, kEndless_m, kEndless_m};

// Holds the function normal . p + offset.
struct Linear {
  glm::dvec3 normal{0, 0, 0};
  double offset = 0;

  double at(const glm::dvec3& p_m) const {
    return normal.x * p_m.x + normal.y * p_m.y + normal.z * p_m.z + offset;
  }
};

// Describes a chart. A pure value.
class Chart {
 public:
  // Makes an orthogonal projection along right x up; `origin_m` has the coordinates (0, 0). The domain is the rectangle.
  // Throws std::invalid_argument if a vector is not finite, right and up are not orthonormal within 1e-9, or the
  // rectangle is empty.
  static Chart parallel(const glm::dvec3& origin_m, const glm::dvec3& right, const glm::dvec3& up,
                        const Rect& domain = kEverywhere);

  // Makes a central projection: coordinates are metres on the plane `scale_m` from the centre. The domain is what lies
  // in front of the centre, within the rectangle. Throws likewise, and if the scale is not positive.
  static Chart central(const glm::dvec3& centre_m, const glm::dvec3& right, const glm::dvec3& up,
                       double scale_m, const Rect& domain = kEverywhere);

  // Makes the chart of a face of a cube about the centre, whose sides lie `radius_m` from it (mars/geodesy/cube.h). The six
  // domains cover space but for the centre, and share only their borders.
  static Chart cube_face(const glm::dvec3& centre_m, mars::Face face, double radius_m);

  // Returns the chart with its domain cut to where a function is not negative.
  Chart cut(const Linear& side) const;

  bool is_parallel() const { return is_parallel_; }
  const Linear& x() const { return x_; }
  const Linear& y() const { return y_; }
  const Linear& w() const { return w_; }
  const Rect& rect() const { return rect_; }

  // Returns the functions of cut(), which are not negative in the domain.
  const std::vector<Linear>& cuts() const { return cuts_; }

  // Returns all functions that are not negative in the domain: cuts(), W, and the borders of the rectangle, without those of infinite borders.
  const std::vector<Linear>& sides() const { return sides_; }

  bool holds(const glm::dvec3& p_m) const;

  // Returns the coordinates of a point of the domain in metres.
  glm::dvec2 at(const glm::dvec3& p_m) const;

  // Returns the gradients of both coordinates in space.
  std::array<glm::dvec3, 2> gradients(const glm::dvec3& p_m) const;

  // Returns a rectangle that holds the coordinates of all points of the domain in a box of corners, cut to the domain's
  // rectangle; without a point in common its sides may cross.
  Rect bounds(const glm::dvec3& low_m, const glm::dvec3& high_m) const;

 private:
  void set_sides();

  Linear x_;
  Linear y_;
  Linear w_;
  bool is_parallel_ = true;
  Rect rect_ = kEverywhere;
  std::vector<Linear> cuts_;
  std::vector<Linear> sides_;
};

}  // namespace relief
