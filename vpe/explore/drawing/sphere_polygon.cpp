#include "vpe/explore/drawing/sphere_polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace vpe::explore {

namespace {

constexpr double kNearFirst = 0.17364817766693;  // cosine of 80 degrees

// Returns the signed excess of a triangle, in [-2 pi, 2 pi].
double excess_rad(const glm::dvec3& c, const glm::dvec3& a, const glm::dvec3& b) {
  // Differences keep the bits of small triangles.
  const double volume = glm::dot(glm::cross(a - c, b - a), c);
  return 2 * std::atan2(volume, 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

// Returns the sine of the angle between a direction and an edge, or 1 if it is beside the edge's ends and
// farther than a quarter circle.
double distance_to_edge(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const double to_ends = std::min(glm::length(p - a), glm::length(p - b));
  const glm::dvec3 normal = glm::cross(a, b);
  const double length = glm::length(normal);
  if (length < 1e-12) return to_ends;
  const bool is_beside = glm::dot(glm::cross(normal, a), p) > 0 && glm::dot(glm::cross(b, normal), p) > 0;
  return is_beside ? std::min(to_ends, std::abs(glm::dot(normal, p)) / length) : to_ends;
}

// Returns a direction whose antipode is far from the outline, so that no triangle is degenerate there.
glm::dvec3 far_reference(std::span<const glm::dvec3> polygon) {
  glm::dvec3 best = polygon.front();
  double best_distance = -1;
  for (int n = 0; n < 32; ++n) {
    const double z = 1 - (2.0 * n + 1) / 32;
    const double angle = 2.399963229728653 * n + 0.4;
    const double r = std::sqrt(1 - z * z);
    const glm::dvec3 candidate{r * std::cos(angle), r * std::sin(angle), z};
    double distance = 2;
    for (std::size_t k = 0; k < polygon.size() && distance > best_distance; ++k)
      distance =
          std::min(distance, distance_to_edge(-candidate, polygon[k], polygon[(k + 1) % polygon.size()]));
    if (distance > best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

// Returns true if the edges a-b and c-d have a common point.
bool do_cross(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  const auto side = [](const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& x) {
    const double volume = glm::dot(glm::cross(p, q - p), x - p);
    return std::abs(volume) < 1e-15 * glm::length(q - p) ? 0 : volume > 0 ? 1 : -1;
  };
  const int c_side = side(a, b, c);
  const int d_side = side(a, b, d);
  const int a_side = side(c, d, a);
  const int b_side = side(c, d, b);
  if (c_side * d_side > 0 || a_side * b_side > 0) return false;
  if (c_side == 0 && d_side == 0) {  // on one great circle
    const auto is_on = [](const glm::dvec3& x, const glm::dvec3& p, const glm::dvec3& q) {
      return glm::dot(x - p, q - p) >= 0 && glm::dot(x - q, p - q) >= 0;
    };
    return is_on(a, c, d) || is_on(b, c, d) || is_on(c, a, b);
  }
  // Great circles meet at two opposite points: the edges cross if both hold the same one.
  const glm::dvec3 meeting = glm::cross(glm::cross(a, b - a), glm::cross(c, d - c));
  return glm::dot(meeting, a + b) * glm::dot(meeting, c + d) > 0;
}

}  // namespace

std::vector<glm::dvec3> directions_of(std::span<const mars::LonLat> places) {
  std::vector<glm::dvec3> directions;
  directions.reserve(places.size());
  for (const mars::LonLat place : places) directions.push_back(mars::direction(place));
  return directions;
}

double line_length_rad(std::span<const glm::dvec3> line) {
  double length_rad = 0;
  for (std::size_t n = 1; n < line.size(); ++n) length_rad += mars::angle_between_rad(line[n - 1], line[n]);
  return length_rad;
}

double outline_length_rad(std::span<const glm::dvec3> polygon) {
  if (polygon.size() < 2) return 0;
  return line_length_rad(polygon) + mars::angle_between_rad(polygon.back(), polygon.front());
}

FanArea fan_area(std::span<const glm::dvec3> polygon) {
  FanArea fan;
  if (polygon.size() < 3) return fan;
  const bool is_near = std::all_of(polygon.begin(), polygon.end(), [&](const glm::dvec3& d) {
    return glm::dot(d, polygon.front()) > kNearFirst;
  });
  fan.reference = is_near ? polygon.front() : far_reference(polygon);
  for (std::size_t n = 0; n < polygon.size(); ++n)
    fan.sum += excess_rad(fan.reference, polygon[n], polygon[(n + 1) % polygon.size()]);
  fan.whole_spheres = static_cast<int>(std::lround(fan.sum / (4 * mars::kPi)));
  return fan;
}

double signed_sphere_area(std::span<const glm::dvec3> polygon) {
  const FanArea fan = fan_area(polygon);
  return fan.sum - fan.whole_spheres * 4 * mars::kPi;
}

std::optional<std::pair<std::size_t, std::size_t>> crossing_edges(std::span<const glm::dvec3> polygon) {
  std::vector<std::size_t> kept;  // vertices that differ from the one before
  for (std::size_t n = 0; n < polygon.size(); ++n)
    if (kept.empty() || polygon[n] != polygon[kept.back()]) kept.push_back(n);
  while (kept.size() > 1 && polygon[kept.back()] == polygon[kept.front()]) kept.pop_back();
  const std::size_t count = kept.size();
  if (count < 3) return std::nullopt;
  const auto vertex = [&](std::size_t n) -> const glm::dvec3& { return polygon[kept[n % count]]; };
  struct Edge {
    glm::dvec3 low;
    glm::dvec3 high;
    std::size_t index;
  };
  std::vector<Edge> edges;
  for (std::size_t n = 0; n < count; ++n) {
    const glm::dvec3& a = vertex(n);
    const glm::dvec3& b = vertex(n + 1);
    // A great circle bulges beyond the box of its ends by its sagitta.
    const double bulge = 1 - std::sqrt(std::max(0.0, 1 - glm::dot(b - a, b - a) / 4)) + 1e-15;
    edges.push_back({glm::min(a, b) - bulge, glm::max(a, b) + bulge, n});
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& p, const Edge& q) { return p.low.z < q.low.z; });
  const auto are_apart = [](const Edge& p, const Edge& q) {
    return p.high.x < q.low.x || q.high.x < p.low.x || p.high.y < q.low.y || q.high.y < p.low.y;
  };
  for (std::size_t n = 0; n < count; ++n) {
    for (std::size_t k = n + 1; k < count && edges[k].low.z <= edges[n].high.z; ++k) {
      if (are_apart(edges[n], edges[k])) continue;
      const std::size_t first = std::min(edges[n].index, edges[k].index);
      const std::size_t second = std::max(edges[n].index, edges[k].index);
      const bool is_next = first + 1 == second;
      const bool is_round = (second + 1) % count == first;
      bool meets = false;
      if (is_next || is_round) {
        // Neighbours overlap only where the outline turns back on itself.
        const glm::dvec3& corner = vertex(is_next ? second : first);
        const glm::dvec3 before = vertex(is_next ? first : second) - corner;
        const glm::dvec3 after = vertex((is_next ? second : first) + 1) - corner;
        meets = glm::dot(before, after) > 0 &&
                glm::length(glm::cross(before, after)) < 1e-14 * glm::length(before) * glm::length(after);
      } else {
        meets = do_cross(vertex(first), vertex(first + 1), vertex(second), vertex(second + 1));
      }
      if (meets) return std::pair{kept[first], kept[second]};
    }
  }
  return std::nullopt;
}

}  // namespace vpe::explore
