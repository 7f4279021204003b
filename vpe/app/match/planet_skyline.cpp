#include "vpe/app/match/planet_skyline.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <span>
#include <stdexcept>
#include <vector>

#include "panorama/horizon/skyline.h"
#include "vpe/app/cli/interrupt.h"

namespace vpe::app {

namespace {

constexpr double kLowestCamera_m = 0.001;  // well above rounding errors

// Where the search for the highest ground begins; a skyline outside of it costs a few more casts.
constexpr panorama::ElevationBracket kNearLevel{-15, 45};

}  // namespace

PlanetSkyline::PlanetSkyline(const paging::Surface& surface, mars::LonLat middle, double height_m,
                             base::ThreadPool& pool)
    : surface_(surface), middle_(middle), height_m_(height_m), pool_(pool) {
  if (!(height_m >= kLowestCamera_m))
    throw std::invalid_argument("the camera must be at least a millimetre above the ground");
}

mars::LonLat PlanetSkyline::place(const glm::dvec2& offset_m) const {
  const double distance_m = glm::length(offset_m);
  if (!(distance_m > 0)) return middle_;
  return mars::destination(middle_, std::atan2(offset_m.x, offset_m.y) / mars::kRadiansPerDegree,
                           distance_m / surface_.planet_radius_m());
}

mars::Pose PlanetSkyline::pose(const glm::dvec2& offset_m) const {
  const mars::LonLat at = place(offset_m);
  return {at.lon_deg, at.lat_deg, surface_.at(mars::direction(at)).height_m + height_m_, 0, 0, 0};
}

panorama::SkylineProfile PlanetSkyline::profile(const glm::dvec2& offset_m, double step_deg) const {
  const mars::Pose here = pose(offset_m);
  const panorama::Viewpoint viewpoint = panorama::viewpoint_of(here, surface_.planet_radius_m());
  const panorama::GroundRange range = [&](const glm::dvec3& ray) {
    return surface_.cast(viewpoint.position_m, ray);
  };
  const auto samples = static_cast<std::size_t>(std::ceil(360 / step_deg - 1e-9));
  const std::vector<double> azimuths = panorama::SkylineProfile::azimuths_deg(samples);
  // In pieces, so that Ctrl-C is heard.
  constexpr std::size_t kPiece = 720;
  const std::vector<panorama::ElevationBracket> first(kPiece, kNearLevel);
  std::vector<double> elevations;
  elevations.reserve(samples);
  for (std::size_t begin = 0; begin < samples; begin += kPiece) {
    InterruptGuard::check();
    const std::size_t count = std::min(kPiece, samples - begin);
    for (const panorama::GroundPoint& p :
         panorama::skyline(viewpoint, std::span(azimuths).subspan(begin, count), range, pool_,
                           std::span(first).subspan(0, count)))
      elevations.push_back(p.direction.elevation_deg);
  }
  return panorama::SkylineProfile(std::move(elevations));
}

}  // namespace vpe::app
