#include "relief/placed.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "relief/interval_math.h"
#include "vpe/base/number.h"

namespace relief {

namespace {

constexpr double kPostsOfPart = 4;  // distances of posts within the smallest part
// Bounds the rounding of angles and of places in the plane by the radius.
constexpr double kAngleRounding_rad = 4e-15;
// Caps that end further from the place than this are taken for all of its plane.
constexpr double kMostFlatAngle_rad = 1.5;

}  // namespace

PlacedRelief::PlacedRelief(ReliefSpec spec, double radius_m)
    : spec_(std::move(spec)), radius_m_(radius_m), mode_(spec_.mode.value_or(usual_mode(spec_.kind))) {
  const mars::LocalFrame frame = mars::local_frame(spec_.place);
  const mars::SinCos azimuth = mars::sin_cos_deg(spec_.azimuth_deg);
  axis_x_ = frame.north * azimuth.cos + frame.east * azimuth.sin;
  axis_y_ = frame.north * azimuth.sin - frame.east * azimuth.cos;
  cap_.centre = frame.up;
  std::vector<glm::dvec2> corners_m;
  for (const mars::LonLat& corner : spec_.polygon) {
    const glm::dvec3 direction = mars::direction(corner);
    if (!(mars::angle_between_rad(direction, cap_.centre) <= kMostReach_rad))
      throw std::invalid_argument(
          "polygon: a corner is too far from the place; give a place within the polygon");
    corners_m.push_back(local_m(direction));
  }
  shapes_ = shapes_of(spec_, std::move(corners_m));
  cap_.radius_rad = shapes_.reach_m / radius_m_ * (1 + kRounding) + kAngleRounding_rad;
  if (!(cap_.radius_rad <= kMostReach_rad)) {
    throw std::invalid_argument("it reaches " + vpe::base::format_significant(shapes_.reach_m, 3) +
                                " m from its place; expected at most " +
                                vpe::base::format_significant(kMostReach_rad * radius_m_, 3) +
                                " m, the radius of the planet");
  }
  sine_of_reach_ = std::sin(cap_.radius_rad) + kAngleRounding_rad;
  support_ = intersection(centred_rect(shapes_.reach_m, shapes_.reach_m), shapes_.height->support());
  if (shapes_.weight) support_ = intersection(support_, shapes_.weight->support());
}

bool PlacedRelief::needs_ground() const { return mode_ != Mode::kAdd && !spec_.level_m; }

double PlacedRelief::spacing_m() const { return spec_.spacing_m.value_or(shapes_.part_m / kPostsOfPart); }

glm::dvec2 PlacedRelief::local_m(const glm::dvec3& direction) const {
  const glm::dvec2 across(glm::dot(direction, axis_x_), glm::dot(direction, axis_y_));
  return across * stretch_m(radius_of(across.x, across.y), glm::dot(direction, cap_.centre));
}

// Returns the distance in the plane by the sine of the angle from the place, from its sine and cosine.
double PlacedRelief::stretch_m(double sine, double cosine) const {
  return sine > 0 ? radius_m_ * (std::atan2(sine, cosine) / sine) : radius_m_;
}

ReliefChange PlacedRelief::change(const glm::dvec3& direction, double ground_m) const {
  const ReliefChange none{ground_m, false, false};
  const double cosine = glm::dot(direction, cap_.centre);
  if (!(cosine > 0) || std::isnan(ground_m)) return none;
  const glm::dvec2 across(glm::dot(direction, axis_x_), glm::dot(direction, axis_y_));
  const double sine = radius_of(across.x, across.y);
  if (sine > sine_of_reach_) return none;
  const glm::dvec2 at_m = across * stretch_m(sine, cosine);
  if (!contains(support_, at_m.x, at_m.y)) return none;
  const double weight = spec_.strength * (shapes_.weight ? shapes_.weight->height_m(at_m.x, at_m.y) : 1);
  if (weight == 0) return none;
  const double target_m = zero_m_ + shapes_.height->height_m(at_m.x, at_m.y);
  const double height_m = composed_m(mode_, ground_m, target_m, weight);
  return {height_m, height_m != ground_m, height_m != ground_m && weight > 0.5};
}

bool PlacedRelief::touches(const mars::Cap& cap) const {
  return mars::angle_between_rad(cap.centre, cap_.centre) <=
         cap.radius_rad + cap_.radius_rad + kAngleRounding_rad;
}

Rect PlacedRelief::local_rect(const mars::Cap& cap) const {
  const double farthest_rad = mars::angle_between_rad(cap.centre, cap_.centre) + cap.radius_rad;
  if (!(farthest_rad <= kMostFlatAngle_rad)) return whole_plane();
  // Ways in the plane are at most so much longer than on the sphere.
  const double stretch = farthest_rad > 1e-8 ? farthest_rad / std::sin(farthest_rad) : 1.0;
  const double half_m = radius_m_ * (cap.radius_rad * stretch * (1 + kRounding) + kAngleRounding_rad);
  const glm::dvec2 centre_m = local_m(cap.centre);
  return grown({centre_m.x, centre_m.y, centre_m.x, centre_m.y}, half_m);
}

Interval PlacedRelief::bounds_m(const mars::Cap& cap, const Interval& ground_m) const {
  if (!touches(cap)) return ground_m;
  const Rect rect = local_rect(cap);
  if (!overlap(rect, support_)) return ground_m;
  const Rect inner = intersection(rect, support_);
  Interval weight{1, 1};
  if (shapes_.weight) weight = shapes_.weight->bounds_m(inner);
  weight = {spec_.strength * weight.low, spec_.strength * weight.high};
  if (!contains(support_, rect)) weight.low = 0;
  const Interval height_m = shapes_.height->bounds_m(inner);
  const Interval target_m =
      widened({zero_m_ + height_m.low, zero_m_ + height_m.high}, kRounding * std::abs(zero_m_));
  return composed_m(mode_, ground_m, target_m, weight);
}

}  // namespace relief
