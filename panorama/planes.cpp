#include "panorama/planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/geodesy/sphere.h"
#include "paging/surface/query.h"
#include "vpe/core/appearance/slope.h"

namespace panorama {

namespace {

// The meanings are part of sidecars and stay as they are.
constexpr std::array kPlanes{
    PlaneInfo{Plane::kRange, "range", "m", "distance from the eye along the line of sight", {1, 4}},
    PlaneInfo{Plane::kLonLat, "lonlat", "deg", "longitude east and planetocentric latitude", {2, 8}},
    PlaneInfo{
        Plane::kElevation, "elevation", "m", "elevation in the planet file's datum, not exaggerated", {1, 4}},
    PlaneInfo{
        Plane::kSlope, "slope", "deg", "angle of the facet against the horizontal, not exaggerated", {1, 4}},
    PlaneInfo{Plane::kIncidence,
              "incidence",
              "deg",
              "angle between the line of sight and the facet as drawn",
              {1, 4}},
    PlaneInfo{
        Plane::kSynthetic, "synthetic", "", "1 where the elevation is synthetic, 0 where it is data", {1, 4}}};

void store(double value, std::uint8_t* out) {
  const auto number = static_cast<float>(value);
  std::memcpy(out, &number, sizeof number);
}

}  // namespace

std::span<const PlaneInfo> all_planes() { return kPlanes; }

const PlaneInfo& info_of(Plane plane) { return kPlanes.at(static_cast<std::size_t>(plane)); }

std::vector<Plane> parse_planes(std::string_view text) {
  std::array<bool, kPlanes.size()> wanted{};
  for (std::size_t begin = 0; begin <= text.size() && !text.empty();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string_view name = text.substr(begin, end - begin);
    const auto found =
        std::find_if(kPlanes.begin(), kPlanes.end(), [&](const PlaneInfo& info) { return info.name == name; });
    if (found == kPlanes.end()) {
      std::string names;
      for (const PlaneInfo& info : kPlanes) names += (names.empty() ? "" : ", ") + std::string(info.name);
      throw PlanError("auxiliary layer '" + std::string(name) + "' is not known: there are " + names);
    }
    wanted[static_cast<std::size_t>(found->plane)] = true;
    begin = end + 1;
  }
  std::vector<Plane> planes;
  for (const PlaneInfo& info : kPlanes) {
    if (wanted[static_cast<std::size_t>(info.plane)]) planes.push_back(info.plane);
  }
  return planes;
}

glm::dvec3 line_of_sight(const Piece& piece, std::int64_t x, std::int64_t y) {
  const vpe::core::SubRectangle& part = piece.view.part;
  return vpe::core::pixel_ray(piece.view, static_cast<double>(part.x + piece.margin_px + (x - piece.x)) + 0.5,
                              static_cast<double>(part.y + piece.margin_px + (y - piece.y)) + 0.5);
}

void measure(Plane plane, const paging::Surface& surface, double exaggeration, const glm::dvec3& camera_m,
             const glm::dvec3& sight, float range_m, std::uint8_t* out) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const bool is_ground = std::isfinite(range_m);
  const glm::dvec3 at = is_ground ? camera_m + sight * static_cast<double>(range_m) : camera_m;
  switch (plane) {
    case Plane::kRange: store(is_ground ? static_cast<double>(range_m) : kNan, out); return;
    case Plane::kLonLat: {
      const mars::LonLat place = is_ground ? mars::lon_lat(at) : mars::LonLat{kNan, kNan};
      const std::array<double, 2> numbers{place.lon_deg, place.lat_deg};
      std::memcpy(out, numbers.data(), sizeof numbers);
      return;
    }
    case Plane::kElevation: {
      const auto point = is_ground ? surface.at(at) : paging::SurfacePoint{};
      store(is_ground && !point.nodata ? point.height_m : kNan, out);
      return;
    }
    case Plane::kSlope: {
      const auto point = is_ground ? surface.at(at) : paging::SurfacePoint{};
      store(is_ground && !point.nodata ? vpe::core::slope_deg(point.normal, at) : kNan, out);
      return;
    }
    case Plane::kIncidence: {
      if (!is_ground) return store(kNan, out);
      const glm::dvec3 normal = glm::normalize(surface.at(at, exaggeration).normal);
      const double out_of_ground = -glm::dot(normal, sight);
      const double along = glm::length(glm::cross(normal, sight));
      // On an edge between facets the error of the range may lead to a facet that faces away.
      store(std::max(0.0, std::atan2(out_of_ground, along) / mars::kRadiansPerDegree), out);
      return;
    }
    case Plane::kSynthetic: {
      const auto synthetic = is_ground ? paging::is_synthetic(surface, at) : std::nullopt;
      store(synthetic ? static_cast<double>(*synthetic) : kNan, out);
      return;
    }
  }
}

}  // namespace panorama
