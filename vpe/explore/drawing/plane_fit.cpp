#include "vpe/explore/drawing/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <vector>

#include "mars/geodesy/sphere.h"

namespace vpe::explore {

namespace {

double degrees(double angle_rad) { return angle_rad / mars::kRadiansPerDegree; }

double turn_deg(double angle_deg) {
  const double turn = std::fmod(angle_deg, 360.0);
  const double positive = turn < 0 ? turn + 360 : turn;
  return positive >= 360 ? 0 : positive;
}

}  // namespace

void PlaneFit::Moments::add(const Moments& other, double factor) {
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) of[i][j] += factor * other.of[i][j];
}

PlaneFit::PlaneFit(const glm::dvec2& low_m, const glm::dvec2& high_m)
    : low_m_(low_m), size_m_(glm::max(high_m - low_m, glm::dvec2(1e-9))) {}

void PlaneFit::add(const glm::dvec3& a_m, const glm::dvec3& b_m, const glm::dvec3& c_m) {
  const glm::dvec2 ab(b_m - a_m);
  const glm::dvec2 ac(c_m - a_m);
  const double area_m2 = (ab.x * ac.y - ab.y * ac.x) / 2;
  const glm::dvec2 share = ((glm::dvec2(a_m) + glm::dvec2(b_m) + glm::dvec2(c_m)) / 3.0 - low_m_) / size_m_;
  const auto part = [](double s) {
    return static_cast<std::size_t>(std::clamp(s * kParts, 0.0, kParts - 1.0));
  };
  const std::array<std::array<double, 4>, 3> corners{
      {{1, a_m.x, a_m.y, a_m.z}, {1, b_m.x, b_m.y, b_m.z}, {1, c_m.x, c_m.y, c_m.z}}};
  Moments& moments = parts_[part(share.y) * kParts + part(share.x)];
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      double sum_i = 0;
      double sum_j = 0;
      double products = 0;
      for (const auto& corner : corners) {
        sum_i += corner[i];
        sum_j += corner[j];
        products += corner[i] * corner[j];
      }
      moments.of[i][j] += area_m2 / 12 * (sum_i * sum_j + products);
    }
  }
}

// Returns the height at the origin and both slopes.
std::optional<glm::dvec3> PlaneFit::solve(const Moments& moments) {
  const auto& m = moments.of;
  const double area = m[0][0];
  if (!(std::abs(area) > 0)) return std::nullopt;
  const glm::dvec3 mean{m[0][1] / area, m[0][2] / area, m[0][3] / area};
  const double xx = m[1][1] / area - mean.x * mean.x;
  const double xy = m[1][2] / area - mean.x * mean.y;
  const double yy = m[2][2] / area - mean.y * mean.y;
  const double xz = m[1][3] / area - mean.x * mean.z;
  const double yz = m[2][3] / area - mean.y * mean.z;
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > 1e-12 * (xx + yy) * (xx + yy))) return std::nullopt;
  const glm::dvec2 slope{(xz * yy - yz * xy) / determinant, (yz * xx - xz * xy) / determinant};
  return glm::dvec3{mean.z - slope.x * mean.x - slope.y * mean.y, slope.x, slope.y};
}

std::optional<FittedPlane> PlaneFit::plane() const {
  Moments all;
  for (const Moments& part : parts_) all.add(part, 1);
  const std::optional<glm::dvec3> solved = solve(all);
  if (!solved) return std::nullopt;
  FittedPlane plane;
  plane.height_m = solved->x;
  plane.slope = {solved->y, solved->z};
  const double steepness = std::hypot(plane.slope.x, plane.slope.y);
  plane.dip_deg = degrees(std::atan(steepness));
  plane.dip_azimuth_deg = turn_deg(degrees(std::atan2(-plane.slope.x, -plane.slope.y)));
  plane.strike_deg = turn_deg(plane.dip_azimuth_deg - 90);

  const std::array<double, 4> of_residual{-plane.height_m, -plane.slope.x, -plane.slope.y, 1};
  double squares = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) squares += of_residual[i] * all.of[i][j] * of_residual[j];
  plane.residual_m = std::sqrt(std::max(0.0, squares / all.of[0][0]));

  std::vector<glm::dvec2> without;
  for (const Moments& part : parts_) {
    if (part.of[0][0] == 0) continue;
    Moments rest = all;
    rest.add(part, -1);
    if (const auto slope = solve(rest)) without.emplace_back(slope->y, slope->z);
  }
  constexpr std::size_t kLeast = 4;
  if (without.size() < kLeast) return plane;
  glm::dvec2 mean(0);
  for (const glm::dvec2& slope : without) mean += slope / static_cast<double>(without.size());
  // Along the fall line and across it; a level plane has no fall line, and any direction does.
  const glm::dvec2 along = steepness > 0 ? plane.slope / steepness : glm::dvec2(1, 0);
  glm::dvec2 variance(0);
  for (const glm::dvec2& slope : without) {
    const glm::dvec2 off = slope - mean;
    const glm::dvec2 turned{off.x * along.x + off.y * along.y, off.y * along.x - off.x * along.y};
    variance += turned * turned;
  }
  const double count = static_cast<double>(without.size());
  variance *= (count - 1) / count;
  plane.dip_error_deg = degrees(std::sqrt(variance.x) / (1 + steepness * steepness));
  plane.strike_error_deg = steepness > 0 ? std::min(180.0, degrees(std::sqrt(variance.y) / steepness)) : 180.0;
  return plane;
}

}  // namespace vpe::explore
