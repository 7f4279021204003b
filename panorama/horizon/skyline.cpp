#include "panorama/horizon/skyline.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace panorama {

glm::dvec3 ray_of(const Viewpoint& viewpoint, const Direction& direction) {
  const mars::SinCos azimuth = mars::sin_cos_deg(direction.azimuth_deg);
  const mars::SinCos elevation = mars::sin_cos_deg(direction.elevation_deg);
  const glm::dvec3 level = azimuth.sin * viewpoint.frame.east + azimuth.cos * viewpoint.frame.north;
  return glm::normalize(elevation.cos * level + elevation.sin * viewpoint.frame.up);
}

GroundPoint ground_point(const Viewpoint& viewpoint, const Direction& direction, double range_m) {
  const glm::dvec3 point = viewpoint.position_m + range_m * ray_of(viewpoint, direction);
  return {direction, range_m, mars::lon_lat(point), glm::length(point) - viewpoint.radius_m};
}

GroundPoint skyline_at(const Viewpoint& viewpoint, double azimuth_deg, const GroundRange& range,
                       const ElevationBracket& first) {
  const auto cast = [&](double elevation_deg) {
    return range(ray_of(viewpoint, {azimuth_deg, elevation_deg}));
  };
  double low = std::clamp(first.low_deg, -90.0, 90.0);
  double high = std::clamp(first.high_deg, low, 90.0);
  double step = std::max(high - low, 1e-3);
  double range_m = cast(low);
  if (std::isinf(range_m)) {
    while (std::isinf(range_m)) {
      if (low <= -90.0) throw std::invalid_argument("no ground below the viewpoint");
      high = low;
      low = std::max(-90.0, low - step);
      step *= 2;
      range_m = cast(low);
    }
  } else {
    // Straight up is sky for every viewpoint above the ground.
    while (high < 90.0) {
      const double higher_m = cast(high);
      if (std::isinf(higher_m)) break;
      low = high;
      range_m = higher_m;
      high = std::min(90.0, high + step);
      step *= 2;
    }
  }
  while (high - low > kSkyline_deg) {
    const double middle = 0.5 * (low + high);
    const double middle_m = cast(middle);
    if (std::isinf(middle_m)) {
      high = middle;
    } else {
      low = middle;
      range_m = middle_m;
    }
  }
  return ground_point(viewpoint, {azimuth_deg, low}, range_m);
}

std::vector<GroundPoint> skyline(const Viewpoint& viewpoint, std::span<const double> azimuths_deg,
                                 const GroundRange& range, vpe::base::ThreadPool& pool,
                                 std::span<const ElevationBracket> first) {
  std::vector<GroundPoint> out(azimuths_deg.size());
  pool.run(out.size(), [&](std::size_t n) {
    out[n] = skyline_at(viewpoint, azimuths_deg[n], range, first.empty() ? ElevationBracket() : first[n]);
  });
  return out;
}

namespace {

float range_in(const RangeImage& image, std::int64_t column, std::int64_t row) {
  return image.range_m[static_cast<std::size_t>(row * image.map.width_px + column)];
}

}  // namespace

std::vector<ElevationBracket> first_brackets(const RangeImage& image, std::span<const double> azimuths_deg) {
  const PanoramaMap& map = image.map;
  std::vector<ElevationBracket> out(azimuths_deg.size());
  for (std::size_t n = 0; n < out.size(); ++n) {
    const double x = map.place({azimuths_deg[n], 0}).x;
    const auto column = std::clamp(static_cast<std::int64_t>(std::floor(x)), std::int64_t{0}, map.width_px - 1);
    // Sky is above, ground below: bisection finds the first row of ground.
    std::int64_t sky = -1;
    std::int64_t ground = map.height_px;
    while (ground - sky > 1) {
      const std::int64_t middle = sky + (ground - sky) / 2;
      (std::isinf(range_in(image, column, middle)) ? sky : ground) = middle;
    }
    const auto row = static_cast<double>(ground) + 0.5;
    out[n] = {map.to_direction(x, row + 1).elevation_deg, map.to_direction(x, row - 2).elevation_deg};
  }
  return out;
}

GroundPoint farthest_ground(const Viewpoint& viewpoint, const RangeImage& image,
                            std::span<const GroundPoint> skyline, const GroundRange& range,
                            vpe::base::ThreadPool& pool) {
  const PanoramaMap& map = image.map;
  std::vector<GroundPoint> candidates(skyline.begin(), skyline.end());
  for (std::int64_t column = 0; column < map.width_px; ++column) {
    double farthest_m = 0;
    std::int64_t at = 0;
    for (std::int64_t row = 0; row < map.height_px; ++row) {
      const double r = static_cast<double>(range_in(image, column, row));
      if (std::isinf(r) || r <= farthest_m) continue;
      farthest_m = r;
      at = row;
    }
    if (farthest_m == 0) continue;
    GroundPoint point;
    point.direction = map.to_direction(static_cast<double>(column) + 0.5, static_cast<double>(at) + 0.5);
    point.range_m = range(ray_of(viewpoint, point.direction));
    if (std::isfinite(point.range_m)) candidates.push_back(point);
  }
  if (candidates.empty()) throw std::invalid_argument("no ground is seen");

  constexpr std::size_t kSearched = 32;
  const std::size_t searched = std::min(kSearched, candidates.size());
  const auto farther = [](const GroundPoint& a, const GroundPoint& b) { return a.range_m > b.range_m; };
  std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(searched),
                    candidates.end(), farther);
  const double column_deg = 360.0 / map.turn_px;
  std::vector<double> azimuths;
  std::vector<ElevationBracket> first;
  for (std::size_t n = 0; n < searched; ++n) {
    for (int k = -kFarthestSteps; k <= kFarthestSteps; ++k) {
      azimuths.push_back(candidates[n].direction.azimuth_deg + column_deg * k / kFarthestSteps);
      const double elevation = candidates[n].direction.elevation_deg;
      first.push_back({elevation - 0.5 * column_deg, elevation + 0.5 * column_deg});
    }
  }
  GroundPoint best = candidates.front();
  for (const GroundPoint& p : panorama::skyline(viewpoint, azimuths, range, pool, first)) {
    if (p.range_m > best.range_m) best = p;
  }
  best.direction.azimuth_deg -= 360.0 * std::floor(best.direction.azimuth_deg / 360.0);
  return ground_point(viewpoint, best.direction, best.range_m);
}

}  // namespace panorama
