#include "vpe/overlay/isolines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <tuple>

namespace vpe::overlay {

namespace {

constexpr double kMostInACell = 1000;
constexpr double kLargestMultiple = 1e15;
constexpr std::size_t kNone = static_cast<std::size_t>(-1);

// Describes one end of a segment: where a line crosses the edge between two pixels. The adjacent segment has
// the same end.
struct End {
  std::int64_t multiple;
  std::size_t edge;  // 2 * pixel, + 1 for the edge downwards
  std::size_t segment;
  auto key() const { return std::tie(multiple, edge); }
};

struct Segment {
  std::int64_t multiple;
  std::array<std::size_t, 2> edge;
  std::array<glm::dvec2, 2> at;
  double spacing_px;
  std::array<std::size_t, 2> next{kNone, kNone};  // adjacent segment at each end
  bool used = false;
};

struct Corner {
  double value;
  glm::dvec2 at;
};

class Tracer {
 public:
  Tracer(const VisibleTerrain& terrain, const std::vector<double>& values, const IsolineOptions& options)
      : terrain_(terrain), values_(values), options_(options) {}

  std::vector<Isoline> run() {
    std::vector<double> here, next;
    bands_of_row(0, next);
    for (int y = 0; y + 1 < terrain_.height(); ++y) {
      std::swap(here, next);
      bands_of_row(y + 1, next);
      for (std::size_t x = 0; x + 1 < here.size(); ++x) {
        // Most cells lie between two lines.
        if (here[x] == here[x + 1] && here[x] == next[x] && here[x] == next[x + 1]) continue;
        cell(static_cast<int>(x), y);
      }
    }
    join();
    std::vector<Isoline> lines;
    // Open lines are traced first, from an end. Segments that remain belong to closed lines.
    for (const bool open : {true, false}) {
      for (std::size_t n = 0; n < segments_.size(); ++n) {
        const Segment& s = segments_[n];
        if (s.used) continue;
        if (open && s.next[0] != kNone && s.next[1] != kNone) continue;
        lines.push_back(chain(n, open && s.next[0] != kNone ? 1 : 0));
        lines.back().closed = !open;
      }
    }
    return lines;
  }

 private:
  // Sets the multiple of the step below each value of a row; NaN where the value is NaN, or a multiple up to rounding.
  void bands_of_row(int y, std::vector<double>& out) const {
    constexpr double kRounding = 1e-12;
    const double per_step = 1 / options_.step;
    const double* const row = &values_[terrain_.index(0, y)];
    out.resize(static_cast<std::size_t>(terrain_.width()));
    for (std::size_t x = 0; x < out.size(); ++x) {
      const double multiple = row[x] * per_step;
      const double below = std::floor(multiple);
      const double rest = multiple - below;
      const double least = kRounding * (1 + std::abs(multiple));
      out[x] = rest > least && rest < 1 - least ? below : std::numeric_limits<double>::quiet_NaN();
    }
  }

  void cell(int x, int y) {
    const std::size_t p = terrain_.index(x, y);
    const auto down = static_cast<std::size_t>(terrain_.width());
    std::array<double, 4> v{values_[p], values_[p + 1], values_[p + down + 1], values_[p + down]};
    if (std::isnan(v[0] + v[1] + v[2] + v[3])) return;
    if (options_.period > 0) {
      const auto difference = [period = options_.period](double from, double to) {
        const double straight = to - from;
        return std::abs(straight) <= 0.5 * period ? straight : straight - std::copysign(period, straight);
      };
      // Around a pole the differences add up to a full period.
      if (std::abs(difference(v[0], v[1]) + difference(v[1], v[2]) + difference(v[2], v[3]) +
                   difference(v[3], v[0])) > 1e-6)
        return;
      v[1] = v[0] + difference(v[0], v[1]);
      v[2] = v[1] + difference(v[1], v[2]);
      v[3] = v[0] + difference(v[0], v[3]);
    }
    const auto [low, high] = std::minmax({v[0], v[1], v[2], v[3]});
    const double step = options_.step;
    if ((high - low) / step > kMostInACell || std::abs(high / step) > kLargestMultiple) return;
    const auto first = static_cast<std::int64_t>(std::ceil(low / step));
    const auto last = static_cast<std::int64_t>(std::floor(high / step));
    if (first > last) return;
    if (options_.noise > 0 && high - low <= options_.noise * terrain_.noise_m(p)) return;
    const double slope = std::hypot(0.5 * (v[1] - v[0] + v[2] - v[3]), 0.5 * (v[3] - v[0] + v[2] - v[1]));
    const double spacing_px = step / std::max(slope, 1e-300);
    if (spacing_px < options_.densest_px || !terrain_.is_whole(x, y)) return;
    const std::array<Corner, 4> corners{Corner{v[0], {x + 0.5, y + 0.5}}, Corner{v[1], {x + 1.5, y + 0.5}},
                                        Corner{v[2], {x + 1.5, y + 1.5}}, Corner{v[3], {x + 0.5, y + 1.5}}};
    const std::array<std::size_t, 4> edges{2 * p, 2 * (p + 1) + 1, 2 * (p + down), 2 * p + 1};
    for (std::int64_t k = first; k <= last; ++k) {
      const std::int64_t multiple = within_period(k);
      if (options_.leave_out > 0 && multiple % options_.leave_out == 0) continue;
      if (options_.period > 0 && !is_a_line(multiple, k)) continue;
      cross(corners, edges, static_cast<double>(k) * step, multiple, spacing_px);
    }
  }

  // Multiples of angles one period apart are the same line if the step divides the period.
  std::int64_t within_period(std::int64_t k) const {
    if (options_.period <= 0) return k;
    const double value = static_cast<double>(k) * options_.step;
    double inside = std::remainder(value, options_.period);
    if (inside <= -0.5 * options_.period + 1e-9 * options_.step) inside += options_.period;
    return static_cast<std::int64_t>(std::llround(inside / options_.step));
  }
  bool is_a_line(std::int64_t multiple, std::int64_t k) const {
    const double off = std::remainder(static_cast<double>(multiple - k) * options_.step, options_.period);
    return std::abs(off) < 1e-6 * options_.step;
  }

  void cross(const std::array<Corner, 4>& corners, const std::array<std::size_t, 4>& edges, double level,
             std::int64_t multiple, double spacing_px) {
    std::array<std::size_t, 4> crossed{};
    std::size_t count = 0;
    for (std::size_t e = 0; e < 4; ++e) {
      if ((corners[e].value >= level) != (corners[(e + 1) % 4].value >= level)) crossed[count++] = e;
    }
    const auto add = [&](std::size_t from, std::size_t to) {
      segments_.push_back({multiple,
                           {edges[from], edges[to]},
                           {place(corners, from, level), place(corners, to, level)},
                           spacing_px});
    };
    if (count == 2) add(crossed[0], crossed[1]);
    if (count != 4) return;
    // At a saddle the mean decides which opposite corners are joined.
    const double mean = 0.25 * (corners[0].value + corners[1].value + corners[2].value + corners[3].value);
    const bool cut_off_first = (mean >= level) != (corners[0].value >= level);
    add(cut_off_first ? 3 : 0, cut_off_first ? 0 : 1);
    add(cut_off_first ? 1 : 2, cut_off_first ? 2 : 3);
  }

  static glm::dvec2 place(const std::array<Corner, 4>& corners, std::size_t edge, double level) {
    // Always interpolates from the upper or left corner, so that both cells beside an edge get the same point.
    const bool reversed = edge >= 2;
    const Corner& a = corners[reversed ? (edge + 1) % 4 : edge];
    const Corner& b = corners[reversed ? edge : (edge + 1) % 4];
    return a.at + (b.at - a.at) * std::clamp((level - a.value) / (b.value - a.value), 0.0, 1.0);
  }

  void join() {
    std::vector<End> ends;
    ends.reserve(2 * segments_.size());
    for (std::size_t n = 0; n < segments_.size(); ++n) {
      for (const std::size_t edge : segments_[n].edge) ends.push_back({segments_[n].multiple, edge, n});
    }
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
      return a.key() != b.key() ? a.key() < b.key() : a.segment < b.segment;
    });
    for (std::size_t n = 0; n + 1 < ends.size(); ++n) {
      if (ends[n].key() != ends[n + 1].key() || ends[n].segment == ends[n + 1].segment) continue;
      link(ends[n], ends[n + 1].segment);
      link(ends[n + 1], ends[n].segment);
      ++n;
    }
  }
  void link(const End& end, std::size_t other) {
    Segment& s = segments_[end.segment];
    s.next[s.edge[0] == end.edge ? 0 : 1] = other;
  }

  // Follows a line from a segment's end `entry` until it ends or returns to its first segment.
  Isoline chain(std::size_t n, std::size_t entry) {
    Isoline line;
    line.multiple = segments_[n].multiple;
    line.points.push_back(segments_[n].at[entry]);
    line.spacing_px.push_back(segments_[n].spacing_px);
    for (;;) {
      Segment& s = segments_[n];
      s.used = true;
      const std::size_t leave = 1 - entry;
      line.points.push_back(s.at[leave]);
      line.spacing_px.push_back(s.spacing_px);
      const std::size_t next = s.next[leave];
      if (next == kNone || segments_[next].used) break;
      entry = segments_[next].edge[0] == s.edge[leave] ? 0 : 1;
      n = next;
    }
    smooth(line.spacing_px);
    return line;
  }

  // Takes the harmonic mean over some points to each side, which removes noise of single cells.
  static void smooth(std::vector<double>& spacing) {
    constexpr std::size_t kReach = 12;
    std::vector<double> sums(spacing.size() + 1, 0.0);
    for (std::size_t n = 0; n < spacing.size(); ++n) sums[n + 1] = sums[n] + 1.0 / spacing[n];
    for (std::size_t n = 0; n < spacing.size(); ++n) {
      const std::size_t begin = n - std::min(n, kReach);
      const std::size_t end = std::min(n + kReach + 1, spacing.size());
      spacing[n] = static_cast<double>(end - begin) / std::max(sums[end] - sums[begin], 1e-300);
    }
  }

  const VisibleTerrain& terrain_;
  const std::vector<double>& values_;
  const IsolineOptions& options_;
  std::vector<Segment> segments_;
};

}  // namespace

double Isoline::length_px() const {
  double sum = 0;
  for (std::size_t n = 1; n < points.size(); ++n) sum += glm::length(points[n] - points[n - 1]);
  return sum;
}

std::vector<Isoline> isolines(const VisibleTerrain& terrain, const std::vector<double>& values,
                              const IsolineOptions& options) {
  return Tracer(terrain, values, options).run();
}

}  // namespace vpe::overlay
