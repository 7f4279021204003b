#include "panorama/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sphere.h"
#include "vpe/base/number.h"

namespace panorama {

namespace {

using mars::kPi;
using mars::kRadiansPerDegree;
using vpe::base::format_number;

// Bounds the distance by which rounding may push a place over an edge.
constexpr double kEdge_px = 1e-8;

// Returns a value in [0, period).
double wrap(double value, double period) {
  double rest = std::fmod(value, period);
  if (rest < 0.0) rest += period;
  return rest < period ? rest : 0.0;
}

double facet_focal_px(double facet_px, int facets) { return 0.5 * facet_px / std::tan(kPi / facets); }

std::string check_facets(const PanoramaMap& map) {
  if (map.kind != MapKind::kFacets) return map.facets == 0 ? "" : "facets given for an image that has none";
  if (map.facets < PanoramaLimits::kMinFacets || map.facets > PanoramaLimits::kMaxFacets) {
    return std::to_string(map.facets) + " facets: must be " + std::to_string(PanoramaLimits::kMinFacets) +
           " to " + std::to_string(PanoramaLimits::kMaxFacets);
  }
  if (map.facet_px() != std::round(map.facet_px())) {
    return format_number(map.turn_px) + " columns to a full circle do not make " + std::to_string(map.facets) +
           " facets of whole columns";
  }
  const double focal_px = facet_focal_px(map.facet_px(), map.facets);
  if (!(std::abs(map.focal_px - focal_px) <= 1e-9 * focal_px)) {
    return "facets of " + format_number(map.facet_px()) + " columns have a focal length of " +
           format_number(focal_px) + " pixels, not " + format_number(map.focal_px);
  }
  return {};
}

}  // namespace

const char* to_string(MapKind kind) {
  switch (kind) {
    case MapKind::kCylinder: return "cylinder";
    case MapKind::kEquirectangular: return "equirectangular";
    case MapKind::kFacets: return "facets";
  }
  return "";
}

Direction PanoramaMap::to_direction(double x, double y) const {
  // Full circles are removed before anything is rounded.
  const double column = wrap(x + crop_left_px, turn_px);
  const double rise_px = horizon_px - y;
  Direction direction;
  if (kind == MapKind::kFacets) {
    const double facet = std::min(std::floor(column / facet_px()), facets - 1.0);
    const double from_middle_px = column - (facet + 0.5) * facet_px();
    direction.azimuth_deg = wrap(turn_azimuth_deg + (facet + 0.5) * 360.0 / facets +
                                     std::atan(from_middle_px / focal_px) / kRadiansPerDegree,
                                 360.0);
    direction.elevation_deg = std::atan2(rise_px, std::hypot(from_middle_px, focal_px)) / kRadiansPerDegree;
    return direction;
  }
  direction.azimuth_deg = wrap(turn_azimuth_deg + column * 360.0 / turn_px, 360.0);
  const double elevation_rad = kind == MapKind::kCylinder ? std::atan2(rise_px, focal_px) : rise_px / focal_px;
  direction.elevation_deg = std::clamp(elevation_rad / kRadiansPerDegree, -90.0, 90.0);
  return direction;
}

glm::dvec2 PanoramaMap::place(const Direction& direction) const {
  const double from_start_deg = wrap(std::fmod(direction.azimuth_deg, 360.0) - turn_azimuth_deg, 360.0);
  const double elevation_rad = direction.elevation_deg * kRadiansPerDegree;
  if (kind == MapKind::kFacets) {
    const double facet_deg = 360.0 / facets;
    const double facet = std::min(std::floor(from_start_deg / facet_deg), facets - 1.0);
    const double from_middle_deg = from_start_deg - (facet + 0.5) * facet_deg;
    const double half_px = 0.5 * facet_px();
    const double from_middle_px =
        std::clamp(focal_px * std::tan(from_middle_deg * kRadiansPerDegree), -half_px, half_px);
    return {facet * facet_px() + half_px + from_middle_px - crop_left_px,
            horizon_px - std::tan(elevation_rad) * std::hypot(from_middle_px, focal_px)};
  }
  const double rise = kind == MapKind::kCylinder ? std::tan(elevation_rad) : elevation_rad;
  return {from_start_deg * turn_px / 360.0 - crop_left_px, horizon_px - focal_px * rise};
}

std::optional<glm::dvec2> PanoramaMap::to_pixel(const Direction& direction) const {
  if (!std::isfinite(direction.azimuth_deg) || !(std::abs(direction.elevation_deg) <= 90.0))
    return std::nullopt;
  // At the zenith tan() is a large number of any sign, while the cylinder has no such row.
  if (kind != MapKind::kEquirectangular && std::abs(direction.elevation_deg) == 90.0) return std::nullopt;
  glm::dvec2 at = place(direction);
  if (at.x < -kEdge_px) at.x += turn_px;
  if (at.x >= turn_px - kEdge_px) at.x -= turn_px;
  const glm::dvec2 size(static_cast<double>(width_px), static_cast<double>(height_px));
  if (at.x < -kEdge_px || at.y < -kEdge_px || at.x > size.x + kEdge_px || at.y > size.y + kEdge_px) {
    return std::nullopt;
  }
  return glm::dvec2(std::clamp(at.x, 0.0, size.x), std::clamp(at.y, 0.0, size.y));
}

bool PanoramaMap::is_full_turn() const { return std::abs(static_cast<double>(width_px) - turn_px) < 1.0; }

std::string check(const PanoramaMap& map) {
  using MapLimits = PanoramaLimits;
  if (std::string problem = check_facets(map); !problem.empty()) return problem;
  if (map.width_px < 1 || map.height_px < 1 || map.width_px > kMaxSide_px || map.height_px > kMaxSide_px) {
    return "image size " + std::to_string(map.width_px) + "x" + std::to_string(map.height_px) +
           ": each side must be 1 to " + std::to_string(kMaxSide_px) + " pixels";
  }
  const double width_px = static_cast<double>(map.width_px);
  const double height_px = static_cast<double>(map.height_px);
  if (!(map.turn_px >= width_px / MapLimits::kMaxTurns && map.turn_px <= MapLimits::kMaxTurn_px)) {
    return format_number(map.turn_px) + " columns to a full circle of 360 degrees: an image of " +
           std::to_string(map.width_px) + " columns needs at least half as many, and at most " +
           format_number(MapLimits::kMaxTurn_px) + " are allowed";
  }
  if (!(std::abs(map.turn_azimuth_deg) <= MapLimits::kMaxAzimuth_deg)) {
    return "azimuth " + format_number(map.turn_azimuth_deg) + " degrees: must be within +-" +
           format_number(MapLimits::kMaxAzimuth_deg);
  }
  if (!(map.crop_left_px >= 0.0 && map.crop_left_px < map.turn_px)) {
    return format_number(map.crop_left_px) +
           " columns cut at the left: must be 0 to less than a full circle (" + format_number(map.turn_px) +
           ")";
  }
  if (!(map.focal_px > 0.0 && map.focal_px <= MapLimits::kMaxTurn_px)) {
    return "focal length of " + format_number(map.focal_px) + " pixels: must be more than 0 and at most " +
           format_number(MapLimits::kMaxTurn_px);
  }
  if (!(std::abs(map.horizon_px) <= MapLimits::kMaxTurn_px)) {
    return "horizon at row " + format_number(map.horizon_px) + ": must be within +-" +
           format_number(MapLimits::kMaxTurn_px);
  }
  // Rows of labels are often stated at pixel centres, so half of the first and last row may be too much.
  const double farthest_px = std::max(map.horizon_px, height_px - map.horizon_px);
  if (map.kind == MapKind::kEquirectangular && farthest_px > 0.5 * kPi * map.focal_px + 1.0) {
    return "rows of " + format_number(1.0 / (map.focal_px * kRadiansPerDegree)) +
           " degrees with the horizon at " + format_number(map.horizon_px) + " of " +
           std::to_string(map.height_px) + " go past the zenith or nadir";
  }
  return {};
}

PanoramaMap cylinder_map(std::int64_t width_px, std::int64_t height_px, double turn_px, double left_azimuth_deg,
                         double horizon_px) {
  PanoramaMap map;
  map.kind = MapKind::kCylinder;
  map.width_px = width_px;
  map.height_px = height_px;
  map.turn_px = turn_px;
  map.turn_azimuth_deg = left_azimuth_deg;
  map.horizon_px = horizon_px;
  map.focal_px = turn_px / (2.0 * kPi);
  return map;
}

PanoramaMap equirectangular_map(std::int64_t width_px, std::int64_t height_px, double turn_px,
                                double left_azimuth_deg, double horizon_px) {
  PanoramaMap map = cylinder_map(width_px, height_px, turn_px, left_azimuth_deg, horizon_px);
  map.kind = MapKind::kEquirectangular;
  return map;
}

PanoramaMap faceted_map(int facets, std::int64_t facet_px, std::int64_t height_px, double start_yaw_deg,
                        double horizon_px) {
  const double turn_px = static_cast<double>(facets) * static_cast<double>(facet_px);
  PanoramaMap map =
      cylinder_map(facets * facet_px, height_px, turn_px, start_yaw_deg - 180.0 / facets, horizon_px);
  map.kind = MapKind::kFacets;
  map.facets = facets;
  map.focal_px = facet_focal_px(static_cast<double>(facet_px), facets);
  return map;
}

PanoramaMap map_of(const vpe::core::View& view) {
  if (view.projection == vpe::core::Projection::kPerspective) {
    throw std::invalid_argument("a perspective view is no panorama");
  }
  const mars::Pose pose = mars::to_pose(view.camera, mars::kMarsRadius_m);
  constexpr double kLevel_deg = 1e-9;
  if (std::abs(pose.pitch_deg) > kLevel_deg || std::abs(pose.roll_deg) > kLevel_deg) {
    throw std::invalid_argument("a panorama's camera must be level, not pitched or rolled");
  }
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view);
  PanoramaMap map;
  map.kind =
      view.projection == vpe::core::Projection::kCylinder ? MapKind::kCylinder : MapKind::kEquirectangular;
  map.width_px = part.width;
  map.height_px = part.height;
  map.turn_px = view.width;
  map.turn_azimuth_deg = pose.yaw_deg - 180.0 - view.principal_offset_px.x * 360.0 / view.width;
  map.crop_left_px = part.x;
  map.horizon_px = 0.5 * view.height + view.principal_offset_px.y - part.y;
  map.focal_px = vpe::core::focal_px(view);
  return map;
}

double largest_difference_px(const PanoramaMap& a, const PanoramaMap& b) {
  if (a.width_px != b.width_px || a.height_px != b.height_px) return std::numeric_limits<double>::infinity();
  constexpr int kSteps = 8;
  double largest_px = 0.0;
  for (int row = 0; row <= kSteps; ++row) {
    for (int column = 0; column <= kSteps; ++column) {
      const double x = static_cast<double>(a.width_px) * column / kSteps;
      const double y = static_cast<double>(a.height_px) * row / kSteps;
      const glm::dvec2 at = b.place(a.to_direction(x, y));
      largest_px = std::max(largest_px, std::hypot(std::remainder(at.x - x, b.turn_px), at.y - y));
    }
  }
  return largest_px;
}

}  // namespace panorama
