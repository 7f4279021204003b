#include "vpe/voxel/pixel_caster.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <optional>

namespace vpe::voxel {

namespace {

// A single ray takes as long as this many pixels of a strip.
constexpr double kRayInPixels = 12;

// A strip ends where a smaller share of the pixels across it is wanted.
constexpr double kLeastShare = 0.25;

// A ray begins at this share of the range that is known to be clear.
constexpr double kBegin = 1 - kAroundRange;

// Counts, by row and by column, the wanted pixels about whose rays nothing is known.
struct Counts {
  std::vector<int> rows;
  std::vector<int> columns;
};

Counts count_unknown(const glm::ivec2& size, const core::WantedPixels& wanted) {
  Counts counts{std::vector<int>(static_cast<std::size_t>(size.y)),
                std::vector<int>(static_cast<std::size_t>(size.x))};
  std::size_t n = 0;
  for (std::size_t y = 0; y < counts.rows.size(); ++y) {
    for (std::size_t x = 0; x < counts.columns.size(); ++x, ++n) {
      if (wanted.is_wanted[n] == 0 || wanted.clear_m[n] > 0) continue;
      ++counts.rows[y];
      ++counts.columns[x];
    }
  }
  return counts;
}

// Returns how many entries from the beginning (step 1) or the end (-1) reach a count.
int strip_width(const std::vector<int>& counts, int step, double least) {
  int width = 0;
  const int n = static_cast<int>(counts.size());
  while (width < n && counts[static_cast<std::size_t>(step > 0 ? width : n - 1 - width)] >= least) ++width;
  return width;
}

// Returns true if a pixel has to be cast: it is wanted, and is not known to show sky.
bool is_cast(const core::WantedPixels& wanted, std::size_t n) {
  return wanted.is_wanted[n] != 0 && wanted.clear_m[n] != core::kSkyRange;
}

}  // namespace

PixelPlan plan_pixels(const core::View& view, const core::WantedPixels& wanted) {
  const core::SubRectangle part = core::drawn_part(view);
  const glm::ivec2 size(part.width, part.height);
  Counts counts = count_unknown(size, wanted);
  PixelPlan plan;
  if (view.projection != core::Projection::kPerspective) counts = {};
  const int top = strip_width(counts.rows, 1, kLeastShare * size.x);
  const int bottom = std::min(strip_width(counts.rows, -1, kLeastShare * size.x), size.y - top);
  const int left = strip_width(counts.columns, 1, kLeastShare * size.y);
  const int right = std::min(strip_width(counts.columns, -1, kLeastShare * size.y), size.x - left);
  const int height = size.y - top - bottom;
  const auto add = [&](int x, int y, int width, int rows) {
    if (width > 0 && rows > 0) plan.strips.push_back({part.x + x, part.y + y, width, rows});
  };
  add(0, 0, size.x, top);
  add(0, size.y - bottom, size.x, bottom);
  add(0, top, left, height);
  add(size.x - right, top, right, height);
  std::vector<int> rays(static_cast<std::size_t>(size.x));
  for (int y = top; y < size.y - bottom; ++y)
    for (int x = left; x < size.x - right; ++x)
      if (is_cast(wanted,
                  static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x)))
        ++rays[static_cast<std::size_t>(x)];
  plan.rays = std::accumulate(rays.begin(), rays.end(), std::int64_t{0});
  const double pixels = static_cast<double>(size.x) * size.y;
  if (kRayInPixels * static_cast<double>(plan.rays) > pixels) return {{part}, {}, 0};
  for (int x = 0; x < size.x; ++x)
    if (rays[static_cast<std::size_t>(x)] > 0) plan.columns.push_back(x);
  std::ranges::stable_sort(plan.columns, [&](int a, int b) {
    return rays[static_cast<std::size_t>(a)] > rays[static_cast<std::size_t>(b)];
  });
  return plan;
}

ColumnWalk::Usage PixelCaster::cast_strip(const core::View& view, RangeOptions options,
                                          const core::SubRectangle& strip, const core::WantedPixels& wanted,
                                          base::ThreadPool& pool, std::span<float> range_m,
                                          TileFallbacks* fallbacks) {
  const core::SubRectangle part = core::drawn_part(view);
  options.only = strip;
  buffer_m_.resize(range_m.size());
  ColumnWalk::Usage usage = caster_.cast(view, options, pool, buffer_m_, sectors_, fallbacks);
  for (int y = strip.y - part.y; y < strip.y - part.y + strip.height; ++y) {
    for (int x = strip.x - part.x; x < strip.x - part.x + strip.width; ++x) {
      const std::size_t n =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(part.width) + static_cast<std::size_t>(x);
      if (is_cast(wanted, n)) range_m[n] = buffer_m_[n];
    }
  }
  return usage;
}

ColumnWalk::Usage PixelCaster::cast(const core::View& view, const RangeOptions& options,
                                    const core::WantedPixels& wanted, base::ThreadPool& pool,
                                    std::span<float> range_m, TileFallbacks* fallbacks) {
  for (std::size_t n = 0; n < range_m.size(); ++n)
    if (wanted.is_wanted[n] != 0 && wanted.clear_m[n] == core::kSkyRange) range_m[n] = core::kSkyRange;
  const bool has_single_rays = options.method != RangeOptions::Method::kVolume;
  const PixelPlan plan =
      has_single_rays ? plan_pixels(view, wanted) : PixelPlan{{core::drawn_part(view)}, {}, 0};
  const lod::TileTree& tree = caster_.surface().planet().tree();
  ColumnWalk::Usage usage;
  for (const core::SubRectangle& strip : plan.strips)
    usage.add(cast_strip(view, options, strip, wanted, pool, range_m, fallbacks), tree);
  if (plan.columns.empty()) return usage;
  const core::SubRectangle part = core::drawn_part(view);
  const SingleRays rays(caster_.surface(), options.exaggeration, fallbacks);
  const glm::dvec3& camera_m = view.camera.position_m;
  std::atomic<bool> lacks_tile{false};
  const auto in_strip = [&](int x, int y) {
    return std::ranges::any_of(plan.strips, [&](const core::SubRectangle& s) {
      return part.x + x >= s.x && part.x + x < s.x + s.width && part.y + y >= s.y &&
             part.y + y < s.y + s.height;
    });
  };
  pool.run(plan.columns.size(), [&](std::size_t task) {
    const int x = plan.columns[task];
    for (int y = part.height - 1; y >= 0; --y) {
      const std::size_t n =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(part.width) + static_cast<std::size_t>(x);
      if (!is_cast(wanted, n) || in_strip(x, y)) continue;
      const glm::dvec3 ray = core::pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5);
      const std::optional<double> range =
          rays.cast_from(camera_m, ray, kBegin * static_cast<double>(wanted.clear_m[n]));
      if (range)
        range_m[n] = static_cast<float>(*range);
      else
        lacks_tile = true;
    }
  });
  usage.steepest_slope = std::max(usage.steepest_slope, tree.steepest_slope(options.exaggeration));
  // Columns find coarser tiles by themselves.
  if (lacks_tile) usage.add(cast_strip(view, options, part, wanted, pool, range_m, fallbacks), tree);
  return usage;
}

}  // namespace vpe::voxel
