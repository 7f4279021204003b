#include "objects/volumes/volume_spans.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>

namespace objects {

namespace {

using CellPosts = std::array<double, 8>;  // x runs fastest

CellPosts posts_of(const CellStretch& stretch) {
  constexpr int kSide = VolumeLevel::kBrickSide;
  const std::uint8_t* low = stretch.posts();
  CellPosts out{};
  for (int n = 0; n < 8; ++n)
    out[static_cast<std::size_t>(n)] = low[(n & 1) + kSide * (((n >> 1) & 1) + kSide * (n >> 2))];
  return out;
}

// The field along a ray in a cell, less a threshold: a polynomial of a share of the stretch, 0 to 1.
class FieldCubic {
 public:
  // Takes the shares of the cell's edges where the stretch begins and ends.
  FieldCubic(const CellPosts& posts, const glm::dvec3& from, const glm::dvec3& to, double threshold) {
    const glm::dvec3 way = to - from;
    std::array<std::array<double, 2>, 4> edge{};  // coefficients, as of all below
    for (std::size_t n = 0; n < 4; ++n) {
      const double step = posts[2 * n + 1] - posts[2 * n];
      edge[n] = {posts[2 * n] + from.x * step, way.x * step};
    }
    std::array<std::array<double, 3>, 2> face{};
    for (std::size_t n = 0; n < 2; ++n) {
      const std::array<double, 2>& low = edge[2 * n];
      const std::array<double, 2> step{edge[2 * n + 1][0] - low[0], edge[2 * n + 1][1] - low[1]};
      face[n] = {low[0] + from.y * step[0], low[1] + from.y * step[1] + way.y * step[0], way.y * step[1]};
    }
    const std::array<double, 3>& low = face[0];
    const std::array<double, 3> step{face[1][0] - low[0], face[1][1] - low[1], face[1][2] - low[2]};
    of_ = {low[0] + from.z * step[0] - threshold, low[1] + from.z * step[1] + way.z * step[0],
           low[2] + from.z * step[2] + way.z * step[1], way.z * step[2]};
    find_cuts();
  }

  double at(double s) const { return of_[0] + s * (of_[1] + s * (of_[2] + s * of_[3])); }
  // Between these, from 0 to 1, it ascends or descends.
  std::size_t cuts() const { return cuts_; }
  double cut(std::size_t n) const { return cut_[n]; }

  // Returns where it passes 0 between a cut and the next one, on the side that is not below 0.
  double crossing(std::size_t n, bool rises) const {
    constexpr int kHalvings = 52;
    double low = cut_[n];
    double high = cut_[n + 1];
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (low + high);
      ((at(middle) >= 0) == rises ? high : low) = middle;
    }
    return rises ? high : low;
  }

 private:
  void find_cuts() {
    cut_[cuts_++] = 0;
    const double discriminant = of_[2] * of_[2] - 3 * of_[3] * of_[1];
    if (discriminant > 0) {
      // Of the two forms of a root of the derivative, these lose no digits.
      const double q = -(of_[2] + std::copysign(std::sqrt(discriminant), of_[2]));
      const double a = of_[3] == 0 ? -1 : q / (3 * of_[3]);
      const double b = of_[1] / q;
      for (const double s : {std::min(a, b), std::max(a, b)}) {
        if (s > 0 && s < 1) cut_[cuts_++] = s;
      }
    }
    cut_[cuts_++] = 1;
  }

  std::array<double, 4> of_{};  // coefficients of s to the power of 0 to 3
  std::array<double, 4> cut_{};
  std::size_t cuts_ = 0;
};

// Gathers stretches that ascend, and joins those that touch.
class SpanList {
 public:
  void add(double begin, double end) {
    if (!spans_.empty() && begin <= spans_.back().end) {
      spans_.back().end = std::max(spans_.back().end, end);
    } else {
      spans_.push_back({begin, end});
    }
  }
  std::vector<SolidSpan>& spans() { return spans_; }

 private:
  std::vector<SolidSpan> spans_;
};

// Adds where the field of a cell is at least a threshold, in stored units.
void add_cell(const LatticeRay& ray, const CellStretch& stretch, double threshold, double slack,
              SpanList& out) {
  const CellPosts posts = posts_of(stretch);
  const auto [least, most] = std::minmax_element(posts.begin(), posts.end());
  if (*most < threshold - slack) return;
  if (*least >= threshold) {
    out.add(stretch.begin, stretch.end);
    return;
  }
  const auto share = [&](double t) {
    return glm::clamp(ray.origin + t * ray.direction - glm::dvec3(stretch.cell), 0.0, 1.0);
  };
  const FieldCubic field(posts, share(stretch.begin), share(stretch.end), threshold);
  double begin = stretch.begin;
  bool is_solid = field.at(0) >= -slack;
  for (std::size_t n = 1; n < field.cuts(); ++n) {
    const bool was_solid = is_solid;
    is_solid = field.at(field.cut(n)) >= -slack;
    if (is_solid == was_solid) continue;
    const double t = stretch.begin + field.crossing(n - 1, is_solid) * (stretch.end - stretch.begin);
    if (was_solid) out.add(begin, std::min(t, stretch.end));
    begin = t;
  }
  if (is_solid) out.add(std::min(begin, stretch.end), stretch.end);
}

// Components this small do not leave a lattice, and would overflow where they divide.
glm::dvec3 without_tiny_parts(const glm::dvec3& direction) {
  constexpr double kTiny = 1e-290;
  glm::dvec3 out = direction;
  for (int k = 0; k < 3; ++k)
    if (std::abs(out[k]) < kTiny) out[k] = 0;
  return out;
}

}  // namespace

std::vector<SolidSpan> volume_spans(const VolumeLevel& level, const VolumeRay& ray, double begin, double end,
                                    double threshold_per_m) {
  if (!std::isfinite(threshold_per_m)) throw std::invalid_argument("a threshold of extinction must be finite");
  const glm::dvec3 direction = without_tiny_parts(ray.direction);
  const double cells_per_t = glm::length(direction) / static_cast<double>(level.lattice.spacing_m);
  if (!std::isfinite(glm::length(ray.origin_m)) || !std::isfinite(cells_per_t) || !(cells_per_t > 0)) return {};
  if (!(begin < end)) return {};
  if (threshold_per_m <= 0) return {{begin, end}};
  const double threshold = threshold_per_m / static_cast<double>(level.unit_per_m);
  const double slack = std::min(kVolumeValueError, threshold / 2);
  // An origin far away would round places in each cell in another way, so it is moved to the lattice once.
  const LatticeRay whole = in_lattice(level.lattice, {ray.origin_m, direction}, begin, end);
  if (!(whole.begin < whole.end) || !std::isfinite(whole.begin) || !std::isfinite(whole.end)) return {};
  const VolumeRay moved{ray.origin_m + whole.begin * direction, direction};
  const LatticeRay local = in_lattice(level.lattice, moved, 0, whole.end - whole.begin);
  SpanList list;
  visit_cells(level, local, [&](const CellStretch& stretch) {
    add_cell(local, stretch, threshold, slack, list);
    return true;
  });
  std::vector<SolidSpan>& spans = list.spans();
  const auto of_ray = [&](double t) {
    return t >= local.end ? whole.end : std::min(whole.begin + t, whole.end);
  };
  for (SolidSpan& s : spans) s = {of_ray(s.begin), of_ray(s.end)};
  const double touch = kVolumeTouch_cells / cells_per_t;
  join_spans(spans, touch);
  std::erase_if(spans, [&](const SolidSpan& s) { return !(s.end - s.begin > touch); });
  return spans;
}

double default_threshold_per_m(const VolumeModel& model) { return 0.5 * model.largest_per_m(); }

}  // namespace objects
