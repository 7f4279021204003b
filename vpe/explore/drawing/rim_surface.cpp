#include "vpe/explore/drawing/rim_surface.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace vpe::explore {

double mean_value_height(std::span<const glm::dvec2> outline, std::span<const double> heights_m,
                         const glm::dvec2& place) {
  constexpr double kTouches = 1e-12;  // of the distance of two corners
  const std::size_t count = outline.size();
  double weights = 0;
  double sum_m = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t next = n + 1 == count ? 0 : n + 1;
    const glm::dvec2 a = outline[n] - place;
    const glm::dvec2 b = outline[next] - place;
    const double a_length = glm::length(a);
    const double b_length = glm::length(b);
    const double edge = glm::length(b - a);
    if (a_length <= kTouches * edge) return heights_m[n];
    if (b_length <= kTouches * edge) return heights_m[next];
    const double cross = a.x * b.y - a.y * b.x;
    const double dot = glm::dot(a, b);
    if (dot < 0 && std::abs(cross) <= kTouches * edge * edge) {  // on the edge
      const double share = a_length / (a_length + b_length);
      return (1 - share) * heights_m[n] + share * heights_m[next];
    }
    // tan(angle / 2) of the angle from a to b, without a difference of equal numbers.
    const double product = a_length * b_length;
    const double half = dot < 0 ? (product - dot) / cross : cross / (product + dot);
    weights += half / a_length + half / b_length;
    sum_m += half / a_length * heights_m[n] + half / b_length * heights_m[next];
  }
  return sum_m / weights;
}

RimSurface::RimSurface(std::span<const glm::dvec2> outline, std::span<const double> heights_m) {
  if (outline.size() < 3 || outline.size() != heights_m.size())
    throw std::invalid_argument("a rim needs at least three corners with a height each");
  low_ = outline.front();
  glm::dvec2 high = low_;
  for (const glm::dvec2& corner : outline) {
    low_ = glm::min(low_, corner);
    high = glm::max(high, corner);
  }
  size_ = high - low_;
  if (!(size_.x > 0 && size_.y > 0)) throw std::invalid_argument("the rim has no extent");
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i)
      heights_m_.push_back(
          mean_value_height(outline, heights_m, low_ + size_ * glm::dvec2(i, j) / static_cast<double>(kCells)));
}

double RimSurface::at(const glm::dvec2& place) const {
  const glm::dvec2 xy = glm::clamp((place - low_) / size_, 0.0, 1.0) * static_cast<double>(kCells);
  const int i = std::min(static_cast<int>(xy.x), kCells - 1);
  const int j = std::min(static_cast<int>(xy.y), kCells - 1);
  const glm::dvec2 share = xy - glm::dvec2(i, j);
  const auto node = [&](int di, int dj) {
    return heights_m_[static_cast<std::size_t>(j + dj) * (kCells + 1) + static_cast<std::size_t>(i + di)];
  };
  return (1 - share.y) * ((1 - share.x) * node(0, 0) + share.x * node(1, 0)) +
         share.y * ((1 - share.x) * node(0, 1) + share.x * node(1, 1));
}

}  // namespace vpe::explore
