#include "vpe/map/near_ground.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"

namespace vpe::map {
namespace {

// Nearer to the axis than this, east and north turn fast.
constexpr double kNearAxis = 1e-3;
// A slope of 11 degrees.
constexpr double kGentleCosine = 0.98163;
constexpr double kGentleTangent = 0.19439;
// Of a height against that of a neighbouring place, in radii: both are rounded.
constexpr double kHeightRounding = 4e-15;

std::optional<float> rounded(double value, double error) {
  const auto low = static_cast<float>(value - error);
  const auto high = static_cast<float>(value + error);
  if (low != high) return std::nullopt;
  return static_cast<float>(value);
}

}  // namespace

NearGround::NearGround(const paging::SurfacePoint& point, const glm::dvec3& direction, double error_rad)
    : point_(point), direction_(direction), error_rad_(error_rad) {}

std::optional<float> NearGround::elevation() const {
  const double cosine = glm::dot(point_.normal, direction_);
  // At least the tangent of the slope, also where the subtraction cancels.
  const double tangent =
      cosine > kGentleCosine ? kGentleTangent : std::sqrt(std::max(0.0, 1 / (cosine * cosine) - 1)) + 1e-7;
  return rounded(point_.height_m, point_.radius_m * (2 * error_rad_ * tangent + kHeightRounding));
}

std::optional<NearGround::Tilt> NearGround::tilt() const {
  const glm::dvec3& d = direction_;
  const double from_axis = std::sqrt(d.x * d.x + d.y * d.y);
  if (from_axis < kNearAxis) return std::nullopt;
  const double sine = d.y / from_axis;
  const double cosine = d.x / from_axis;
  const glm::dvec3 east{-sine, cosine, 0};
  const glm::dvec3 north{-d.z * cosine, -d.z * sine, from_axis};
  return Tilt{glm::dot(point_.normal, east), glm::dot(point_.normal, north), glm::dot(point_.normal, d),
              4 * error_rad_ / from_axis};
}

std::optional<float> NearGround::slope() const {
  const auto t = tilt();
  if (!t) return std::nullopt;
  return rounded(std::atan2(std::hypot(t->east, t->north), t->up) / mars::kRadiansPerDegree,
                 2 * t->error / mars::kRadiansPerDegree);
}

std::optional<float> NearGround::aspect() const {
  const auto t = tilt();
  if (!t) return std::nullopt;
  const double tilted = std::hypot(t->east, t->north);
  if (!(tilted > 4 * t->error)) return std::nullopt;
  double aspect_deg = std::atan2(t->east, t->north) / mars::kRadiansPerDegree;
  const double error_deg = 2 * t->error / tilted / mars::kRadiansPerDegree;
  // North is 0 on one side and 360 on the other.
  if (std::abs(aspect_deg) <= error_deg) return std::nullopt;
  if (aspect_deg < 0) aspect_deg += 360;
  return rounded(aspect_deg, error_deg);
}

std::optional<float> NearGround::shade(double azimuth_deg, double elevation_deg) const {
  const auto t = tilt();
  if (!t) return std::nullopt;
  const mars::SinCos azimuth = mars::sin_cos_deg(azimuth_deg);
  const mars::SinCos elevation = mars::sin_cos_deg(elevation_deg);
  const double cosine =
      (t->east * azimuth.sin + t->north * azimuth.cos) * elevation.cos + t->up * elevation.sin;
  const double error = 4 * t->error;
  if (cosine < -error) return 0.0F;
  return rounded(cosine, error);
}

}  // namespace vpe::map
