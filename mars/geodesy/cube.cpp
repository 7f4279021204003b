#include "mars/geodesy/cube.h"

#include <algorithm>
#include <array>

namespace mars {

namespace {

constexpr std::array<FaceAxes, kFaces> kAxes{{
    {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
    {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}},
    {{0, -1, 0}, {0, 0, 1}, {-1, 0, 0}},
    {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
    {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}},
    {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
}};

// tan(k pi / 64) in units of 2^-20, rounded. The values are part of the file format.
constexpr std::array<std::int64_t, 17> kKnots{0,      51513,  103276, 155542, 208575, 262655,
                                              318082, 375186, 434334, 495940, 560476, 628492,
                                              700636, 777677, 860544, 950374, 1048576};
constexpr double kKnotUnit = 1.0 / 1048576.0;
constexpr int kKnotLevel = 5;
static_assert(1 << kKnotLevel == kWarpKnots);

}  // namespace

const FaceAxes& face_axes(Face face) { return kAxes[static_cast<std::size_t>(face)]; }

double face_line(std::int64_t index, int grid_level) {
  // Grids coarser than the knots use every second, fourth, ... knot.
  const int shift = std::max(0, kKnotLevel - grid_level);
  const int level = grid_level + shift;
  const std::int64_t offset = (index << shift) - (std::int64_t{1} << (level - 1));
  const std::int64_t distance = offset < 0 ? -offset : offset;
  const int gap_level = level - kKnotLevel;
  const std::int64_t gap = std::int64_t{1} << gap_level;
  const auto knot = static_cast<std::size_t>(distance >> gap_level);
  const std::int64_t rest = distance & (gap - 1);
  const std::int64_t next = knot + 1 < kKnots.size() ? kKnots[knot + 1] : kKnots[knot];
  const std::int64_t scaled = (kKnots[knot] << gap_level) + (next - kKnots[knot]) * rest;
  // As exact as std::ldexp(), which takes much longer.
  const double u = static_cast<double>(scaled) / static_cast<double>(gap) * kKnotUnit;
  return offset < 0 ? -u : u;
}

double face_parameter(double u) {
  const double scaled = std::min(std::abs(u), 1.0) / kKnotUnit;
  const auto* upper =
      std::upper_bound(kKnots.begin() + 1, kKnots.end() - 1, scaled,
                       [](double x, std::int64_t knot) { return x < static_cast<double>(knot); });
  const auto knot = static_cast<std::size_t>(upper - kKnots.begin()) - 1;
  const auto low = static_cast<double>(kKnots[knot]);
  const auto high = static_cast<double>(kKnots[knot + 1]);
  const double steps = static_cast<double>(knot) + (scaled - low) / (high - low);
  const double half = steps / kWarpKnots;
  return u < 0.0 ? 0.5 - half : 0.5 + half;
}

ChartPoint chart_point(const glm::dvec3& d) {
  const double x = std::abs(d.x);
  const double y = std::abs(d.y);
  const double z = std::abs(d.z);
  Face face = Face::kPlusX;
  const double largest = std::max({x, y, z});
  if (d.x == largest) {
    face = Face::kPlusX;
  } else if (d.y == largest) {
    face = Face::kPlusY;
  } else if (-d.x == largest) {
    face = Face::kMinusX;
  } else if (-d.y == largest) {
    face = Face::kMinusY;
  } else {
    face = d.z > 0.0 ? Face::kPlusZ : Face::kMinusZ;
  }
  return chart_on(face, d);
}

}  // namespace mars
