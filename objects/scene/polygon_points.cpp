#include "objects/scene/polygon_points.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <stdexcept>

namespace objects {

namespace {

constexpr double kLongestEdge = 0.1;              // of triangles
constexpr double kLeastCosine = 0.2588190451025;  // of 75 degrees
constexpr int kCentreSteps = 400;

// Returns a direction within 75 degrees of all corners, if it finds one. The mean comes first: it hardly
// depends on rounding, so that rocks are the same everywhere. Then comes nearly the middle of the smallest ball
// around the corners (Badoiu and Clarkson 2003).
glm::dvec3 middle_of(const std::vector<glm::dvec3>& corners) {
  const auto unit = [&corners](const glm::dvec3& sum) {
    const double length = glm::length(sum);
    return length > 0.01 ? sum / length : -corners.front();
  };
  const auto farthest = [&corners](const glm::dvec3& from) {
    const auto off = [&from](const glm::dvec3& p) { return glm::dot(p - from, p - from); };
    return *std::ranges::max_element(corners, {}, off);
  };
  glm::dvec3 mean{0, 0, 0};
  for (const glm::dvec3& corner : corners) mean += corner / static_cast<double>(corners.size());
  const glm::dvec3 middle = unit(mean);
  if (glm::dot(farthest(middle), middle) >= kLeastCosine) return middle;
  for (int n = 1; n <= kCentreSteps; ++n) mean += (farthest(mean) - mean) / (n + 1.0);
  return unit(mean);
}

// Returns the solid angle of a small triangle of unit vectors (Eriksson 1990, Mathematics Magazine 63).
double solid_angle_sr(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const double volume = glm::dot(glm::cross(b - a, c - a), a);
  return 2 * std::atan2(std::abs(volume), 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

struct FlatEdge {
  glm::dvec2 low;
  glm::dvec2 high;
  double x_at(double y) const {
    if (y <= low.y) return low.x;
    if (y >= high.y) return high.x;
    return low.x + (high.x - low.x) * ((y - low.y) / (high.y - low.y));
  }
};

struct Trapezoid {
  double low_y, high_y;
  double low_left, low_right, high_left, high_right;
};

// Cuts a plane polygon at the heights of its corners.
std::vector<Trapezoid> trapezoids_of(const std::vector<glm::dvec2>& corners) {
  std::vector<FlatEdge> edges;
  std::vector<double> heights;
  for (std::size_t n = 0; n < corners.size(); ++n) {
    const glm::dvec2& a = corners[n];
    const glm::dvec2& b = corners[(n + 1) % corners.size()];
    heights.push_back(a.y);
    if (a.y < b.y) edges.push_back({a, b});
    if (b.y < a.y) edges.push_back({b, a});
  }
  std::ranges::sort(heights);
  std::vector<Trapezoid> trapezoids;
  std::vector<glm::dvec2> crossings;  // x at the lower and upper height
  for (std::size_t n = 1; n < heights.size(); ++n) {
    const double low = heights[n - 1];
    const double high = heights[n];
    if (!(low < high)) continue;
    crossings.clear();
    for (const FlatEdge& edge : edges) {
      if (edge.low.y <= low && edge.high.y >= high) crossings.emplace_back(edge.x_at(low), edge.x_at(high));
    }
    std::ranges::sort(crossings, {}, [](const glm::dvec2& x) { return x.x + x.y; });
    for (std::size_t k = 1; k < crossings.size(); k += 2)
      trapezoids.push_back({low, high, crossings[k - 1].x, crossings[k].x, crossings[k - 1].y, crossings[k].y});
  }
  return trapezoids;
}

}  // namespace

PolygonPoints::PolygonPoints(std::span<const mars::LonLat> corners) {
  std::vector<glm::dvec3> directions;
  for (const mars::LonLat corner : corners) directions.push_back(mars::direction(corner));
  if (directions.size() < 3) throw std::invalid_argument("polygon: expected 3 corners or more");
  const glm::dvec3 middle = middle_of(directions);
  const glm::dvec3 x_axis = mars::any_perpendicular(middle);
  const glm::dvec3 y_axis = glm::cross(middle, x_axis);
  std::vector<glm::dvec2> flat;  // great circles are straight lines in this projection
  for (const glm::dvec3& direction : directions) {
    const double cosine = glm::dot(direction, middle);
    if (!(cosine >= kLeastCosine))
      throw std::invalid_argument("polygon: expected corners within 75 degrees of their middle");
    flat.emplace_back(glm::dot(direction, x_axis) / cosine, glm::dot(direction, y_axis) / cosine);
  }
  const auto raised = [&](double x, double y) { return glm::normalize(middle + x * x_axis + y * y_axis); };
  for (const Trapezoid& t : trapezoids_of(flat)) {
    const glm::dvec3 a = raised(t.low_left, t.low_y);
    const glm::dvec3 c = raised(t.high_right, t.high_y);
    add_triangle({a, raised(t.low_right, t.low_y), c});
    add_triangle({a, c, raised(t.high_left, t.high_y)});
  }
  if (triangles_.empty()) throw std::invalid_argument("polygon: expected corners that enclose an area");
}

void PolygonPoints::add_triangle(const Triangle& triangle) {
  std::vector<Triangle> open{triangle};
  while (!open.empty()) {
    Triangle t = open.back();
    open.pop_back();
    // The longest edge becomes a-b. Of equal ones it is the first, whatever the rounding.
    const auto is_longer = [](double length, double other) { return length > other * (1 + 1e-9); };
    if (is_longer(glm::distance(t.b, t.c), glm::distance(t.a, t.b))) t = {t.b, t.c, t.a};
    if (is_longer(glm::distance(t.c, t.a), glm::distance(t.a, t.b))) t = {t.c, t.a, t.b};
    if (glm::distance(t.a, t.b) > kLongestEdge) {
      const glm::dvec3 half = glm::normalize(t.a + t.b);
      open.push_back({t.a, half, t.c});
      open.push_back({half, t.b, t.c});
      continue;
    }
    const double area_sr = solid_angle_sr(t.a, t.b, t.c);
    if (!(area_sr > 0)) continue;
    triangles_.push_back(t);
    until_sr_.push_back((until_sr_.empty() ? 0 : until_sr_.back()) + area_sr);
  }
}

glm::dvec3 PolygonPoints::candidate(double triangle, double u, double v, double keep) const {
  const auto at = std::upper_bound(until_sr_.begin(), until_sr_.end() - 1, triangle * until_sr_.back());
  const Triangle& t = triangles_[static_cast<std::size_t>(at - until_sr_.begin())];
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const glm::dvec3 p = t.a + u * (t.b - t.a) + v * (t.c - t.a);
  // A piece of the plane has a solid angle as 1 / length^3. The length is at least this, as edges are short.
  constexpr double kLeastLength2 = 1 - kLongestEdge * kLongestEdge / 2.9;
  const double length2 = glm::dot(p, p);
  const double weight = kLeastLength2 / length2;
  return keep < weight * std::sqrt(weight) ? p / std::sqrt(length2) : glm::dvec3(0);
}

}  // namespace objects
