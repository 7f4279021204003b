#include "vpe/voxel/volume/grid_volume.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/voxel/columns/grid_ray.h"

namespace vpe::voxel {

namespace {

double chart_length(double u, double v) { return std::sqrt(1 + u * u + v * v); }

// The distance of a range of coordinates from 0.
double nearest_to_0(double a, double b) { return a <= 0 && b >= 0 ? 0.0 : std::min(std::abs(a), std::abs(b)); }

// Turns differences of H over a grid into bounds of differences of height.
class HeightBound {
 public:
  HeightBound(const HeightGridFrame& frame, const DepthPlane& reference, double highest, double radius_m) {
    const int n = frame.intervals;
    const double u1 = frame.u0 + n * frame.du;
    const double v1 = frame.v0 + n * frame.dv;
    // A place at the depth w over the point (u, v) lies length / w from the centre. The length is convex and the depth of one H is
    // linear, so their ratio is greatest at a corner.
    for (const int corner : {0, 1, 2, 3}) {
      const int x = (corner & 1) != 0 ? n : 0;
      const int y = (corner & 2) != 0 ? n : 0;
      const double depth = reference.w0 + reference.wx * x + reference.wy * y - highest / (radius_m * radius_m);
      const double length = chart_length(frame.u0 + x * frame.du, frame.v0 + y * frame.dv);
      top_m_ = std::max(top_m_, depth > 0 ? length / depth : std::numeric_limits<double>::infinity());
    }
    const double shortest = chart_length(nearest_to_0(frame.u0, u1), nearest_to_0(frame.v0, v1));
    per_h_ = top_m_ * top_m_ / (radius_m * radius_m * shortest);
  }
  double height_m(double h) const { return per_h_ * h; }
  // Returns a bound of the distance from the centre of all that is not above `highest`.
  double top_m() const { return top_m_; }

 private:
  double per_h_ = 1;
  double top_m_ = 0;
};

}  // namespace

glm::dvec3 GridVolume::voxel_of(const glm::dvec3& place_m, double radius_m) const {
  const GridRay ray(place_m, {0, 0, 0}, 0, face, frame, reference, radius_m);
  const glm::dvec4& at = ray.at();
  return {at.x / at.w, at.y / at.w, at.z / (at.w * level_m)};
}

double GridVolume::height_m(const glm::dvec3& voxel, double radius_m) const {
  const double depth = reference.w0 + reference.wx * voxel.x + reference.wy * voxel.y -
                       voxel.z * level_m / (radius_m * radius_m);
  return chart_length(frame.u0 + voxel.x * frame.du, frame.v0 + voxel.y * frame.dv) / depth - radius_m;
}

double GridVolume::highest_m(double radius_m) const {
  return HeightBound(frame, reference, (voxels.maxima().highest() + 1) * level_m, radius_m).top_m();
}

GridVolume make_grid_volume(mars::Face face, const HeightGridFrame& frame, const HeightGridLines<float>& lines,
                            LineFamily family, double radius_m, const BandSpec& spec) {
  const int side = frame.intervals + 1;
  const double u = frame.u0 + 0.5 * frame.intervals * frame.du;
  const double v = frame.v0 + 0.5 * frame.intervals * frame.dv;
  const double length = chart_length(u, v);
  const double voxel_m = radius_m * std::sqrt(frame.du * frame.dv) / (length * std::sqrt(length));
  VolumeHeights heights{side, side, {}};
  double farthest = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const float h = post_height(lines, family, x, y);
      heights.heights.push_back(h);
      farthest = std::max(farthest, static_cast<double>(std::abs(h)));
    }
  }
  constexpr double kMostLevels = kMostBandLevel - 400;
  const double level_m = std::max(length * voxel_m, farthest / kMostLevels);
  for (float& h : heights.heights) h = static_cast<float>(static_cast<double>(h) / level_m);
  GridVolume made{face, frame, lines.reference, level_m, voxel_m, make_band_volume(heights, spec), 0, 0};

  // The surface of the reference lies between the posts of a cell, as its facets are flat in these coordinates. That of the
  // voxels lies between the crossings of its columns, since a mean of four densities passes a level where they do.
  double deviation = 0;
  double boundary_deviation = 0;
  double highest = -std::numeric_limits<double>::infinity();
  const auto post = [&](int x, int y) {
    return static_cast<double>(heights.heights[static_cast<std::size_t>(y * side + x)]);
  };
  std::vector<BandVolume::Crossings> crossings;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) crossings.push_back(made.voxels.crossings(x, y));
  for (int y = 0; y < frame.intervals; ++y) {
    for (int x = 0; x < frame.intervals; ++x) {
      double low_post = post(x, y);
      double high_post = low_post;
      BandVolume::Crossings crossing = crossings[static_cast<std::size_t>(y * side + x)];
      for (const int corner : {1, 2, 3}) {
        const int i = x + (corner & 1);
        const int j = y + (corner >> 1);
        low_post = std::min(low_post, post(i, j));
        high_post = std::max(high_post, post(i, j));
        const BandVolume::Crossings& other = crossings[static_cast<std::size_t>(j * side + i)];
        crossing = {std::min(crossing.low, other.low), std::max(crossing.high, other.high)};
      }
      deviation = std::max(deviation, std::max(crossing.high - low_post, high_post - crossing.low));
      const BandVolume::Span& cells = made.voxels.span(x, y);
      const double top = std::max(cells.high + 1.0, static_cast<double>(cells.low));
      const double bottom = std::min(cells.low, cells.high);
      boundary_deviation = std::max(boundary_deviation, std::max(top - low_post, high_post - bottom));
      highest = std::max(highest, std::max(top, high_post));
    }
  }
  const HeightBound bound(frame, lines.reference, highest * level_m, radius_m);
  made.deviation_m = bound.height_m(deviation * level_m);
  made.boundary_deviation_m = bound.height_m(boundary_deviation * level_m);
  return made;
}

}  // namespace vpe::voxel
