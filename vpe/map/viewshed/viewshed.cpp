#include "vpe/map/viewshed/viewshed.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>

#include "vpe/map/viewshed/octant.h"
#include "vpe/map/viewshed/rise.h"

namespace vpe::map {

namespace {

constexpr double kMostViewshedHeight_m = 1e9;
constexpr int kMostPostsAcross = 1 << 20;
constexpr std::size_t kMostPosts = std::size_t{1} << 30;
constexpr int kRowsPerBlock = 32;

// An odd number of cache lines: the posts of a column are then in all sets of a cache.
std::size_t rise_pitch(int columns) {
  constexpr std::size_t kFloatsOfLine = 16;
  return ((static_cast<std::size_t>(columns) + kFloatsOfLine - 1) / kFloatsOfLine | 1U) * kFloatsOfLine;
}

void check_grid(const HeightGrid& ground, const ViewshedOptions& options) {
  const auto fail = [](const std::string& what) {
    throw std::invalid_argument("cannot compute a viewshed: " + what);
  };
  if (ground.columns < 1 || ground.rows < 1 || ground.columns > kMostPostsAcross ||
      ground.rows > kMostPostsAcross)
    fail("a grid of " + std::to_string(ground.columns) + " x " + std::to_string(ground.rows) +
         " posts; expected 1 to " + std::to_string(kMostPostsAcross) + " in both directions");
  if (rise_pitch(ground.columns) * static_cast<std::size_t>(ground.rows) > kMostPosts)
    fail("the grid has more than 1e9 posts");
  if (ground.heights_m.size() !=
      static_cast<std::size_t>(ground.columns) * static_cast<std::size_t>(ground.rows))
    fail("the grid has " + std::to_string(ground.heights_m.size()) + " heights; expected one for each post");
  if (!(ground.spacing_m > 0) || !std::isfinite(ground.spacing_m)) fail("the spacing of posts must be above 0");
  if (options.column < 0 || options.column >= ground.columns || options.row < 0 || options.row >= ground.rows)
    fail("the observer is outside the grid");
  for (const double height_m : {options.observer_height_m, options.target_height_m})
    if (!(std::abs(height_m) <= kMostViewshedHeight_m)) fail("heights over the ground must be at most 1e9 m");
  if (!(options.radius_m > 0)) fail("the radius of the planet must be above 0");
  if (!(options.reach_m >= 0)) fail("the distance must be at least 0");
}

// Holds what all octants read, and fills it.
class ViewshedWork {
 public:
  ViewshedWork(const HeightGrid& ground, const ViewshedOptions& options, base::ThreadPool& pool)
      : ground_(ground), options_(options), pool_(pool), pitch_(rise_pitch(ground.columns)) {
    view_.radius_m = options.radius_m;
    view_.spacing_m = ground.spacing_m;
    const double quarter_m = options.radius_m * std::numbers::pi / 2;
    const double reach = std::min(options.reach_m, quarter_m) / ground.spacing_m;
    view_.reach_squared = reach * reach;
    rings_ = static_cast<int>(std::min(reach, double{kMostPostsAcross}));
    view_.observer_m = double{ground.at(options.column, options.row)} + options.observer_height_m;
  }

  // Returns whether the observer's ground is known.
  bool has_ground() const {
    const double height_m = double{ground_.at(options_.column, options_.row)};
    return std::abs(height_m) <= kMostViewshedHeight_m &&
           (std::isinf(options_.radius_m) || std::min(height_m, view_.observer_m) > -options_.radius_m);
  }

  void fill_rises(double target_height_m) {
    fill(0, rises_);
    if (target_height_m != 0) fill(static_cast<float>(target_height_m), targets_);
  }

  void sweep_all(const OctantResults& at_observer) {
    struct Task {
      Octant octant;
      FanRays rays;
    };
    std::vector<Task> tasks;
    for (const Octant& octant : octants())
      for (const FanRays& rays : divide(octant)) tasks.push_back({octant, rays});
    pool_.run(tasks.size(), [&](std::size_t n) { sweep(tasks[n].octant, tasks[n].rays, at_observer); });
  }

  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(ground_.columns) +
           static_cast<std::size_t>(column);
  }

  void by_blocks(const std::function<void(int)>& row) const {
    const auto blocks = static_cast<std::size_t>((ground_.rows + kRowsPerBlock - 1) / kRowsPerBlock);
    pool_.run(blocks, [&](std::size_t block) {
      const int first = static_cast<int>(block) * kRowsPerBlock;
      for (int n = first; n < std::min(ground_.rows, first + kRowsPerBlock); ++n) row(n);
    });
  }

  const RiseView& view() const { return view_; }
  std::span<const float> heights_of(int row) const {
    return std::span(ground_.heights_m).subspan(index(0, row), static_cast<std::size_t>(ground_.columns));
  }

 private:
  void fill(float added_m, RiseGrid& grid) {
    grid = std::make_unique_for_overwrite<float[]>(pitch_ * static_cast<std::size_t>(ground_.rows));
    const auto columns = static_cast<std::size_t>(ground_.columns);
    by_blocks([&](int row) {
      rises(view_, heights_of(row), added_m, row - options_.row, -options_.column,
            {grid.get() + pitch_ * static_cast<std::size_t>(row), columns});
    });
  }

  std::array<Octant, 8> octants() const {
    const std::ptrdiff_t columns = ground_.columns;
    const auto pitch = static_cast<std::ptrdiff_t>(pitch_);
    struct Axis {
      std::ptrdiff_t step;
      std::ptrdiff_t out_step;
      int posts;
    };
    const Axis axes[] = {{pitch, columns, ground_.rows - 1 - options_.row},
                         {-pitch, -columns, options_.row},
                         {1, 1, ground_.columns - 1 - options_.column},
                         {-1, -1, options_.column}};
    const auto observer = options_.row * pitch + options_.column;
    std::array<Octant, 8> all;
    std::size_t n = 0;
    for (int along = 0; along < 4; ++along) {
      const bool by_rows = along < 2;
      for (const int across : {by_rows ? 2 : 0, by_rows ? 3 : 1}) {
        Octant& octant = all[n++];
        octant.rises_m = rises_.get() + observer;
        octant.targets_m = (targets_ ? targets_.get() : rises_.get()) + observer;
        octant.ring_step = axes[along].step;
        octant.post_step = axes[across].step;
        octant.out_ring_step = axes[along].out_step;
        octant.out_post_step = axes[across].out_step;
        octant.rings = std::min(axes[along].posts, rings_);
        octant.last_post = axes[across].posts;
        octant.has_axis = across % 2 == 0;
        octant.has_diagonal = by_rows;
      }
    }
    return all;
  }

  const HeightGrid& ground_;
  const ViewshedOptions& options_;
  base::ThreadPool& pool_;
  RiseView view_;
  int rings_ = 0;
  std::size_t pitch_;  // from row to row of rises
  RiseGrid rises_;
  RiseGrid targets_;
};

}  // namespace

Viewshed viewshed(const HeightGrid& ground, const ViewshedOptions& options, base::ThreadPool& pool) {
  check_grid(ground, options);
  Viewshed result{ground.columns, ground.rows, std::vector<Sight>(ground.heights_m.size(), Sight::unknown)};
  ViewshedWork work(ground, options, pool);
  if (!work.has_ground()) return result;
  work.fill_rises(options.target_height_m);
  Sight& observer = result.sights[work.index(options.column, options.row)];
  observer = Sight::seen;
  work.sweep_all({&observer, nullptr});
  return result;
}

HeightGrid needed_heights(const HeightGrid& ground, const ViewshedOptions& options, base::ThreadPool& pool) {
  check_grid(ground, options);
  HeightGrid result{ground.columns, ground.rows, ground.spacing_m,
                    std::vector<float>(ground.heights_m.size(), std::numeric_limits<float>::quiet_NaN())};
  ViewshedWork work(ground, options, pool);
  if (!work.has_ground()) return result;
  work.fill_rises(0);
  float& observer = result.heights_m[work.index(options.column, options.row)];
  observer = kNoRise;
  work.sweep_all({nullptr, &observer});
  const auto columns = static_cast<std::size_t>(ground.columns);
  work.by_blocks([&](int row) {
    heights_to_rise(work.view(), work.heights_of(row), row - options.row, -options.column,
                    {result.heights_m.data() + work.index(0, row), columns});
  });
  return result;
}

}  // namespace vpe::map
