#include "vpe/app/sun/sun_sky.h"

#include <cmath>

namespace vpe::app {

SunSky::SunSky(const paging::Surface& surface, const panorama::Viewpoint& viewpoint, SunHorizon horizon,
               double limb_deg)
    : surface_(&surface), viewpoint_(viewpoint), horizon_(horizon), limb_deg_(limb_deg) {}

double SunSky::range_m(const glm::dvec3& ray) const { return surface_->cast(viewpoint_.position_m, ray); }

panorama::GroundPoint SunSky::highest_ground(double azimuth_deg) const {
  return panorama::skyline_at(viewpoint_, azimuth_deg, [this](const glm::dvec3& ray) { return range_m(ray); });
}

bool SunSky::is_seen(const mars::SunPosition& sun) const {
  const double elevation_deg = sun.elevation_deg + limb_deg_;
  if (horizon_ == SunHorizon::kFlat) return elevation_deg > 0;
  return std::isinf(range_m(panorama::ray_of(viewpoint_, {sun.azimuth_deg, elevation_deg})));
}

double SunSky::skyline_deg(double azimuth_deg) const {
  return horizon_ == SunHorizon::kFlat ? 0.0 : highest_ground(azimuth_deg).direction.elevation_deg;
}

std::optional<SunRidge> SunSky::ridge(mars::UnixSeconds time_s) const {
  if (horizon_ == SunHorizon::kFlat) return std::nullopt;
  const panorama::GroundPoint ground = highest_ground(mars::sun_at(time_s, viewpoint_.place).azimuth_deg);
  SunRidge out{ground.direction.elevation_deg, ground.range_m, ground.place, {}, {}};
  const auto there_m = ground_error_m(paging::query(*surface_, ground.place));
  const auto here_m = ground_error_m(paging::query(*surface_, viewpoint_.place));
  if (!there_m || !here_m) return out;
  out.ground_error_m = *there_m + *here_m;
  constexpr double kHalf_s = 15;
  const double climb = std::abs(mars::sun_at(time_s + kHalf_s, viewpoint_.place).elevation_deg -
                                mars::sun_at(time_s - kHalf_s, viewpoint_.place).elevation_deg) /
                       (2 * kHalf_s);
  constexpr double kLeastClimb = 1e-5;  // degrees a second; at the equator it is 4e-3
  if (climb >= kLeastClimb)
    out.error_s = std::atan2(*out.ground_error_m, out.range_m) / mars::kRadiansPerDegree / climb;
  return out;
}

std::optional<double> ground_error_m(const paging::PlaceAnswer& answer) {
  for (const paging::ResamplingError& error : {answer.resampling, answer.planet_resampling})
    if (error.posts > 0) return answer.geometric_error_m + error.max_m;
  return std::nullopt;
}

}  // namespace vpe::app
