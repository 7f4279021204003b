#include "lod/control.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "mars/geodesy/sphere.h"

namespace lod {

namespace core = vpe::core;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Returns true if the ray ahead meets the volume: if a part of it is inside all six planes.
bool meets(const CentreOfView& ray, const cull::BoundingHexahedron& v) {
  double from = 0.0;
  double to = kInfinity;
  const auto keep = [&](const glm::dvec3& inward, double offset) {
    const double at = glm::dot(inward, ray.camera_m) - offset;
    const double slope = glm::dot(inward, ray.forward);
    if (slope > 0.0) {
      from = std::max(from, -at / slope);
    } else if (slope < 0.0) {
      to = std::min(to, at / -slope);
    } else if (at < 0.0) {
      to = -1.0;
    }
  };
  keep(v.centre, glm::dot(v.centre, v.corners_m[0]));
  keep(-v.centre, -glm::dot(v.centre, v.corners_m[4]));
  constexpr std::array<std::array<std::size_t, 2>, 4> kSides{{{4, 5}, {5, 7}, {7, 6}, {6, 4}}};
  for (const auto& [a, b] : kSides) {
    glm::dvec3 inward = glm::normalize(glm::cross(v.corners_m[a], v.corners_m[b]));
    if (glm::dot(inward, v.centre) < 0.0) inward = -inward;
    keep(inward, 0.0);
  }
  return from <= to;
}

// Returns the angle from `forward` to the nearest point of a segment, seen from the origin.
double arc_angle(const glm::dvec3& forward, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 across = glm::cross(a, b);
  const double size = glm::length(across);
  if (size > 0.0 && glm::dot(glm::cross(across, a), forward) > 0.0 &&
      glm::dot(glm::cross(b, across), forward) > 0.0) {
    return std::asin(std::min(1.0, std::abs(glm::dot(forward, across)) / size));
  }
  return std::min(mars::angle_between_rad(forward, a), mars::angle_between_rad(forward, b));
}

bool is_in_range(const ControlFunction& f) {
  return std::isfinite(f.scale) && f.scale >= 0.0 && std::isfinite(f.offset) && std::isfinite(f.weight) &&
         f.weight >= 0.0 && std::isfinite(f.x_factor) && f.x_factor > 0.0;
}

ControlTerm term(const ControlFunction& function, double x, double x_factor = 1.0) {
  return {x, function.weight == 0.0 ? 0.0 : levels(function, x * x_factor), function.weight};
}

// Requires the terms by centre and interest.
double degrade_weight(const LevelControl& control, const ControlTerms& terms, double centre_x) {
  const DegradeWeights& weights = control.degrade;
  if (terms.interest.levels > 0.0) return weights.interest;
  const double share = std::clamp(1.0 - centre_x, 0.0, 1.0);
  return weights.distance + share * (weights.centre - weights.distance);
}

}  // namespace

double levels(const ControlFunction& function, double x) {
  x *= function.x_factor;
  if (!function.table.empty()) return core::levels_at(function.table, x);
  if (function.scale == 0.0) return function.offset;
  if (x == 0.0) return std::numeric_limits<double>::infinity();
  return function.scale / x + function.offset;
}

ControlRegion control_region(const core::InterestRegion& region, double planet_radius_m) {
  const double half_rad = 0.5 * std::min(region.radius_m / planet_radius_m, mars::kPi);
  const double chord = 2.0 * std::sin(half_rad);
  return {mars::direction({region.lon_deg, region.lat_deg}), chord * chord, region.levels};
}

int interest_levels(std::span<const ControlRegion> regions, const mars::ChartRect& rect) {
  int sum = 0;
  for (const ControlRegion& region : regions) {
    const bool counts = region.levels > 0 ? cull::nearest_chord2(rect, region.centre) <= region.chord2
                                          : cull::farthest_chord2(rect, region.centre) <= region.chord2;
    if (counts) sum += region.levels;
  }
  return sum;
}

CentreOfView centre_of_view(const core::View& view) {
  const double half_rad = 0.5 * view.fov_deg * mars::kRadiansPerDegree;
  const bool flat = view.projection == core::Projection::kPerspective;
  return {view.camera.position_m, view.camera.axes.forward, flat, flat ? std::tan(half_rad) : half_rad};
}

double least_angle_rad(const CentreOfView& centre, const cull::BoundingHexahedron& volume) {
  if (meets(centre, volume)) return 0.0;
  // Otherwise the nearest direction is on the outline, which consists of edges.
  constexpr std::array<std::array<std::size_t, 2>, 12> kHullEdges{
      {{0, 1}, {1, 3}, {3, 2}, {2, 0}, {4, 5}, {5, 7}, {7, 6}, {6, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
  std::array<glm::dvec3, 8> corners;
  for (std::size_t k = 0; k < 8; ++k) {
    corners[k] = volume.corners_m[k] - centre.camera_m;
    if (corners[k] == glm::dvec3(0.0)) return 0.0;
  }
  double least = kInfinity;
  for (const auto& [a, b] : kHullEdges)
    least = std::min(least, arc_angle(centre.forward, corners[a], corners[b]));
  return least;
}

double centre_distance(const CentreOfView& centre, double angle_rad) {
  if (!centre.flat) return angle_rad / centre.half_height;
  return angle_rad < 0.5 * mars::kPi ? std::tan(angle_rad) / centre.half_height : kInfinity;
}

ControlTerms control_terms(const LevelControl& control, const CentreOfView& centre, const ControlInput& input,
                           bool evaluate_all) {
  ControlTerms terms;
  const bool by_distance = control.metric == core::LodMetric::kDistance;
  const bool is_uneven = !is_even(control.degrade);
  terms.centre.weight = control.centre.weight;
  if (evaluate_all || is_uneven || control.centre.weight > 0.0) {
    terms.centre_angle_rad = least_angle_rad(centre, input.volume);
    terms.centre = term(control.centre, centre_distance(centre, terms.centre_angle_rad));
  }
  terms.interest.weight = control.interest_weight;
  if (control.interest_weight > 0.0) terms.interest.levels = interest_levels(control.regions, input.rect);
  if (is_uneven) terms.degrade_weight = degrade_weight(control, terms, terms.centre.x);
  terms.distance = term(control.distance, input.min_distance_m, degrade_factor(control, terms.degrade_weight));
  terms.sum =
      (by_distance ? terms.distance.weighted() : 0.0) + terms.centre.weighted() + terms.interest.weighted();
  return terms;
}

double degrade_factor(const LevelControl& control, double degrade_weight) {
  return degrade_weight == 1.0 ? 1.0 : std::pow(control.coarsening, degrade_weight - 1.0);
}

bool is_neutral(const LevelControl& control) {
  return control.metric == core::LodMetric::kError && control.centre.weight == 0.0 &&
         is_even(control.degrade) && (control.regions.empty() || control.interest_weight == 0.0);
}

double level_shift(double sum) { return std::clamp(sum, -kMaxShift, kMaxShift); }

int wanted_level_count(double sum) { return static_cast<int>(std::clamp(sum, 1.0, kMaxLevel + 1.0)); }

double level_count(const TileKey& key, int variant, int variants) {
  return key.level + (variant + 1.0) / variants;
}

void check(const LevelControl& control) {
  const bool is_good = is_in_range(control.distance) && is_in_range(control.centre) &&
                       std::isfinite(control.interest_weight) && control.interest_weight >= 0.0;
  if (!is_good) {
    throw std::invalid_argument(
        "select: scale, offset and weight of level control must be finite, scale and weight not negative");
  }
  for (const double weight : {control.degrade.distance, control.degrade.centre, control.degrade.interest}) {
    if (!std::isfinite(weight) || weight < 0.0)
      throw std::invalid_argument("select: the weights of what a budget takes must be finite and not negative");
  }
  if (!std::isfinite(control.coarsening) || control.coarsening < 1.0)
    throw std::invalid_argument("select: the coarsening must be finite and at least 1");
}

}  // namespace lod
