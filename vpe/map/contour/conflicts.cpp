#include "vpe/map/contour/conflicts.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "vpe/base/parallel.h"

namespace vpe::map {

namespace {

constexpr double kLeastCell = 8;
constexpr double kMostCells = 1 << 22;

// Bounds the rounding error of the determinant in side_of(), relative to its terms (Shewchuk 1997 has
// 3.33e-16).
constexpr double kSideError = 1e-15;

// Returns on which side of the line through a and b a point lies: -1 or 1; 0 if rounding leaves it open.
int side_of(glm::dvec2 a, glm::dvec2 b, glm::dvec2 point) {
  const double left = (a.x - point.x) * (b.y - point.y);
  const double right = (a.y - point.y) * (b.x - point.x);
  const double error = kSideError * (std::abs(left) + std::abs(right));
  if (left - right > error) return 1;
  return left - right < -error ? -1 : 0;
}

// Decides for segments that have the end `common` in common and lead to `a` and `b`.
bool overlap_from(glm::dvec2 common, glm::dvec2 a, glm::dvec2 b) {
  if (side_of(common, a, b) != 0) return false;
  const glm::dvec2 to_a = a - common;
  const glm::dvec2 to_b = b - common;
  return to_a.x * to_b.x + to_a.y * to_b.y > 0;
}

bool boxes_meet(const LinePiece& a, const LinePiece& b) {
  return std::min(a.begin.x, a.end.x) <= std::max(b.begin.x, b.end.x) &&
         std::min(b.begin.x, b.end.x) <= std::max(a.begin.x, a.end.x) &&
         std::min(a.begin.y, a.end.y) <= std::max(b.begin.y, b.end.y) &&
         std::min(b.begin.y, b.end.y) <= std::max(a.begin.y, a.end.y);
}

// Holds the segments near each square of a grid over the plane.
class SquareIndex {
 public:
  explicit SquareIndex(std::span<const LinePiece> pieces) {
    glm::dvec2 most{0};
    for (const LinePiece& piece : pieces)
      most = {std::max({most.x, piece.begin.x, piece.end.x}), std::max({most.y, piece.begin.y, piece.end.y})};
    side_ = std::max(kLeastCell, std::sqrt((most.x + 1) * (most.y + 1) / kMostCells));
    columns_ = square(most.x) + 1;
    rows_ = square(most.y) + 1;
    first_.assign(columns_ * rows_ + 1, 0);
    for (const LinePiece& piece : pieces) visit(piece, [&](std::size_t cell) { ++first_[cell + 1]; });
    for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
    members_.resize(first_.back());
    std::vector<std::size_t> at(first_.begin(), first_.end() - 1);
    for (std::size_t n = 0; n < pieces.size(); ++n)
      visit(pieces[n], [&](std::size_t cell) { members_[at[cell]++] = static_cast<std::uint32_t>(n); });
  }

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }
  std::span<const std::uint32_t> of(std::size_t cell) const {
    return {members_.data() + first_[cell], members_.data() + first_[cell + 1]};
  }

 private:
  std::size_t square(double x) const { return static_cast<std::size_t>(std::max(x, 0.0) / side_); }

  // Visits the squares that a segment touches, and some beside them.
  template <typename Visit>
  void visit(const LinePiece& piece, const Visit& cell) const {
    const glm::dvec2 a = piece.begin.x <= piece.end.x ? piece.begin : piece.end;
    const glm::dvec2 b = piece.begin.x <= piece.end.x ? piece.end : piece.begin;
    constexpr double kSlack = 1e-6;
    for (std::size_t column = square(a.x); column <= square(b.x); ++column) {
      const double left = std::max(a.x, static_cast<double>(column) * side_);
      const double right = std::min(b.x, static_cast<double>(column + 1) * side_);
      const auto y = [&](double x) { return b.x > a.x ? a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x)) : a.y; };
      const double y_left = y(left);
      const double y_right = b.x > a.x ? y(right) : b.y;
      const std::size_t last = std::min(square(std::max(y_left, y_right) + kSlack), rows_ - 1);
      for (std::size_t row = square(std::min(y_left, y_right) - kSlack); row <= last; ++row)
        cell(row * columns_ + column);
    }
  }

  double side_ = kLeastCell;
  std::size_t columns_ = 1;
  std::size_t rows_ = 1;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> members_;
};

}  // namespace

bool may_meet(const LinePiece& a, const LinePiece& b) {
  if (!boxes_meet(a, b)) return false;
  const bool same_begin = a.begin == b.begin;
  const bool same_end = a.end == b.end;
  const bool end_to_begin = a.end == b.begin;
  const bool begin_to_end = a.begin == b.end;
  if ((same_begin && same_end) || (end_to_begin && begin_to_end)) return true;
  if (same_begin) return overlap_from(a.begin, a.end, b.end);
  if (same_end) return overlap_from(a.end, a.begin, b.begin);
  if (end_to_begin) return overlap_from(a.end, a.begin, b.end);
  if (begin_to_end) return overlap_from(a.begin, a.end, b.begin);
  if (side_of(a.begin, a.end, b.begin) * side_of(a.begin, a.end, b.end) > 0) return false;
  return side_of(b.begin, b.end, a.begin) * side_of(b.begin, b.end, a.end) <= 0;
}

std::vector<std::uint8_t> find_conflicts(std::span<const LinePiece> pieces, int threads) {
  const SquareIndex index(pieces);
  const auto marks = std::make_unique<std::atomic<std::uint8_t>[]>(pieces.size());
  base::parallel_for(index.rows(), threads, [&](std::size_t row) {
    for (std::size_t column = 0; column < index.columns(); ++column) {
      const std::span<const std::uint32_t> members = index.of(row * index.columns() + column);
      for (std::size_t i = 0; i < members.size(); ++i) {
        const LinePiece& a = pieces[members[i]];
        for (std::size_t j = i + 1; j < members.size(); ++j) {
          const LinePiece& b = pieces[members[j]];
          if ((a.is_given && b.is_given) || !(a.is_new || b.is_new) || !may_meet(a, b)) continue;
          marks[members[i]].store(1, std::memory_order_relaxed);
          marks[members[j]].store(1, std::memory_order_relaxed);
        }
      }
    }
  });
  std::vector<std::uint8_t> found(pieces.size());
  for (std::size_t n = 0; n < found.size(); ++n) found[n] = marks[n].load(std::memory_order_relaxed);
  return found;
}

}  // namespace vpe::map
