#include "vpe/explore/measure/map_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace vpe::explore {

namespace {

MapView kept(MapView map) {
  map.width = std::max(1, map.width);
  map.height = std::max(1, map.height);
  const double widest = std::max(180.0 / map.height, 360.0 / map.width);
  map.degrees_per_px = std::clamp(map.degrees_per_px, MapLimits::kFinest_deg, widest);
  const double room = std::max(0.0, 90.0 - map.degrees_per_px * map.height / 2.0);
  map.middle.lat_deg = std::clamp(map.middle.lat_deg, -room, room);
  map.middle.lon_deg = mars::normalize_lon_deg(map.middle.lon_deg);
  return map;
}

}  // namespace

double MapView::lon_degrees_per_px() const {
  return degrees_per_px / std::max(0.1, std::cos(middle.lat_deg * mars::kRadiansPerDegree));
}

std::optional<mars::LonLat> MapView::place(glm::dvec2 xy) const {
  const double lat = middle.lat_deg + (height / 2.0 - xy.y) * degrees_per_px;
  const double lon = middle.lon_deg + (xy.x - width / 2.0) * lon_degrees_per_px();
  if (!(std::abs(lat) <= 90.0) || !std::isfinite(lon)) return std::nullopt;
  return mars::LonLat{mars::normalize_lon_deg(lon), lat};
}

glm::dvec2 MapView::position(mars::LonLat place) const {
  return {width / 2.0 + std::remainder(place.lon_deg - middle.lon_deg, 360.0) / lon_degrees_per_px(),
          height / 2.0 - (place.lat_deg - middle.lat_deg) / degrees_per_px};
}

MapView whole_map(int width, int height) { return kept({{0, 0}, 1e9, width, height}); }

MapView moved(const MapView& map, glm::dvec2 by_px) {
  MapView next = map;
  next.middle.lon_deg -= by_px.x * map.lon_degrees_per_px();
  next.middle.lat_deg += by_px.y * map.degrees_per_px;
  return kept(next);
}

MapView zoomed(const MapView& map, glm::dvec2 xy, double factor) {
  if (!(factor > 0.0) || !std::isfinite(factor)) return map;
  const std::optional<mars::LonLat> held = map.place(xy);
  MapView next = map;
  next.degrees_per_px /= factor;
  next = kept(next);
  if (!held) return next;
  next.middle.lat_deg = held->lat_deg - (next.height / 2.0 - xy.y) * next.degrees_per_px;
  next = kept(next);
  next.middle.lon_deg = held->lon_deg - (xy.x - next.width / 2.0) * next.lon_degrees_per_px();
  return kept(next);
}

MapView resized(const MapView& map, int width, int height) {
  MapView next = map;
  next.width = width;
  next.height = height;
  return kept(next);
}

std::vector<mars::LonLat> footprint(const core::View& view, double ground_radius_m) {
  std::vector<mars::LonLat> outline;
  if (view.projection != core::Projection::kPerspective) return outline;
  constexpr int kSide = 24;
  const double distance_m = glm::length(view.camera.position_m);
  const glm::dvec3 up = view.camera.position_m / distance_m;
  const auto add = [&](double x, double y) {
    const glm::dvec3 ray = core::pixel_ray(view, x, y);
    const double middle_m = -glm::dot(view.camera.position_m, ray);
    const double off_m = glm::length(view.camera.position_m + ray * middle_m);
    if (off_m < ground_radius_m && middle_m > 0.0 && distance_m > ground_radius_m) {
      const double half_m = std::sqrt((ground_radius_m - off_m) * (ground_radius_m + off_m));
      outline.push_back(mars::lon_lat(view.camera.position_m + ray * (middle_m - half_m)));
      return;
    }
    const glm::dvec3 side = ray - up * glm::dot(ray, up);
    const double length = glm::length(side);
    const double c = std::min(1.0, ground_radius_m / distance_m);
    outline.push_back(mars::lon_lat(length < 1e-12 ? up : up * c + side / length * std::sqrt(1.0 - c * c)));
  };
  for (int n = 0; n < kSide; ++n) add(view.width * static_cast<double>(n) / kSide, 0);
  for (int n = 0; n < kSide; ++n) add(view.width, view.height * static_cast<double>(n) / kSide);
  for (int n = 0; n < kSide; ++n) add(view.width * (1.0 - static_cast<double>(n) / kSide), view.height);
  for (int n = 0; n < kSide; ++n) add(0, view.height * (1.0 - static_cast<double>(n) / kSide));
  return outline;
}

}  // namespace vpe::explore
