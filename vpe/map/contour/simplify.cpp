#include "vpe/map/contour/simplify.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "vpe/base/parallel.h"
#include "vpe/map/contour/conflicts.h"

namespace vpe::map {

namespace {

// Marks of points that stay; kAdded: since the last round of part_lines().
constexpr std::uint8_t kKept = 1;
constexpr std::uint8_t kAdded = 2;

// Holds the marks of a line's points. A closed line has its first point again at the end.
struct KeptPoints {
  const ContourLine* line = nullptr;
  std::vector<std::uint8_t> keep;

  std::size_t size() const { return line->points.size() + (line->is_closed ? 1 : 0); }
  glm::dvec2 at(std::size_t n) const { return line->points[n == line->points.size() ? 0 : n]; }
};

double distance_to_segment(glm::dvec2 point, glm::dvec2 a, glm::dvec2 b) {
  const glm::dvec2 along = b - a;
  const double length2 = along.x * along.x + along.y * along.y;
  const glm::dvec2 from = point - a;
  const double share =
      length2 > 0 ? std::clamp((from.x * along.x + from.y * along.y) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(from.x - share * along.x, from.y - share * along.y);
}

struct FarPoint {
  std::size_t index = 0;
  double distance = -1;
};

FarPoint farthest_between(const KeptPoints& line, std::size_t begin, std::size_t end) {
  const glm::dvec2 a = line.at(begin);
  const glm::dvec2 b = line.at(end);
  FarPoint far;
  for (std::size_t n = begin + 1; n < end; ++n) {
    const double distance = distance_to_segment(line.at(n), a, b);
    if (distance > far.distance) far = {n, distance};
  }
  return far;
}

// Keeps the points that the tolerance needs between two kept ones.
void keep_within(KeptPoints& line, double tolerance, std::size_t begin, std::size_t end, std::uint8_t mark) {
  std::vector<std::pair<std::size_t, std::size_t>> open{{begin, end}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    const FarPoint far = farthest_between(line, first, last);
    // A ring must keep a way there and a way back.
    if (far.distance < 0 || (far.distance <= tolerance && line.at(first) != line.at(last))) continue;
    line.keep[far.index] = mark;
    open.emplace_back(first, far.index);
    open.emplace_back(far.index, last);
  }
}

// Calls visit(begin, end) for each piece between kept points.
template <typename Visit>
void for_each_piece(const KeptPoints& line, const Visit& visit) {
  std::size_t begin = 0;
  for (std::size_t end = 1; end < line.size(); ++end) {
    if (line.keep[end] == 0) continue;
    visit(begin, end);
    begin = end;
  }
}

bool comes_before(const glm::dvec2& a, const glm::dvec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; }

// Returns the places through which lines pass more than once, sorted. They are posts at a level.
std::vector<glm::dvec2> touching_places(const std::vector<ContourLine>& lines) {
  std::vector<glm::dvec2> posts;
  for (const ContourLine& line : lines)
    for (const glm::dvec2& point : line.points)
      if (point == glm::dvec2(std::floor(point.x), std::floor(point.y))) posts.push_back(point);
  std::sort(posts.begin(), posts.end(), comes_before);
  std::vector<glm::dvec2> touching;
  for (std::size_t n = 1; n < posts.size(); ++n)
    if (posts[n] == posts[n - 1] && (touching.empty() || touching.back() != posts[n]))
      touching.push_back(posts[n]);
  return touching;
}

// Keeps ends, and touching places with their neighbours: lines that touch cross nowhere if they leave such a
// place as before.
KeptPoints first_kept(const ContourLine& line, const std::vector<glm::dvec2>& touching) {
  KeptPoints kept{&line, {}};
  const std::size_t count = line.points.size();
  kept.keep.assign(kept.size(), 0);
  kept.keep.front() = kKept;
  for (std::size_t n = 0; n < count; ++n) {
    if (!std::binary_search(touching.begin(), touching.end(), line.points[n], comes_before)) continue;
    kept.keep[n] = kKept;
    if (n > 0 || line.is_closed) kept.keep[(n + count - 1) % count] = kKept;
    if (n + 1 < count || line.is_closed) kept.keep[(n + 1) % count] = kKept;
  }
  kept.keep.back() = kKept;
  return kept;
}

// Holds a segment of a simplified line by the indices of its points.
struct KeptPiece {
  std::uint32_t line = 0;
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

// Splits segments that meet others, until none does.
void part_lines(std::vector<KeptPoints>& lines, double tolerance, int threads) {
  for (bool is_first = true;; is_first = false) {
    std::vector<KeptPiece> kept;
    std::vector<LinePiece> pieces;
    for (std::size_t n = 0; n < lines.size(); ++n) {
      KeptPoints& line = lines[n];
      for_each_piece(line, [&](std::size_t begin, std::size_t end) {
        const bool is_new = is_first || line.keep[begin] == kAdded || line.keep[end] == kAdded;
        kept.push_back({static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(begin),
                        static_cast<std::uint32_t>(end)});
        pieces.push_back({line.at(begin), line.at(end), end == begin + 1, is_new});
      });
      for (std::uint8_t& keep : line.keep)
        if (keep == kAdded) keep = kKept;
    }
    const std::vector<std::uint8_t> conflicts = find_conflicts(pieces, threads);
    bool is_split = false;
    for (std::size_t n = 0; n < kept.size(); ++n) {
      if (conflicts[n] == 0 || pieces[n].is_given) continue;
      const auto [index, begin, end] = kept[n];
      KeptPoints& line = lines[index];
      const std::size_t middle = farthest_between(line, begin, end).index;
      line.keep[middle] = kAdded;
      // The parts of a piece that is within the tolerance need not be.
      keep_within(line, tolerance, begin, middle, kAdded);
      keep_within(line, tolerance, middle, end, kAdded);
      is_split = true;
    }
    if (!is_split) return;
  }
}

}  // namespace

void simplify_contours(std::vector<ContourLine>& lines, double tolerance_posts, int threads) {
  if (!(std::isfinite(tolerance_posts) && tolerance_posts >= 0))
    throw std::invalid_argument("simplify_contours: the tolerance must be 0 or above");
  const std::vector<glm::dvec2> touching = touching_places(lines);
  std::vector<KeptPoints> kept(lines.size());
  base::parallel_for(lines.size(), threads, [&](std::size_t n) {
    kept[n] = first_kept(lines[n], touching);
    const KeptPoints first = kept[n];
    for_each_piece(first, [&](std::size_t begin, std::size_t end) {
      keep_within(kept[n], tolerance_posts, begin, end, kKept);
    });
  });
  part_lines(kept, tolerance_posts, threads);
  base::parallel_for(lines.size(), threads, [&](std::size_t n) {
    std::vector<glm::dvec2> points;
    for (std::size_t i = 0; i < lines[n].points.size(); ++i)
      if (kept[n].keep[i] != 0) points.push_back(lines[n].points[i]);
    lines[n].points = std::move(points);
  });
}

}  // namespace vpe::map
