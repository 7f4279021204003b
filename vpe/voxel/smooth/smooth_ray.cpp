#include "vpe/voxel/smooth/smooth_ray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace vpe::voxel {

namespace {

// Rounding of squares of distances from the centre, relative to the largest of them.
constexpr double kSquareRounding = 1e-15;
// Parts of a ray are not divided further, relative to its length and to the distance from the centre.
constexpr double kShortOfRange = 1e-10;
constexpr double kShortOfPlace = 1e-14;

// A block of 2^b x 2^b cells; b = 0: one cell.
struct BlockPart {
  int b, i, j;
  double s0, s1;
};

// Where a ray crosses a line of the chart, and on which side it is before: 0 below the line, 1 above.
struct LineCrossing {
  double s;
  int before;
  int behind;
};

LineCrossing crossing(double e, double d, double out_e, double out_d, double line) {
  const double rate = d - line * out_d;
  const double start = e - line * out_e;
  if (rate == 0) {
    const int side = start >= 0 ? 1 : 0;
    return {std::numeric_limits<double>::infinity(), side, side};
  }
  const int behind = rate > 0 ? 1 : 0;
  return {-start / rate, 1 - behind, behind};
}

class TileSearch {
 public:
  TileSearch(const SmoothTile& tile, double radius_m, double exaggeration, const FaceRay& ray,
             PatchCache& patches)
      : tile_(tile), radius_m_(radius_m), exaggeration_(exaggeration), ray_(ray), patches_(patches) {}

  bool run(const TileBlock& block, const RaySegment& segment, TileMeeting& found, bool& is_near) {
    slack_ = kSquareRounding * (ray_.ee + segment.s1 * segment.s1);
    std::size_t count = 0;
    waiting_[count++] = {block.b, block.i, block.j, segment.s0, segment.s1};
    bool is_first = true;
    while (count > 0) {
      const BlockPart part = waiting_[--count];
      if (part.b == 0) {
        if (meet_cell(part, found)) return true;
        continue;
      }
      if (is_above(part)) continue;
      is_near = is_near || is_first;
      is_first = false;
      divide(part, count);
    }
    return false;
  }

 private:
  double square(double s) const { return ray_.ee + s * (2 * ray_.ed + s); }

  bool is_above(const BlockPart& part) const {
    const double nearest = std::clamp(-ray_.ed, part.s0, part.s1);
    const double highest =
        radius_m_ + exaggeration_ * static_cast<double>(tile_.bounds(part.b, part.i, part.j).high_m);
    return square(nearest) - slack_ > highest * highest;
  }

  void divide(const BlockPart& part, std::size_t& count) {
    const int half = part.b - 1;
    const auto u_line = tile_.u_lines()[static_cast<std::size_t>((2 * part.i + 1) << half)];
    const auto v_line = tile_.v_lines()[static_cast<std::size_t>((2 * part.j + 1) << half)];
    const LineCrossing u = crossing(ray_.e.x, ray_.d.x, ray_.e.z, ray_.d.z, u_line);
    const LineCrossing v = crossing(ray_.e.y, ray_.d.y, ray_.e.z, ray_.d.z, v_line);
    const bool has_u = u.s > part.s0 && u.s < part.s1;
    const bool has_v = v.s > part.s0 && v.s < part.s1;
    const auto side = [&part](const LineCrossing& c) { return part.s0 < c.s ? c.before : c.behind; };
    // Far parts first, so that the nearest is taken first.
    std::array<double, 4> ends{part.s0, part.s1, part.s1, part.s1};
    int pieces = 1;
    if (has_u) ends[static_cast<std::size_t>(pieces++)] = u.s;
    if (has_v) ends[static_cast<std::size_t>(pieces++)] = v.s;
    if (pieces == 3 && ends[2] < ends[1]) std::swap(ends[1], ends[2]);
    ends[static_cast<std::size_t>(pieces)] = part.s1;
    for (int n = pieces; n-- > 0;) {
      const double a = ends[static_cast<std::size_t>(n)];
      const double b = ends[static_cast<std::size_t>(n) + 1];
      // The side on the way to the end of the piece.
      const int right = has_u ? (b <= u.s ? u.before : u.behind) : side(u);
      const int up = has_v ? (b <= v.s ? v.before : v.behind) : side(v);
      waiting_[count++] = {half, 2 * part.i + right, 2 * part.j + up, a, b};
    }
  }

  bool meet_cell(const BlockPart& part, TileMeeting& found) const {
    const SmoothPatch& patch = patches_.get(tile_, part.i, part.j, exaggeration_);
    const double nearest = std::clamp(-ray_.ed, part.s0, part.s1);
    const double highest = radius_m_ + exaggeration_ * tile_.base_m() + patch.highest;
    if (square(nearest) - slack_ > highest * highest) return false;
    const auto at = [](int k) { return static_cast<std::size_t>(k); };
    const double u = tile_.u_lines()[at(part.i)];
    const double v = tile_.v_lines()[at(part.j)];
    const double per_du = 1 / (tile_.u_lines()[at(part.i) + 1] - u);
    const double per_dv = 1 / (tile_.v_lines()[at(part.j) + 1] - v);
    const glm::dvec3 p = ray_.e + part.s0 * ray_.d;
    RayInCell ray;
    ray.rr = glm::dot(p, p);
    ray.rd = glm::dot(p, ray_.d);
    ray.base_m = radius_m_ + exaggeration_ * tile_.base_m();
    ray.u0 = (p.x - u * p.z) * per_du;
    ray.u1 = (ray_.d.x - u * ray_.d.z) * per_du;
    ray.v0 = (p.y - v * p.z) * per_dv;
    ray.v1 = (ray_.d.y - v * ray_.d.z) * per_dv;
    ray.w0 = p.z;
    ray.w1 = ray_.d.z;
    const double shortest = kShortOfRange * part.s1 + kShortOfPlace * ray.base_m;
    const double t = first_meeting(ray, patch, part.s1 - part.s0, shortest);
    if (!(t < kNoMeeting)) return false;
    found = {part.s0 + t, part.i, part.j};
    return true;
  }

  const SmoothTile& tile_;
  double radius_m_;
  double exaggeration_;
  const FaceRay& ray_;
  PatchCache& patches_;
  double slack_ = 0;
  std::array<BlockPart, 40> waiting_;  // three for each of at most seven levels, and cells
};

}  // namespace

FaceRay::FaceRay(mars::Face face, const glm::dvec3& origin_m, const glm::dvec3& direction) {
  const mars::FaceAxes& axes = mars::face_axes(face);
  e = {glm::dot(axes.right, origin_m), glm::dot(axes.up, origin_m), glm::dot(axes.out, origin_m)};
  d = {glm::dot(axes.right, direction), glm::dot(axes.up, direction), glm::dot(axes.out, direction)};
  ee = glm::dot(e, e);
  ed = glm::dot(e, d);
}

bool cut_to_rect(const FaceRay& ray, double u0, double u1, double v0, double v1, RaySegment& segment) {
  const auto cut = [&segment](double start, double rate) {
    if (rate > 0) {
      segment.s0 = std::max(segment.s0, -start / rate);
    } else if (rate < 0) {
      segment.s1 = std::min(segment.s1, -start / rate);
    } else if (start < 0) {
      segment.s1 = -std::numeric_limits<double>::infinity();
    }
  };
  cut(ray.e.x - u0 * ray.e.z, ray.d.x - u0 * ray.d.z);
  cut(u1 * ray.e.z - ray.e.x, u1 * ray.d.z - ray.d.x);
  cut(ray.e.y - v0 * ray.e.z, ray.d.y - v0 * ray.d.z);
  cut(v1 * ray.e.z - ray.e.y, v1 * ray.d.z - ray.d.y);
  return segment.s0 <= segment.s1;
}

bool meet_block(const SmoothTile& tile, const TileBlock& block, double radius_m, double exaggeration,
                const FaceRay& ray, const RaySegment& segment, PatchCache& patches, TileMeeting& found,
                bool& is_near) {
  return TileSearch(tile, radius_m, exaggeration, ray, patches).run(block, segment, found, is_near);
}

PatchPoint patch_point(const SmoothTile& tile, const SmoothPatch& patch, double exaggeration,
                       const glm::dvec3& point_m, int i, int j) {
  const mars::FaceAxes& axes = mars::face_axes(tile.key().face);
  const double out = glm::dot(axes.out, point_m);
  const double u = glm::dot(axes.right, point_m) / out;
  const double v = glm::dot(axes.up, point_m) / out;
  const auto at = [](int k) { return static_cast<std::size_t>(k); };
  const double u0 = tile.u_lines()[at(i)];
  const double v0 = tile.v_lines()[at(j)];
  const double du = tile.u_lines()[at(i) + 1] - u0;
  const double dv = tile.v_lines()[at(j) + 1] - v0;
  const SmoothPatch::Value ground = patch.at((u - u0) / du, (v - v0) / dv);
  // Gradients of the chart's coordinates.
  const glm::dvec3 u_way = (axes.right - u * axes.out) / out;
  const glm::dvec3 v_way = (axes.up - v * axes.out) / out;
  const glm::dvec3 slope = glm::normalize(point_m) - (ground.hu / du) * u_way - (ground.hv / dv) * v_way;
  return {exaggeration * tile.base_m() + ground.h, glm::normalize(slope)};
}

}  // namespace vpe::voxel
