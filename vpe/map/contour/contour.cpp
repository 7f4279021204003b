#include "vpe/map/contour/contour.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "vpe/base/number.h"
#include "vpe/base/parallel.h"
#include "vpe/map/contour/edges.h"
#include "vpe/map/contour/simplify.h"

namespace vpe::map {

namespace {

constexpr int kStripCells = 1 << 17;

// Levels must differ by more than this share of the largest height, or rounding would mix them up.
constexpr double kLeastIntervalShare = 1e-12;

void check_grid_sizes(const HeightGrid& grid) {
  const bool is_right =
      grid.columns >= 0 && grid.rows >= 0 &&
      grid.heights_m.size() == static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  if (!is_right) throw std::invalid_argument("contours: the grid's sizes contradict each other");
  if (!(std::isfinite(grid.spacing_m) && grid.spacing_m > 0))
    throw std::invalid_argument("contours: the grid's spacing must be above 0");
}

void check_contour_options(const ContourOptions& options) {
  if (!(std::isfinite(options.interval_m) && options.interval_m > 0))
    throw std::invalid_argument("contours: the interval must be above 0");
  if (!std::isfinite(options.base_m)) throw std::invalid_argument("contours: the base must be finite");
  if (!(std::isfinite(options.tolerance_m) && options.tolerance_m >= 0))
    throw std::invalid_argument("contours: the tolerance must be 0 or above");
}

// Throws for intervals that are too small for the heights of the grid.
void check_levels(const HeightGrid& grid, const ContourOptions& options) {
  double lowest_m = std::numeric_limits<double>::infinity();
  double highest_m = -lowest_m;
  for (const float height_m : grid.heights_m) {
    if (!std::isfinite(height_m)) continue;
    lowest_m = std::min(lowest_m, double{height_m});
    highest_m = std::max(highest_m, double{height_m});
  }
  if (!(lowest_m <= highest_m)) return;
  const double largest_m = std::max({std::abs(lowest_m), std::abs(highest_m), std::abs(options.base_m)});
  const bool is_apart = options.interval_m > kLeastIntervalShare * largest_m;
  if (!is_apart || (highest_m - lowest_m) / options.interval_m > kMostContourLevels)
    throw std::invalid_argument("contours: an interval of " + base::format_number(options.interval_m) +
                                " m is too small for heights from " + base::format_number(lowest_m) + " to " +
                                base::format_number(highest_m) + " m; take a larger one");
}

glm::dvec2 place_on_edge(const HeightGrid& grid, std::uint64_t edge, double level_m) {
  const auto columns = static_cast<std::uint64_t>(grid.columns);
  const int row = static_cast<int>(edge / 2 / columns);
  const int column = static_cast<int>(edge / 2 % columns);
  const bool is_down = edge % 2 != 0;
  const double begin_m = grid.at(column, row);
  const double end_m = is_down ? grid.at(column, row + 1) : grid.at(column + 1, row);
  const double share = (level_m - begin_m) / (end_m - begin_m);
  return {column + (is_down ? 0 : share), row + (is_down ? share : 0)};
}

// Returns the line of a chain; it has less than two points where all of them are at one post.
ContourLine line_of_chain(const HeightGrid& grid, const LevelScale& scale, const EdgeChain& chain) {
  ContourLine line{chain.multiple, scale.level_m(chain.multiple), chain.is_closed, {}};
  line.points.reserve(chain.edges.size());
  for (const std::uint64_t edge : chain.edges) {
    const glm::dvec2 place = place_on_edge(grid, edge, line.level_m);
    if (line.points.empty() || line.points.back() != place) line.points.push_back(place);
  }
  if (line.is_closed)
    while (line.points.size() > 1 && line.points.back() == line.points.front()) line.points.pop_back();
  return line;
}

}  // namespace

std::vector<ContourLine> contours(const HeightGrid& grid, const ContourOptions& options, int threads) {
  check_grid_sizes(grid);
  check_contour_options(options);
  if (grid.columns < 2 || grid.rows < 2) return {};
  check_levels(grid, options);
  const LevelScale scale{options.base_m, options.interval_m};

  const int strip_rows = std::max(1, kStripCells / grid.columns);
  const auto strips = static_cast<std::size_t>((grid.rows - 2) / strip_rows + 1);
  std::vector<std::vector<EdgeChain>> of_strips(strips);
  std::atomic<std::size_t> points{0};
  base::parallel_for(strips, threads, [&](std::size_t n) {
    if (points > options.most_points) return;
    const int begin = static_cast<int>(n) * strip_rows;
    of_strips[n] = chains_of_rows(grid, scale, begin, std::min(begin + strip_rows, grid.rows - 1));
    for (const EdgeChain& chain : of_strips[n]) points += chain.edges.size() - (chain.is_closed ? 0 : 1);
  });
  if (points > options.most_points)
    throw std::length_error("contours: the lines have more than " + std::to_string(options.most_points) +
                            " points; take a larger interval or fewer posts");

  std::vector<EdgeChain> chains;
  for (std::vector<EdgeChain>& of_strip : of_strips) {
    chains.insert(chains.end(), std::make_move_iterator(of_strip.begin()),
                  std::make_move_iterator(of_strip.end()));
    of_strip = {};
  }
  chains = join_chains(std::move(chains));
  std::vector<ContourLine> lines(chains.size());
  base::parallel_for(chains.size(), threads, [&](std::size_t n) {
    lines[n] = line_of_chain(grid, scale, chains[n]);
    chains[n] = {};
  });
  std::erase_if(lines, [](const ContourLine& line) { return line.points.size() < 2; });
  if (options.tolerance_m > 0) simplify_contours(lines, options.tolerance_m / grid.spacing_m, threads);
  return lines;
}

double length_posts(const ContourLine& line) {
  double length = 0;
  for (std::size_t n = 0; n < line.points.size(); ++n) {
    if (n + 1 == line.points.size() && !line.is_closed) break;
    const glm::dvec2 step = line.points[(n + 1) % line.points.size()] - line.points[n];
    length += std::hypot(step.x, step.y);
  }
  return length;
}

}  // namespace vpe::map
