#include "vpe/explore/measure/line_of_sight.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "paging/surface/section.h"
#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMostHalvings = 40;

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

// Describes the vertical plane through the planet's centre, with axes up and ahead at the beginning.
struct Plane {
  glm::dvec3 up;
  glm::dvec3 ahead;

  glm::dvec2 of(const glm::dvec3& p) const { return {glm::dot(p, ahead), glm::dot(p, up)}; }
};

// Describes a straight line by its distance from the centre in a direction.
struct Line {
  glm::dvec2 begin;
  glm::dvec2 along;

  double radius(const glm::dvec2& direction) const { return cross(begin, along) / cross(direction, along); }
};

// Finds the smallest height of the line of sight above pieces of the section by bisection. Let r(angle) be the
// line's distance from the centre and p the smallest one. Over an angle d, r is below its chord by at most d^2
// / 8 times its largest second derivative r (2 (r / p)^2 - 1), and a facet is never above its chord. This
// bounds the clearance between samples, so bisection finds the minimum within kClearance_m.
class Clearance {
 public:
  explicit Clearance(const Line& sight)
      : sight_(sight), nearest_m_(std::abs(cross(sight.begin, sight.along)) / glm::length(sight.along)) {}

  // Samples the ends alone. The bound that results lets refine() skip most facets.
  void sample_ends(const Line& facet, const glm::dvec2& begin, const glm::dvec2& end) {
    sample(facet, begin);
    sample(facet, end);
  }

  void refine(const Line& facet, const glm::dvec2& begin, const glm::dvec2& end) {
    halve(facet, sample(facet, begin), sample(facet, end), 0);
  }

  void include(const glm::dvec2& direction, double clearance_m) { keep({direction, clearance_m, 0.0}); }

  double least_m() const { return least_m_; }
  double deviation_m() const { return kClearance_m + slack_m_ + rounding_m_; }
  const glm::dvec2& direction() const { return direction_; }

 private:
  struct Sample {
    glm::dvec2 direction;  // unit
    double clearance_m = 0;
    double radius_m = 0;  // of the line of sight
  };

  Sample sample(const Line& facet, const glm::dvec2& direction) {
    Sample s{direction, 0.0, sight_.radius(direction)};
    s.clearance_m = s.radius_m - facet.radius(direction);
    // Rounding of the direction changes a steep line's distance in proportion to its slope.
    const double steep = s.radius_m / std::max(nearest_m_, 1e-9 * s.radius_m);
    s.radius_m = std::abs(s.radius_m);
    if (keep(s)) rounding_m_ = 4e-15 * s.radius_m * steep;
    return s;
  }

  bool keep(const Sample& s) {
    if (!(s.clearance_m < least_m_)) return false;
    least_m_ = s.clearance_m;
    direction_ = s.direction;
    return true;
  }

  void halve(const Line& facet, const Sample& a, const Sample& b, int depth) {
    const double angle =
        std::atan2(std::abs(cross(a.direction, b.direction)), glm::dot(a.direction, b.direction));
    const double r = std::max(a.radius_m, b.radius_m);
    const double ratio = r / nearest_m_;
    const double below_m = angle * angle / 8 * r * (2 * ratio * ratio - 1);
    const double lower_m = std::min(a.clearance_m, b.clearance_m) - below_m;
    if (lower_m >= least_m_ - kClearance_m) return;
    if (depth == kMostHalvings) {
      slack_m_ = std::max(slack_m_, least_m_ - lower_m);
      return;
    }
    const Sample middle = sample(facet, glm::normalize(a.direction + b.direction));
    halve(facet, a, middle, depth + 1);
    halve(facet, middle, b, depth + 1);
  }

  Line sight_;
  double nearest_m_;
  double least_m_ = kInfinity;
  double slack_m_ = 0;
  double rounding_m_ = 0;
  glm::dvec2 direction_{0, 1};
};

void check(const SightPoint& point, const char* which) {
  if (!mars::is_valid(point.place) || !(point.height_m >= 0) || !std::isfinite(point.height_m)) {
    throw std::invalid_argument(
        std::string("a line of sight's ") + which +
        " point must be a place with a height of 0 m or more, not " + base::format_number(point.place.lon_deg) +
        "," + base::format_number(point.place.lat_deg) + " with height " + base::format_number(point.height_m));
  }
}

// Describes the part of a line of sight in which things obstruct it.
struct SightRay {
  glm::dvec3 camera_m;
  glm::dvec3 direction;  // unit
  double begin_m = 0;
  double end_m = 0;
};

double end_of_sight_m(double distance_m) { return kSightEnd_m + 1e-8 * distance_m; }

SightRay inner_ray(const glm::dvec3& camera_m, const glm::dvec3& direction, double distance_m) {
  const double end_m = end_of_sight_m(distance_m);
  return {camera_m, direction, end_m, distance_m - end_m};
}

// Returns an object that obstructs a ray before the ground does, at ground_m (infinity: nowhere), or the ground.
std::optional<Obstruction> first_obstruction(const paging::Surface& surface, const SightRay& ray,
                                             double ground_m, const FirstObject& first_object) {
  const double end_m = std::min(ray.end_m, ground_m);
  if (first_object && end_m > ray.begin_m) {
    const double until_m = end_m - ray.begin_m;
    const glm::dvec3 from_m = ray.camera_m + ray.begin_m * ray.direction;
    std::optional<SightObject> met = first_object(from_m, ray.direction, until_m);
    if (met && met->range_m < until_m) {
      const glm::dvec3 point = from_m + met->range_m * ray.direction;
      return Obstruction{mars::lon_lat(point), ray.begin_m + met->range_m,
                         glm::length(point) - surface.planet_radius_m(), std::move(met->name)};
    }
  }
  if (!std::isfinite(ground_m)) return std::nullopt;
  const glm::dvec3 point = ray.camera_m + ground_m * ray.direction;
  return Obstruction{mars::lon_lat(point), ground_m, surface.at(point).height_m, ""};
}

// Handles vertical lines, which no ground obstructs, as both ends are above it.
LineOfSight upright(const paging::Surface& surface, const SightPoint& from, const SightPoint& to,
                    const FirstObject& first_object) {
  LineOfSight sight;
  sight.distance_m = std::abs(to.height_m - from.height_m);
  if (first_object && sight.distance_m > 2 * end_of_sight_m(sight.distance_m)) {
    const glm::dvec3 up = mars::direction(from.place);
    const glm::dvec3 camera_m = (surface.at(up).radius_m + from.height_m) * up;
    const glm::dvec3 direction = to.height_m > from.height_m ? up : -up;
    const SightRay ray = inner_ray(camera_m, direction, sight.distance_m);
    sight.obstruction = first_obstruction(surface, ray, kInfinity, first_object);
  }
  sight.visible = !sight.obstruction;
  sight.clearance_m = std::min(from.height_m, to.height_m);
  sight.clearance_error_m = 4e-15 * surface.planet_radius_m();
  sight.clearance_place = from.place;
  sight.clearance_distance_m = from.height_m <= to.height_m ? 0 : sight.distance_m;
  return sight;
}

}  // namespace

LineOfSight line_of_sight(const paging::Surface& surface, const SightPoint& from, const SightPoint& to,
                          const FirstObject& first_object) {
  check(from, "first");
  check(to, "second");
  const glm::dvec3 up = mars::direction(from.place);
  const glm::dvec3 up_there = mars::direction(to.place);
  if (up == up_there) return upright(surface, from, to, first_object);
  const double ground_there_m = surface.at(up_there).radius_m;
  const glm::dvec3 camera = (surface.at(up).radius_m + from.height_m) * up;
  const glm::dvec3 target = (ground_there_m + to.height_m) * up_there;
  const glm::dvec3 path = target - camera;

  LineOfSight sight;
  sight.distance_m = glm::length(path);
  sight.arc_m = mars::angle_between_rad(up, up_there) * surface.planet_radius_m();
  const double end_m = end_of_sight_m(sight.distance_m);
  if (sight.distance_m > 2 * end_m) {
    const SightRay ray = inner_ray(camera, path / sight.distance_m, sight.distance_m);
    const double ground_m = surface.cast(camera, ray.direction, 1.0, {ray.begin_m, ray.end_m});
    sight.obstruction = first_obstruction(surface, ray, ground_m, first_object);
  }
  sight.visible = !sight.obstruction;

  const glm::dvec3 ahead = up_there - glm::dot(up, up_there) * up;
  const Plane plane{up, glm::normalize(ahead)};
  const Line line{plane.of(camera), plane.of(target) - plane.of(camera)};
  const glm::dvec2 there = plane.of(up_there);
  Clearance clearance(line);
  clearance.include(plane.of(up), from.height_m);
  clearance.include(there, to.height_m);
  glm::dvec2 steepest{0, 0};  // highest direction to the ground so far
  bool ground_there_seen = true;
  paging::section(surface, up, up_there, [&](const paging::SectionPiece& piece) {
    const glm::dvec2 begin = plane.of(piece.begin_m);
    const glm::dvec2 end = plane.of(piece.end_m);
    if (begin == end) return;
    clearance.sample_ends({begin, end - begin}, glm::normalize(begin), glm::normalize(end));
    // A facet's highest direction is at one of its ends; its beginning is the end of the previous one.
    const glm::dvec2 seen = end - line.begin;
    if (glm::length(seen) <= end_m) return;
    ground_there_seen = steepest == glm::dvec2(0, 0) || cross(steepest, seen) >= 0;
    if (ground_there_seen) steepest = seen;
  });
  paging::section(surface, up, up_there, [&](const paging::SectionPiece& piece) {
    const glm::dvec2 begin = plane.of(piece.begin_m);
    const glm::dvec2 end = plane.of(piece.end_m);
    if (begin != end) clearance.refine({begin, end - begin}, glm::normalize(begin), glm::normalize(end));
  });
  sight.clearance_m = clearance.least_m();
  sight.clearance_error_m = clearance.deviation_m() + 4e-15 * surface.planet_radius_m();
  const glm::dvec2 least = clearance.direction();
  sight.clearance_place = mars::lon_lat(least.x * plane.ahead + least.y * plane.up);
  const double radius_m = line.radius(least);
  sight.clearance_distance_m = std::clamp(glm::length(least * radius_m - line.begin), 0.0, sight.distance_m);

  if (ground_there_seen) return sight;
  // Extends the line over the highest ground to the vertical of the second point.
  const double reach = cross(there, steepest);
  const double over_m = reach != 0 ? cross(line.begin, steepest) / reach : 0;
  const bool meets = over_m > 0 && glm::dot(over_m * there - line.begin, steepest) > 0;
  sight.needed_height_m = meets ? std::max(0.0, over_m - ground_there_m) : kInfinity;
  return sight;
}

}  // namespace vpe::explore
