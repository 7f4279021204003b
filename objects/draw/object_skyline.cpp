#include "objects/draw/object_skyline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "objects/draw/single_ray.h"

namespace objects {

namespace {

constexpr double kDegrees = 1 / mars::kRadiansPerDegree;

// The elevations at which a vertical half plane may meet a ball.
struct ElevationSpan {
  double low_deg = -90;
  double high_deg = 90;
  bool is_empty = false;
};

struct VerticalPlane {
  glm::dvec3 origin_m;
  glm::dvec3 ahead;  // level
  glm::dvec3 up;
  glm::dvec3 aside;

  glm::dvec3 ray(double elevation_deg) const {
    const double e = elevation_deg * mars::kRadiansPerDegree;
    return std::cos(e) * ahead + std::sin(e) * up;
  }
  ElevationSpan span(const SceneBall& ball) const {
    const glm::dvec3 to = ball.centre_m - origin_m;
    const double beside_m = glm::dot(to, aside);
    if (std::abs(beside_m) > ball.radius_m) return {0, 0, true};
    const double radius_m = std::sqrt(ball.radius_m * ball.radius_m - beside_m * beside_m);
    const double ahead_m = glm::dot(to, ahead);
    const double up_m = glm::dot(to, up);
    const double distance_m = std::hypot(ahead_m, up_m);
    if (distance_m <= radius_m) return {};
    const double middle = std::atan2(up_m, ahead_m);
    const double half = std::asin(radius_m / distance_m);
    // What is behind the camera lies beyond the zenith.
    const double low_deg = std::max(-90.0, (middle - half) * kDegrees);
    const double high_deg = std::min(90.0, (middle + half) * kDegrees);
    return {low_deg, high_deg, low_deg > high_deg};
  }
};

struct Candidate {
  std::uint32_t instance = 0;
  ElevationSpan span;
};

}  // namespace

std::optional<ObjectTop> ObjectSkyline::above(double azimuth_deg, double elevation_deg) const {
  const double azimuth = azimuth_deg * mars::kRadiansPerDegree;
  const VerticalPlane plane{camera_m_, std::cos(azimuth) * frame_.north + std::sin(azimuth) * frame_.east,
                            frame_.up, std::cos(azimuth) * frame_.east - std::sin(azimuth) * frame_.north};
  std::vector<Candidate> candidates;
  scene_.visit(
      [&](const SceneBall& ball) {
        const ElevationSpan span = plane.span(ball);
        return !span.is_empty && span.high_deg > elevation_deg;
      },
      [&](std::uint32_t n) {
        candidates.push_back({n, plane.span(scene_.ball(n))});
      });
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.span.high_deg != b.span.high_deg ? a.span.high_deg > b.span.high_deg : a.instance < b.instance;
  });
  LevelRule finest;
  finest.camera_m = camera_m_;
  finest.least_ray_px = 0;
  const ObjectRays rays(scene_, finest);
  std::optional<ObjectTop> top;
  double least_deg = elevation_deg;
  for (const Candidate& candidate : candidates) {
    if (candidate.span.high_deg <= least_deg) break;
    const double low_deg = std::max(candidate.span.low_deg, least_deg);
    const double step_deg = (candidate.span.high_deg - low_deg) / kSteps;
    const std::array<PlacedObject, 1> object{rays.placed(candidate.instance)};
    const auto met_at = [&](double at_deg) -> std::optional<double> {
      const auto seen =
          first_among(object, {camera_m_, plane.ray(at_deg)}, std::numeric_limits<double>::infinity());
      return seen ? std::optional(seen->range_m) : std::nullopt;
    };
    double clear_deg = candidate.span.high_deg;
    for (int step = 0; step <= kSteps; ++step) {
      const double at_deg = candidate.span.high_deg - step * step_deg;
      std::optional<double> range_m = met_at(at_deg);
      if (!range_m) {
        clear_deg = at_deg;
        continue;
      }
      double met_deg = at_deg;
      while (clear_deg - met_deg > kTop_deg) {
        const double middle_deg = 0.5 * (clear_deg + met_deg);
        if (!(middle_deg > met_deg && middle_deg < clear_deg)) break;
        if (const std::optional<double> nearer_m = met_at(middle_deg)) {
          met_deg = middle_deg;
          range_m = nearer_m;
        } else {
          clear_deg = middle_deg;
        }
      }
      if (met_deg > least_deg) {
        least_deg = met_deg;
        top = {met_deg, *range_m, candidate.instance};
      }
      break;
    }
  }
  return top;
}

}  // namespace objects
