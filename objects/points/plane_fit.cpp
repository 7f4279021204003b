#include "objects/points/plane_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

namespace objects {

namespace {

constexpr int kJacobiRounds = 20;     // three turns each; some six are needed
constexpr double kLeastWidth = 1e-4;  // of the points across their longest direction, squared: else a line
constexpr double kJacobiLimit = 1e-14;
constexpr double kJacobiNothing = 1e-30;  // of the diagonal: no turn, so that quotients stay finite

// Turns the axes p and q so that the entry (p, q) of a symmetric matrix vanishes (Jacobi 1846). `axes` has the turned
// axes as columns.
void turn_away(glm::dmat3& m, glm::dmat3& axes, int p, int q) {
  if (std::abs(m[p][q]) <= kJacobiNothing * (std::abs(m[p][p]) + std::abs(m[q][q]))) return;
  const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
  const double t = (theta < 0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1);
  const double s = t * c;
  for (int k = 0; k < 3; ++k) {
    const double kp = m[p][k];
    m[p][k] = c * kp - s * m[q][k];
    m[q][k] = s * kp + c * m[q][k];
  }
  for (int k = 0; k < 3; ++k) {
    const double kp = m[k][p];
    m[k][p] = c * kp - s * m[k][q];
    m[k][q] = s * kp + c * m[k][q];
  }
  const glm::dvec3 former = axes[p];
  axes[p] = c * former - s * axes[q];
  axes[q] = s * former + c * axes[q];
}

}  // namespace

void PlaneFit::add(const glm::dvec3& point) {
  ++count_;
  sum_ += point;
  const std::array<double, 6> products{point.x * point.x, point.y * point.y, point.z * point.z,
                                       point.x * point.y, point.x * point.z, point.y * point.z};
  for (std::size_t k = 0; k < products.size(); ++k) products_[k] += products[k];
}

std::optional<glm::dvec3> PlaneFit::normal() const {
  if (count_ < 3) return {};
  const auto count = static_cast<double>(count_);
  const glm::dvec3 mean = sum_ / count;
  const auto spread = [&](std::size_t k, double a, double b) { return products_[k] / count - a * b; };
  const double xy = spread(3, mean.x, mean.y);
  const double xz = spread(4, mean.x, mean.z);
  const double yz = spread(5, mean.y, mean.z);
  glm::dmat3 m(spread(0, mean.x, mean.x), xy, xz, xy, spread(1, mean.y, mean.y), yz, xz, yz,
               spread(2, mean.z, mean.z));
  glm::dmat3 axes(1);
  const double size = m[0][0] + m[1][1] + m[2][2];
  for (int round = 0; round < kJacobiRounds; ++round) {
    if (std::max({std::abs(m[0][1]), std::abs(m[0][2]), std::abs(m[1][2])}) <= kJacobiLimit * size) break;
    turn_away(m, axes, 0, 1);
    turn_away(m, axes, 0, 2);
    turn_away(m, axes, 1, 2);
  }
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return m[a][a] < m[b][b]; });
  const auto width = [&](std::size_t n) { return m[order[n]][order[n]]; };
  if (!(width(1) > kLeastWidth * width(2))) return {};
  return glm::normalize(axes[order[0]]);
}

}  // namespace objects
