#include "vpe/overlay/stroke_mask.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace vpe::overlay {
namespace {

// At a gentler turn the outer corner is as good as a round one: they differ by 0.02 of the half width.
constexpr float kGentleCosine = 0.93F;

PieceEnd corner_end(glm::vec2 along, glm::vec2 next, float radius_px) {
  const float cosine = glm::dot(along, next);
  // The tangent of half of the turn, as far out as pixels' centres are that the line touches.
  const float reach_px = radius_px + kPixelCorner_px;
  return {false,
          cosine < kGentleCosine ? 0 : reach_px * std::sqrt(std::max(0.0F, (1 - cosine) / (1 + cosine)))};
}

}  // namespace

StrokeMask::StrokeMask(int width, int height)
    : rows_{width, height, static_cast<std::size_t>(width + kStrokeLanes), nullptr, nullptr, height, 0} {
  coverage_.resize(rows_.stride * static_cast<std::size_t>(height));
  touched_.assign(static_cast<std::size_t>(height), TouchedRow{width, 0});
  rows_.coverage = coverage_.data();
  rows_.touched = touched_.data();
}

void StrokeMask::add(std::span<const glm::dvec2> points, bool closed, double width_px) {
  constexpr double kLeast_px = 1e-4;
  pieces_.clear();
  const auto radius_px = static_cast<float>(0.5 * width_px);
  const auto add_piece = [&](glm::dvec2 from, glm::dvec2 to) {
    const double length_px = glm::length(to - from);
    if (length_px <= kLeast_px) return false;
    pieces_.push_back(
        {from, glm::vec2((to - from) / length_px), static_cast<float>(length_px), radius_px, {}, {}});
    return true;
  };
  std::size_t last = 0;
  for (std::size_t n = 1; n < points.size(); ++n) {
    if (add_piece(points[last], points[n])) last = n;
  }
  if (closed && pieces_.size() > 1) add_piece(points[last], points[0]);
  const auto join = [&](StrokePiece& before, StrokePiece& after) {
    before.end = after.start = corner_end(before.along, after.along, radius_px);
    if (glm::dot(before.along, after.along) < kGentleCosine)
      cover_corner({after.from, before.along, after.along, radius_px}, rows_);
  };
  for (std::size_t n = 1; n < pieces_.size(); ++n) join(pieces_[n - 1], pieces_[n]);
  if (closed && pieces_.size() > 1) join(pieces_.back(), pieces_.front());
  cover_pieces(pieces_, rows_);
}

std::vector<std::vector<glm::dvec2>> dashes(std::span<const glm::dvec2> points,
                                            std::span<const double> lengths_px) {
  if (std::ranges::none_of(lengths_px, [](double length) { return length > 0; }))
    return {std::vector(points.begin(), points.end())};
  std::vector<std::vector<glm::dvec2>> parts;
  if (points.size() < 2) return parts;
  std::size_t number = 0;
  double left_px = lengths_px[0];
  bool is_on = true;
  std::vector<glm::dvec2> part{points[0]};
  for (std::size_t n = 1; n < points.size(); ++n) {
    glm::dvec2 at = points[n - 1];
    double rest_px = glm::length(points[n] - at);
    while (rest_px > left_px) {
      at += (points[n] - at) * (left_px / rest_px);
      rest_px -= left_px;
      if (is_on) {
        part.push_back(at);
        parts.push_back(part);
      }
      part = {at};
      is_on = !is_on;
      number = (number + 1) % lengths_px.size();
      left_px = lengths_px[number];
    }
    left_px -= rest_px;
    if (is_on) part.push_back(points[n]);
  }
  if (is_on && part.size() > 1) parts.push_back(part);
  return parts;
}

}  // namespace vpe::overlay
