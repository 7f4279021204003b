#include "vpe/voxel/volume/brick.h"

#include <algorithm>
#include <atomic>
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

// Joins sorted parts that overlap.
void join(std::vector<LevelSpan>& spans) {
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

// Returns true if two verticals have as many parts, which begin and end within a level.
bool is_alike(const std::vector<LevelSpan>& a, const std::vector<LevelSpan>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t n = 0; n < a.size(); ++n) {
    if (!(std::abs(a[n].low - b[n].low) <= 1 && std::abs(a[n].high - b[n].high) <= 1)) return false;
  }
  return true;
}

// Returns what lies between two such verticals.
std::vector<LevelSpan> between(const std::vector<LevelSpan>& a, const std::vector<LevelSpan>& b, double share) {
  std::vector<LevelSpan> out;
  for (std::size_t n = 0; n < a.size(); ++n)
    out.push_back({a[n].low + share * (b[n].low - a[n].low), a[n].high + share * (b[n].high - a[n].high)});
  return out;
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

// Makes the columns of voxels of a brick.
class BrickMaker {
 public:
  BrickMaker(mars::Face face, const HeightGridFrame& frame, double radius_m, const SolidsAt& solids,
             int samples)
      : face_(face), frame_(frame), radius_m_(radius_m), solids_(solids), samples_(samples) {
    const double middle = 0.5 * frame.intervals;
    const double length = length_at(frame.u0 + middle * frame.du, frame.v0 + middle * frame.dv);
    const double base_m = radius_m + lowest_top_m(middle, middle);
    require_brick(base_m > 0, "it reaches the planet's centre");
    plane_ = plane_over(frame, base_m);
    voxel_m_ = radius_m * std::sqrt(frame.du * frame.dv) / (length * std::sqrt(length));
    level_m_ = length * voxel_m_ * radius_m / base_m;
  }

  const DepthPlane& plane() const { return plane_; }
  double voxel_m() const { return voxel_m_; }
  double level_m() const { return level_m_; }

  struct Column {
    int first = 0;
    std::vector<std::uint8_t> densities;
  };
  // Returns the columns of the rows from `begin` to before `end`, row by row.
  std::vector<Column> rows(int begin, int end) const {
    // One vertical in the middle of each voxel, also of those beside the rows.
    std::vector<std::vector<LevelSpan>> middles;
    const int width = frame_.intervals + 3;
    for (int j = begin - 1; j <= end; ++j)
      for (int i = -1; i <= frame_.intervals + 1; ++i) middles.push_back(spans_at(i, j));
    std::vector<Column> out;
    Verticals verticals;
    for (int j = begin; j < end; ++j) {
      for (int i = 0; i <= frame_.intervals; ++i) {
        verticals.clear();
        const auto middle = [&](int x, int y) -> const std::vector<LevelSpan>& {
          return middles[static_cast<std::size_t>((y - begin + 1) * width + x + 1)];
        };
        add_verticals(middle, i, j, verticals);
        Column column;
        column.first = verticals.densities(column.densities);
        out.push_back(std::move(column));
      }
    }
    return out;
  }

 private:
  // Adds the verticals of voxel (i, j): between those of the middles where these are alike, as away from walls and edges.
  template <class Middle>
  void add_verticals(const Middle& middle, int i, int j, Verticals& verticals) const {
    bool is_even = true;
    for (int y = j - 1; y <= j + 1; ++y)
      for (int x = i - 1; x <= i + 1; ++x) is_even = is_even && is_alike(middle(i, j), middle(x, y));
    for (int n = 0; n < samples_ * samples_; ++n) {
      const double x = (n % samples_ + 0.5) / samples_ - 0.5;
      const double y = (n / samples_ + 0.5) / samples_ - 0.5;
      if (!is_even) {
        verticals.add(spans_at(i + x, j + y));
        continue;
      }
      const int west = x < 0 ? i - 1 : i;
      const int south = y < 0 ? j - 1 : j;
      verticals.add(between(between(middle(west, south), middle(west + 1, south), x - (west - i)),
                            between(middle(west, south + 1), middle(west + 1, south + 1), x - (west - i)),
                            y - (south - j)));
    }
  }

  std::vector<SolidSpan> solids_at(double x, double y) const {
    std::vector<SolidSpan> found;
    solids_(mars::chart_direction(face_, frame_.u0 + x * frame_.du, frame_.v0 + y * frame_.dv), found);
    require_brick(!found.empty(), "a column without solid ground");
    return found;
  }

  double lowest_top_m(double x, double y) const {
    const std::vector<SolidSpan> found = solids_at(x, y);
    const auto lowest = std::ranges::min_element(found, {}, &SolidSpan::low_m);
    require_brick(std::isfinite(lowest->high_m), "a height is not finite");
    return lowest->high_m;
  }

  std::vector<LevelSpan> spans_at(double x, double y) const {
    const double length = length_at(frame_.u0 + x * frame_.du, frame_.v0 + y * frame_.dv);
    const double reference = plane_.w0 + plane_.wx * x + plane_.wy * y;
    const auto level = [&](double height_m) {
      const double h = (reference - length / (radius_m_ + height_m)) * radius_m_ * radius_m_ / level_m_;
      require_brick(std::abs(h) < kMostBandLevel - 200, "a height is not finite, or farther than " +
                                                            std::to_string(kMostBandLevel - 200) +
                                                            " voxels from its middle");
      return h;
    };
    std::vector<SolidSpan> solids = solids_at(x, y);
    std::sort(solids.begin(), solids.end(),
              [](const SolidSpan& a, const SolidSpan& b) { return a.low_m < b.low_m; });
    std::vector<LevelSpan> spans;
    // Where the lowest part begins decides nothing.
    for (const SolidSpan& part : solids)
      spans.push_back({spans.empty() ? -kMostBandLevel : level(part.low_m), level(part.high_m)});
    join(spans);
    return spans;
  }

  mars::Face face_;
  HeightGridFrame frame_;
  double radius_m_;
  const SolidsAt& solids_;
  int samples_;
  DepthPlane plane_;
  double voxel_m_ = 1;
  double level_m_ = 1;
};

}  // namespace

GridVolume make_brick(mars::Face face, const HeightGridFrame& frame, double radius_m, const SolidsAt& solids,
                      const BrickSpec& spec, base::ThreadPool* pool) {
  require_brick(frame.intervals >= 1 && frame.intervals < kMostVolumeSide,
                "expected 1 to " + std::to_string(kMostVolumeSide - 1) + " intervals");
  require_brick(frame.du > 0 && frame.dv > 0, "expected cells of a width");
  require_brick(spec.samples >= 1 && spec.samples <= kMostBrickSamples,
                "expected 1 to " + std::to_string(kMostBrickSamples) + " samples");
  const int side = frame.intervals + 1;
  const BrickMaker maker(face, frame, radius_m, solids, spec.samples);
  constexpr int kRowsAtOnce = 16;
  std::vector<std::vector<BrickMaker::Column>> bands(
      static_cast<std::size_t>((side + kRowsAtOnce - 1) / kRowsAtOnce));
  std::atomic<std::size_t> densities{0};
  const auto make_band = [&](std::size_t n) {
    const int begin = static_cast<int>(n) * kRowsAtOnce;
    bands[n] = maker.rows(begin, std::min(side, begin + kRowsAtOnce));
    std::size_t count = 0;
    for (const BrickMaker::Column& column : bands[n]) count += column.densities.size();
    if ((densities += count) > kMostBrickDensities)
      throw std::runtime_error(
          "a part of the ground is too high above it for its voxels: between both there are more than " +
          std::to_string(kMostBrickDensities >> 20U) + " million; give it a larger voxel_m, or place it lower");
  };
  if (pool == nullptr || !pool->run(bands.size(), make_band)) {
    densities = 0;
    for (std::size_t n = 0; n < bands.size(); ++n) make_band(n);
  }
  BandColumns columns;
  for (std::vector<BrickMaker::Column>& band : bands) {
    for (const BrickMaker::Column& column : band) columns.add(column.first, column.densities);
    band = {};
  }
  return {face,
          frame,
          maker.plane(),
          maker.level_m(),
          maker.voxel_m(),
          BandVolume(side, side, spec.threshold, std::move(columns)),
          0,
          0};
}

}  // namespace vpe::voxel
