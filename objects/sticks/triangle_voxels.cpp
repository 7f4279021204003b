#include "objects/sticks/triangle_voxels.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace objects {

namespace {

constexpr double kVoxelTouch = 1e-7;  // voxels

struct PlaceRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  int first(int size) const {
    return static_cast<int>(std::clamp(std::floor(low - kVoxelTouch), 0.0, static_cast<double>(size - 1)));
  }
  int last(int size) const {
    return static_cast<int>(std::clamp(std::floor(high + kVoxelTouch), 0.0, static_cast<double>(size - 1)));
  }
};

// Tests cubes of edge 1 against one triangle.
class CubeTest {
 public:
  explicit CubeTest(const VoxelTriangle& t) : t_(t) {
    for (std::size_t n = 0; n < 3; ++n) edges_[n] = t[(n + 1) % 3] - t[n];
    const glm::dvec3 n = glm::cross(edges_[0], edges_[1]);
    const double longest = std::max(
        {glm::dot(edges_[0], edges_[0]), glm::dot(edges_[1], edges_[1]), glm::dot(edges_[2], edges_[2])});
    const double area = glm::length(n);
    is_flat_ = !(area > 1e-9 * longest);
    if (is_flat_) return;
    normal_ = n / area;
    // The direction of the normal of a narrow triangle is less exact.
    plane_slack_ = kVoxelTouch + 1e-14 * longest * std::sqrt(longest) / area;
  }

  bool is_flat() const { return is_flat_; }
  const glm::dvec3& normal() const { return normal_; }
  double plane_slack() const { return plane_slack_; }

  bool touches(const glm::dvec3& centre) const {
    const std::array<glm::dvec3, 3> v{t_[0] - centre, t_[1] - centre, t_[2] - centre};
    for (int k = 0; k < 3; ++k) {
      if (std::min({v[0][k], v[1][k], v[2][k]}) > 0.5 + kVoxelTouch ||
          std::max({v[0][k], v[1][k], v[2][k]}) < -0.5 - kVoxelTouch)
        return false;
    }
    const glm::dvec3 size = glm::abs(normal_);
    if (std::abs(glm::dot(normal_, v[0])) > 0.5 * (size.x + size.y + size.z) + plane_slack_) return false;
    for (std::size_t n = 0; n < 3; ++n) {
      const glm::dvec3& e = edges_[n];
      const glm::dvec3& a = v[n];            // and the other end of the edge: the same
      const glm::dvec3& b = v[(n + 2) % 3];  // the corner beside the edge
      if (is_apart(a.z * e.y - a.y * e.z, b.z * e.y - b.y * e.z, e.y, e.z) ||
          is_apart(a.x * e.z - a.z * e.x, b.x * e.z - b.z * e.x, e.z, e.x) ||
          is_apart(a.y * e.x - a.x * e.y, b.y * e.x - b.x * e.y, e.x, e.y))
        return false;
    }
    return true;
  }

 private:
  static bool is_apart(double p, double q, double e, double f) {
    const double reach = (0.5 + kVoxelTouch) * (std::abs(e) + std::abs(f)) + 1e-9;
    return std::min(p, q) > reach || std::max(p, q) < -reach;
  }

  const VoxelTriangle& t_;
  std::array<glm::dvec3, 3> edges_;
  glm::dvec3 normal_{0, 0, 1};
  double plane_slack_ = 0;
  bool is_flat_ = false;
};

// Returns the range along axis w of the part of a triangle with u between two places.
PlaceRange range_in_row(const VoxelTriangle& t, int u, int w, double u_low, double u_high) {
  PlaceRange range;
  for (std::size_t n = 0; n < 3; ++n) {
    const glm::dvec3& a = t[n];
    const glm::dvec3& b = t[(n + 1) % 3];
    if (a[u] >= u_low && a[u] <= u_high) range.add(a[w]);
    for (const double side : {u_low, u_high}) {
      if ((a[u] < side) != (b[u] < side)) range.add(a[w] + (b[w] - a[w]) * ((side - a[u]) / (b[u] - a[u])));
    }
  }
  return range;
}

}  // namespace

void append_voxels(const VoxelTriangle& t, const glm::ivec3& size, std::vector<glm::ivec3>& out) {
  const CubeTest test(t);
  if (test.is_flat()) return;
  const glm::dvec3 n = test.normal();
  const glm::dvec3 steep = glm::abs(n);
  // Rows along u and w; depth d changes by at most one voxel from one to the next.
  const int d = steep.x > steep.y ? (steep.x > steep.z ? 0 : 2) : (steep.y > steep.z ? 1 : 2);
  const int u = (d + 1) % 3;
  const int w = (d + 2) % 3;
  std::array<PlaceRange, 3> box;
  for (int k = 0; k < 3; ++k) {
    for (const glm::dvec3& corner : t) box[static_cast<std::size_t>(k)].add(corner[k]);
  }
  const PlaceRange& depths = box[static_cast<std::size_t>(d)];
  const double per_u = -n[u] / n[d];
  const double per_w = -n[w] / n[d];
  const double reach = 0.5 * (std::abs(per_u) + std::abs(per_w)) + 2 * test.plane_slack();
  const int first_u = box[static_cast<std::size_t>(u)].first(size[u]);
  const int last_u = box[static_cast<std::size_t>(u)].last(size[u]);
  glm::ivec3 at;
  for (at[u] = first_u; at[u] <= last_u; ++at[u]) {
    const PlaceRange row = range_in_row(t, u, w, at[u] - kVoxelTouch, at[u] + 1 + kVoxelTouch);
    if (!(row.low <= row.high)) continue;
    const int last_w = row.last(size[w]);
    for (at[w] = row.first(size[w]); at[w] <= last_w; ++at[w]) {
      const double depth = t[0][d] + per_u * (at[u] + 0.5 - t[0][u]) + per_w * (at[w] + 0.5 - t[0][w]);
      PlaceRange cell;
      cell.add(std::max(depth - reach, depths.low));
      cell.add(std::min(depth + reach, depths.high));
      const int last_d = cell.last(size[d]);
      for (at[d] = cell.first(size[d]); at[d] <= last_d; ++at[d]) {
        if (test.touches(glm::dvec3(at) + 0.5)) out.push_back(at);
      }
    }
  }
}

double area_in_voxel(const VoxelTriangle& t, const glm::ivec3& voxel) {
  std::array<glm::dvec3, 9> polygon;  // a triangle cut by six planes
  std::array<glm::dvec3, 9> cut;
  std::size_t count = 3;
  std::copy(t.begin(), t.end(), polygon.begin());
  for (int k = 0; k < 3; ++k) {
    for (const double sign : {-1.0, 1.0}) {
      const double side = sign < 0 ? voxel[k] : voxel[k] + 1.0;
      std::size_t kept = 0;
      for (std::size_t n = 0; n < count; ++n) {
        const glm::dvec3& a = polygon[n];
        const glm::dvec3& b = polygon[(n + 1) % count];
        const double from = sign * (side - a[k]);  // positive inside
        const double to = sign * (side - b[k]);
        if (from >= 0 && kept < cut.size()) cut[kept++] = a;
        if ((from < 0) != (to < 0) && kept < cut.size()) cut[kept++] = a + (b - a) * (from / (from - to));
      }
      count = kept;
      if (count < 3) return 0;
      polygon = cut;
    }
  }
  glm::dvec3 sum(0);
  for (std::size_t n = 1; n + 1 < count; ++n)
    sum += glm::cross(polygon[n] - polygon[0], polygon[n + 1] - polygon[0]);
  return 0.5 * glm::length(sum);
}

std::array<double, 2> nearest_weights(const VoxelTriangle& t, const glm::dvec3& point) {
  const glm::dvec3 ab = t[1] - t[0];
  const glm::dvec3 ac = t[2] - t[0];
  const glm::dvec3 ap = point - t[0];
  const double d1 = glm::dot(ab, ap);
  const double d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  const glm::dvec3 bp = point - t[1];
  const double d3 = glm::dot(ab, bp);
  const double d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
  const glm::dvec3 cp = point - t[2];
  const double d5 = glm::dot(ab, cp);
  const double d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1 - w, w};
  }
  const double sum = va + vb + vc;
  return {vb / sum, vc / sum};
}

}  // namespace objects
