#include "vpe/voxel/volume/brick.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace vpe::voxel {

namespace {

void require_brick(bool is_met, const std::string& problem) {
  if (!is_met) throw std::invalid_argument("a brick of terrain: " + problem);
}

double length_at(double u, double v) { return std::sqrt(1 + u * u + v * v); }

// Returns the plane that fits the sphere over the corners of a frame best.
DepthPlane plane_over(const HeightGridFrame& frame, double radius_m) {
  const int n = frame.intervals;
  const auto depth = [&](int x, int y) {
    return length_at(frame.u0 + x * frame.du, frame.v0 + y * frame.dv) / radius_m;
  };
  const double a = depth(0, 0);
  const double b = depth(n, 0);
  const double c = depth(0, n);
  const double d = depth(n, n);
  return {(3 * a + b + c - d) / 4, (b - a + d - c) / (2.0 * n), (c - a + d - b) / (2.0 * n)};
}

// A solid part of a vertical in levels.
struct LevelSpan {
  double low = 0;
  double high = 0;
};

// Joins parts that overlap; the first one then goes on downwards.
void join(std::vector<LevelSpan>& spans) {
  std::sort(spans.begin(), spans.end(), [](const LevelSpan& a, const LevelSpan& b) { return a.low < b.low; });
  std::size_t last = 0;
  for (std::size_t n = 1; n < spans.size(); ++n) {
    if (spans[n].low <= spans[last].high) {
      spans[last].high = std::max(spans[last].high, spans[n].high);
    } else {
      spans[++last] = spans[n];
    }
  }
  spans.resize(last + 1);
}

// The verticals of one voxel's square.
class Verticals {
 public:
  void clear() { spans_.clear(); }
  void add(std::vector<LevelSpan> spans) { spans_.push_back(std::move(spans)); }

  // Returns the first level that is not solid as a whole, and the densities from there on.
  int densities(std::vector<std::uint8_t>& out) const {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const std::vector<LevelSpan>& spans : spans_) {
      low = std::min(low, spans.front().high);
      high = std::max(high, spans.back().high);
    }
    const int first = static_cast<int>(std::floor(low)) - 1;
    const int end = static_cast<int>(std::ceil(high)) + 2;
    out.clear();
    for (int k = first; k < end; ++k) {
      double solid = 0;
      for (const std::vector<LevelSpan>& spans : spans_) {
        bool is_lowest = true;
        for (const LevelSpan& span : spans) {
          const double from = is_lowest ? k - 0.5 : std::max(span.low, k - 0.5);
          solid += std::max(0.0, std::min(span.high, k + 0.5) - from);
          is_lowest = false;
        }
      }
      out.push_back(static_cast<std::uint8_t>(std::lround(255 * solid / static_cast<double>(spans_.size()))));
    }
    return first;
  }

 private:
  std::vector<std::vector<LevelSpan>> spans_;
};

}  // namespace

GridVolume make_brick(mars::Face face, const HeightGridFrame& frame, double radius_m, const SolidsAt& solids,
                      const BrickSpec& spec) {
  require_brick(frame.intervals >= 1 && frame.intervals < kMostVolumeSide,
                "expected 1 to " + std::to_string(kMostVolumeSide - 1) + " intervals");
  require_brick(frame.du > 0 && frame.dv > 0, "expected cells of a width");
  require_brick(spec.samples >= 1 && spec.samples <= kMostBrickSamples,
                "expected 1 to " + std::to_string(kMostBrickSamples) + " samples");
  const int side = frame.intervals + 1;
  const double length =
      length_at(frame.u0 + 0.5 * frame.intervals * frame.du, frame.v0 + 0.5 * frame.intervals * frame.dv);
  const double voxel_m = radius_m * std::sqrt(frame.du * frame.dv) / (length * std::sqrt(length));
  const double level_m = length * voxel_m;
  const DepthPlane plane = plane_over(frame, radius_m);
  BandColumns columns;
  Verticals verticals;
  std::vector<SolidSpan> found;
  std::vector<std::uint8_t> densities;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      verticals.clear();
      for (int n = 0; n < spec.samples * spec.samples; ++n) {
        const double x = i + (n % spec.samples + 0.5) / spec.samples - 0.5;
        const double y = j + (n / spec.samples + 0.5) / spec.samples - 0.5;
        const double u = frame.u0 + x * frame.du;
        const double v = frame.v0 + y * frame.dv;
        found.clear();
        solids(mars::chart_direction(face, u, v), found);
        require_brick(!found.empty(), "a column without solid ground");
        const double reference = plane.w0 + plane.wx * x + plane.wy * y;
        const auto level = [&](double height_m) {
          const double h =
              (reference - length_at(u, v) / (radius_m + height_m)) * radius_m * radius_m / level_m;
          require_brick(std::abs(h) < kMostBandLevel - 200, "a height is not finite, or farther than " +
                                                                std::to_string(kMostBandLevel - 200) +
                                                                " voxels from the sphere");
          return h;
        };
        std::vector<LevelSpan> spans;
        for (const SolidSpan& part : found) spans.push_back({level(part.low_m), level(part.high_m)});
        join(spans);
        verticals.add(std::move(spans));
      }
      const int first = verticals.densities(densities);
      columns.add(first, densities);
    }
  }
  return {face, frame, plane, level_m, voxel_m, BandVolume(side, side, spec.threshold, std::move(columns)),
          0,    0};
}

}  // namespace vpe::voxel
