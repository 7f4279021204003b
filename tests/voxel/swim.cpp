#include "tests/voxel/swim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace test_support {

namespace core = vpe::core;

namespace {

constexpr double kSameRange = 1.01;
constexpr double kEven = 0.5;  // of a step, between the mean of its neighbours and itself
constexpr double kAway_px = 2.0;

// Returns true if the inverse range changes evenly from a over b and c to d.
bool even(double a, double b, double c, double d) {
  const double step = c - b;
  return std::abs(step - 0.5 * (b - a + d - c)) <= kEven * std::abs(step) ||
         std::abs(step) <= (kSameRange - 1) * b;
}

bool one_surface(const RangeImage& p, int x, int y) {
  std::array<std::array<double, 4>, 4> inverse{};
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) {
      const float range = p.range(x - 1 + i, y - 1 + j);
      if (!(range > 0) || std::isinf(range)) return false;
      inverse[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = 1.0 / static_cast<double>(range);
    }
  }
  const auto [low, high] = std::minmax({inverse[1][1], inverse[1][2], inverse[2][1], inverse[2][2]});
  if (high <= kSameRange * low) return true;
  for (std::size_t k = 1; k < 3; ++k) {
    if (!even(inverse[k][0], inverse[k][1], inverse[k][2], inverse[k][3])) return false;
    if (!even(inverse[0][k], inverse[1][k], inverse[2][k], inverse[3][k])) return false;
  }
  return true;
}

// Metres from the planet's centre.
glm::dvec3 place_of(const RangeImage& p, int x, int y) {
  return p.view.camera.position_m +
         static_cast<double>(p.range(x, y)) * core::pixel_ray(p.view, x + 0.5, y + 0.5);
}

double pop_px(const RangeImage& before, const RangeImage& now, int x, int y) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto range = static_cast<double>(now.range(x, y));
  if (!(range > 0) || std::isinf(range)) return kNone;
  const glm::dvec3 point = place_of(now, x, y);
  const core::Projected at = core::project(before.view, point);
  if (at.behind) return kNone;
  const int i = static_cast<int>(std::floor(at.xy.x - 0.5));
  const int j = static_cast<int>(std::floor(at.xy.y - 0.5));
  if (i < 1 || j < 1 || i + 2 >= before.view.width || j + 2 >= before.view.height) return kNone;
  if (!one_surface(before, i, j)) return kNone;
  const bool upper = at.xy.x - 0.5 - i + at.xy.y - 0.5 - j <= 1;
  const glm::dvec3 a = place_of(before, upper ? i : i + 1, upper ? j : j + 1);
  const glm::dvec3 normal = glm::cross(place_of(before, i + 1, j) - a, place_of(before, i, j + 1) - a);
  const double radius = glm::length(point);
  const double before_m = radius * glm::dot(normal, a) / glm::dot(normal, point);
  if (!(std::abs(before_m) < 2 * radius)) return kNone;
  const core::Projected there = core::project(before.view, point * (before_m / radius));
  if (there.behind || glm::length(there.xy - at.xy) > kAway_px) return kNone;
  return (radius - before_m) * core::focal_px(now.view) / range;
}

}  // namespace

std::vector<float> pops_px(const RangeImage& before, const RangeImage& now, vpe::base::ThreadPool& pool) {
  std::vector<float> out(now.range_m.size());
  const auto width = static_cast<std::size_t>(now.view.width);
  pool.run(static_cast<std::size_t>(now.view.height), [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x)
      out[y * width + x] = static_cast<float>(pop_px(before, now, static_cast<int>(x), static_cast<int>(y)));
  });
  return out;
}

void Pops::add(std::span<const float> pops_px) {
  for (const float pop : pops_px) {
    if (std::isnan(pop)) continue;
    const double size = std::abs(static_cast<double>(pop));
    ++measured_;
    max_px_ = std::max(max_px_, size);
    ++bins_[std::min(bins_.size() - 1, static_cast<std::size_t>(size * kPerPixel))];
  }
}

void Pops::add(const Pops& other) {
  measured_ += other.measured_;
  max_px_ = std::max(max_px_, other.max_px_);
  for (std::size_t k = 0; k < bins_.size(); ++k) bins_[k] += other.bins_[k];
}

double Pops::quantile_px(double share) const {
  const double wanted = share * static_cast<double>(measured_);
  std::int64_t sum = 0;
  for (std::size_t k = 0; k + 1 < bins_.size(); ++k) {
    sum += bins_[k];
    if (static_cast<double>(sum) >= wanted) return static_cast<double>(k + 1) / kPerPixel;
  }
  return max_px_;
}

double Pops::share_over(double px) const {
  std::int64_t sum = 0;
  for (auto k = static_cast<std::size_t>(px * kPerPixel); k < bins_.size(); ++k) sum += bins_[k];
  return measured_ == 0 ? 0 : static_cast<double>(sum) / static_cast<double>(measured_);
}

}  // namespace test_support
