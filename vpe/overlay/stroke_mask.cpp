#include "vpe/overlay/stroke_mask.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <utility>

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

// So far beside the image pieces keep their bits.
constexpr double kKept_px = 16384;

bool is_near(glm::dvec2 p, glm::dvec2 size_px) {
  return glm::all(glm::greaterThan(p, glm::dvec2(-kKept_px))) && glm::all(glm::lessThan(p, size_px + kKept_px));
}

// Cuts a piece to what is near the image, whose distances float can hold. Returns false if nothing of it is.
bool cut_to_near(glm::dvec2& from, glm::dvec2& to, glm::dvec2 size_px) {
  const glm::dvec2 way = to - from;
  double begin = 0, end = 1;
  for (int axis = 0; axis < 2; ++axis) {
    double low = (-kKept_px - from[axis]) / way[axis];
    double high = (size_px[axis] + kKept_px - from[axis]) / way[axis];
    if (way[axis] == 0) {
      if (from[axis] < -kKept_px || from[axis] > size_px[axis] + kKept_px) return false;
      continue;
    }
    if (low > high) std::swap(low, high);
    begin = std::max(begin, low);
    end = std::min(end, high);
  }
  if (begin >= end) return false;
  const glm::dvec2 start = from;
  if (begin > 0) from = start + begin * way;
  if (end < 1) to = start + end * way;
  return true;
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
  const glm::dvec2 size_px(rows_.width, rows_.height);
  const auto add_piece = [&](glm::dvec2 from, glm::dvec2 to) {
    if (!(is_near(from, size_px) && is_near(to, size_px)) && !cut_to_near(from, to, size_px)) return;
    const double length_px = glm::length(to - from);
    if (length_px <= kLeast_px) return;
    pieces_.push_back(
        {from, glm::vec2((to - from) / length_px), static_cast<float>(length_px), radius_px, {}, {}});
  };
  const glm::dvec2* first = nullptr;
  const glm::dvec2* last = nullptr;
  int edges = 0;
  for (const glm::dvec2& point : points) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
    if (last == nullptr) first = last = &point;
    if (glm::length(point - *last) <= kLeast_px) continue;
    add_piece(*last, point);
    last = &point;
    ++edges;
  }
  const bool is_ring = closed && edges > 1;
  if (is_ring && glm::length(*first - *last) > kLeast_px) add_piece(*last, *first);
  // Pieces that were cut, or have others between them that were left out, meet nowhere near.
  const auto join = [&](StrokePiece& before, StrokePiece& after) {
    if (!is_near(after.from, size_px)) return;
    before.end = after.start = corner_end(before.along, after.along, radius_px);
    if (glm::dot(before.along, after.along) < kGentleCosine)
      cover_corner({after.from, before.along, after.along, radius_px}, rows_);
  };
  for (std::size_t n = 1; n < pieces_.size(); ++n) join(pieces_[n - 1], pieces_[n]);
  if (is_ring && !pieces_.empty()) join(pieces_.back(), pieces_.front());
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
