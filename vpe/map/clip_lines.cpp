#include "vpe/map/clip_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vpe::map {

namespace {

using PlaceLine = std::vector<glm::dvec2>;

struct EdgePart {
  double begin = 0;
  double end = 1;
};

// Restricts the part of an edge to low <= from + t * step <= high. Returns false if nothing is left.
bool restrict_part(double from, double step, double low, double high, EdgePart& part) {
  if (step == 0) return from >= low && from <= high;
  const double enter = ((step > 0 ? low : high) - from) / step;
  const double leave = ((step > 0 ? high : low) - from) / step;
  part.begin = std::max(part.begin, enter);
  part.end = std::min(part.end, leave);
  return part.begin < part.end;
}

// Returns whether two vertices are one place but for rounding and whole turns.
bool is_same_place(glm::dvec2 a, glm::dvec2 b) {
  constexpr double kTurnRounding_deg = 1e-10;
  return a.y == b.y && std::abs(std::remainder(a.x - b.x, 360.0)) <= kTurnRounding_deg;
}

// Returns the vertex moved by whole turns so that it is as near to a longitude as possible.
glm::dvec2 turned_to(glm::dvec2 vertex, double lon_deg) {
  return {lon_deg + std::remainder(vertex.x - lon_deg, 360.0), vertex.y};
}

}  // namespace

std::vector<std::vector<glm::dvec2>> clip_line(std::span<const glm::dvec2> line, const PlaceBox& box) {
  std::vector<PlaceLine> parts;
  const double middle_deg = (box.west_deg + box.east_deg) / 2;
  const bool is_all_around = box.east_deg - box.west_deg >= 360;
  bool is_inside = false;  // the last part ends at the vertex before
  double turn_deg = 0;     // from the longitudes of the line to those of the last part
  for (std::size_t n = 0; n + 1 < line.size(); ++n) {
    // A line inside a box that is all around may turn on and on.
    const glm::dvec2 begin =
        is_inside && is_all_around ? line[n] + glm::dvec2(turn_deg, 0) : turned_to(line[n], middle_deg);
    const glm::dvec2 step = line[n + 1] - line[n];
    EdgePart part;
    const bool is_left = (is_all_around || restrict_part(begin.x, step.x, box.west_deg, box.east_deg, part)) &&
                         restrict_part(begin.y, step.y, box.south_deg, box.north_deg, part);
    if (!is_left) {
      is_inside = false;
      continue;
    }
    if (!is_inside || part.begin > 0) parts.push_back({begin + part.begin * step});
    parts.back().push_back(part.end < 1 ? begin + part.end * step : begin + step);
    is_inside = part.end >= 1;
    turn_deg = begin.x - line[n].x;
  }
  const bool is_ring = line.size() > 2 && is_same_place(line.front(), line.back());
  if (!is_ring || parts.size() < 2 || !is_inside) return parts;
  // The first part begins at the seam if its first vertex is the line's.
  PlaceLine& first = parts.front();
  PlaceLine& last = parts.back();
  if (!is_same_place(first.front(), last.back())) return parts;
  const double shift_deg = turned_to(first.front(), last.back().x).x - first.front().x;
  for (std::size_t n = 1; n < first.size(); ++n) last.push_back(first[n] + glm::dvec2(shift_deg, 0));
  std::swap(first, last);
  parts.pop_back();
  return parts;
}

}  // namespace vpe::map
