#include "vpe/explore/measure/map_line.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

namespace vpe::explore {

namespace {

constexpr int kMostLineHalvings = 14;
constexpr double kFirstSteps = 16;  // least number of steps of a half circle

// Computes positions on one side of the map's seam, where longitudes are continuous.
class Drawer {
 public:
  explicit Drawer(const MapView& map) : map_(map), half_circle_px_(180.0 / map.lon_degrees_per_px()) {}

  // Returns the position of a direction on the seam, at the edge selected by `side` (+1 or -1).
  glm::dvec2 at_seam(const glm::dvec3& direction, double side) const {
    return {map_.width / 2.0 + side * half_circle_px_, map_.position(mars::lon_lat(direction)).y};
  }
  glm::dvec2 at(const glm::dvec3& direction) const { return map_.position(mars::lon_lat(direction)); }

  // Adds the positions between two ends of a piece.
  void between(const glm::dvec3& a, glm::dvec2 at_a, const glm::dvec3& b, glm::dvec2 at_b,
               std::vector<glm::dvec2>& piece, int depth = 0) const {
    const glm::dvec3 middle = mars::slerp(a, b, 0.5);
    const glm::dvec2 xy = at(middle);
    const bool is_long = glm::dot(a, b) < std::cos(mars::kPi / kFirstSteps);
    // The depth is reached only at a pole, where positions jump.
    if (depth == kMostLineHalvings || (!is_long && glm::length((at_a + at_b) / 2.0 - xy) < kMapLineError_px))
      return;
    between(a, at_a, middle, xy, piece, depth + 1);
    piece.push_back(xy);
    between(middle, xy, b, at_b, piece, depth + 1);
  }

 private:
  const MapView& map_;
  double half_circle_px_;
};

// Returns the point where the arc crosses the half circle of the seam, other than at the arc's ends, or
// nullopt.
std::optional<glm::dvec3> crossing(const glm::dvec3& a, const glm::dvec3& b, double seam_lon_deg) {
  const mars::LocalFrame seam = mars::local_frame({seam_lon_deg, 0});
  const double east_a = glm::dot(a, seam.east);
  const double east_b = glm::dot(b, seam.east);
  if (!(east_a * east_b < 0)) return std::nullopt;
  const glm::dvec3 meeting = a * std::abs(east_b) + b * std::abs(east_a);
  if (!(glm::dot(meeting, seam.up) > 0)) return std::nullopt;  // crosses the middle's meridian instead
  return glm::normalize(meeting);
}

}  // namespace

MapLine map_line(const MapView& map, std::span<const mars::LonLat> places) {
  MapLine line;
  if (places.size() < 2) return line;
  const Drawer drawer(map);
  const double seam_lon_deg = map.middle.lon_deg + 180;
  const glm::dvec3 seam_east = mars::local_frame({seam_lon_deg, 0}).east;
  glm::dvec3 a = mars::direction(places[0]);
  line.push_back({drawer.at(a)});
  for (const mars::LonLat& place : places.subspan(1)) {
    const glm::dvec3 b = mars::direction(place);
    glm::dvec3 begin = a;
    if (const auto seam = crossing(a, b, seam_lon_deg)) {
      const double side = glm::dot(a, seam_east) < 0 ? 1.0 : -1.0;  // west of the seam is the right edge
      const glm::dvec2 end = drawer.at_seam(*seam, side);
      drawer.between(a, line.back().back(), *seam, end, line.back());
      line.back().push_back(end);
      line.push_back({drawer.at_seam(*seam, -side)});
      begin = *seam;
    }
    const glm::dvec2 end = drawer.at(b);
    drawer.between(begin, line.back().back(), b, end, line.back());
    line.back().push_back(end);
    a = b;
  }
  return line;
}

}  // namespace vpe::explore
