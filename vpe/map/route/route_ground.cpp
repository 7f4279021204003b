#include "vpe/map/route/route_ground.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "vpe/base/parallel.h"

namespace vpe::map {

namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

// Lets rounding pass, so that ground exactly at the limit is within it.
constexpr double kGradeSlack = 1e-9;

void check_route_options(const RouteOptions& options) {
  const auto is_slope = [](double slope_deg) {
    return slope_deg >= RouteLimits::kLeastSlope_deg && slope_deg <= RouteLimits::kMostSlope_deg;
  };
  if (!is_slope(options.max_slope_deg))
    throw std::invalid_argument("find_route: the slope limit must be 0.01 to 89 degrees");
  if (options.max_cross_slope_deg && !is_slope(*options.max_cross_slope_deg))
    throw std::invalid_argument("find_route: the limit of slopes across the way must be 0.01 to 89 degrees");
  if (!(options.slope_weight >= 0 && options.slope_weight <= RouteLimits::kMostWeight))
    throw std::invalid_argument("find_route: the weight of slopes must be 0 to 1000");
}

void check_route_grid(const HeightGrid& grid) {
  const bool is_right =
      grid.columns >= 0 && grid.rows >= 0 &&
      grid.heights_m.size() == static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  if (!is_right) throw std::invalid_argument("find_route: the grid's sizes contradict each other");
  if (!(std::isfinite(grid.spacing_m) && grid.spacing_m > 0))
    throw std::invalid_argument("find_route: the grid's spacing must be above 0");
}

double grade_of_slope(double slope_deg) { return std::tan(slope_deg * kRadiansPerDegree); }

}  // namespace

// Holds a point where a straight way crosses lines of the grid.
struct RouteGround::Crossing {
  glm::dvec2 place{0};
  double height_m = 0;
};

RouteGround::RouteGround(const HeightGrid& grid, const RouteOptions& options, int threads) : grid_(grid) {
  check_route_options(options);
  check_route_grid(grid);
  limit_grade_ = grade_of_slope(options.max_slope_deg);
  most_grade_ = limit_grade_ * (1 + kGradeSlack);
  most_cross_grade_ = options.max_cross_slope_deg
                          ? grade_of_slope(*options.max_cross_slope_deg) * (1 + kGradeSlack)
                          : std::numeric_limits<double>::infinity();
  slope_weight_ = options.slope_weight;
  passable_.assign(grid.heights_m.size(), 0);
  base::parallel_for(static_cast<std::size_t>(grid.rows), threads, [&](std::size_t row) {
    for (glm::ivec2 post(0, static_cast<int>(row)); post.x < grid_.columns; ++post.x)
      if (std::isfinite(grid_.at(post.x, post.y)) && steepest_grade(post) <= most_grade_)
        passable_[index(post)] = 1;
  });
}

bool RouteGround::is_inside(glm::ivec2 post) const {
  return post.x >= 0 && post.y >= 0 && post.x < grid_.columns && post.y < grid_.rows;
}

std::size_t RouteGround::index(glm::ivec2 post) const {
  return static_cast<std::size_t>(post.y) * static_cast<std::size_t>(grid_.columns) +
         static_cast<std::size_t>(post.x);
}

double RouteGround::steepest_grade(glm::ivec2 post) const {
  const double here_m = grid_.at(post.x, post.y);
  const auto rise_m = [&](int dx, int dy) {
    const glm::ivec2 there = post + glm::ivec2(dx, dy);
    const double rise = is_inside(there) ? std::abs(grid_.at(there.x, there.y) - here_m) : 0;
    return std::isfinite(rise) ? rise : 0;
  };
  return std::hypot(std::max(rise_m(-1, 0), rise_m(1, 0)), std::max(rise_m(0, -1), rise_m(0, 1))) /
         grid_.spacing_m;
}

bool RouteGround::is_cell_passable(int column, int row) const {
  return is_passable({column, row}) && is_passable({column + 1, row}) && is_passable({column, row + 1}) &&
         is_passable({column + 1, row + 1});
}

// Returns the grade of the ground across a piece inside a cell, or along an edge the steepest on either side.
double RouteGround::cross_grade(const Crossing& begin, const Crossing& end) const {
  const glm::dvec2 step = end.place - begin.place;
  const glm::dvec2 middle = (begin.place + end.place) * 0.5;
  const int column = static_cast<int>(middle.x);
  const int row = static_cast<int>(middle.y);
  const auto rise_m = [&](int c, int r, int dx, int dy) {
    if (!is_inside({c + dx, r + dy})) return 0.0;
    const double rise = double{grid_.at(c + dx, r + dy)} - double{grid_.at(c, r)};
    return std::isfinite(rise) ? rise : 0.0;
  };
  if (step.y == 0 || step.x == 0) {
    const int along_x = step.y == 0 ? 1 : 0;
    const int along_y = 1 - along_x;
    double most_m = 0;
    for (const int n : {0, 1})
      for (const int side : {-1, 1})
        most_m = std::max(
            most_m, std::abs(rise_m(column + n * along_x, row + n * along_y, side * along_y, side * along_x)));
    return most_m / grid_.spacing_m;
  }
  const glm::dvec2 share = middle - glm::dvec2(column, row);
  const double x_m = (1 - share.y) * rise_m(column, row, 1, 0) + share.y * rise_m(column, row + 1, 1, 0);
  const double y_m = (1 - share.x) * rise_m(column, row, 0, 1) + share.x * rise_m(column + 1, row, 0, 1);
  return std::abs(y_m * step.x - x_m * step.y) / (std::hypot(step.x, step.y) * grid_.spacing_m);
}

bool RouteGround::add_piece(const Crossing& begin, const Crossing& end, RouteFigures& figures,
                            double& steepest_grade) const {
  const glm::dvec2 step = end.place - begin.place;
  const double run_m = std::sqrt(step.x * step.x + step.y * step.y) * grid_.spacing_m;
  const double rise_m = end.height_m - begin.height_m;
  const double grade = std::abs(rise_m) / run_m;
  if (grade > most_grade_) return false;
  if (most_cross_grade_ < most_grade_ && cross_grade(begin, end) > most_cross_grade_) return false;
  const double length_m = std::sqrt(run_m * run_m + rise_m * rise_m);
  const double share = grade / limit_grade_;
  figures.cost_m += length_m * (1 + slope_weight_ * share * share);
  figures.length_m += length_m;
  figures.map_length_m += run_m;
  (rise_m > 0 ? figures.climb_m : figures.descent_m) += std::abs(rise_m);
  steepest_grade = std::max(steepest_grade, grade);
  return true;
}

std::optional<RouteFigures> RouteGround::straight(glm::ivec2 from, glm::ivec2 to) const {
  RouteFigures figures;
  double steepest_grade = 0;
  if (!is_passable(from) || !is_passable(to)) return std::nullopt;
  const glm::ivec2 whole = to - from;
  const std::int64_t columns = std::abs(whole.x);
  const std::int64_t rows = std::abs(whole.y);
  const int right = whole.x < 0 ? -1 : 1;
  const int down = whole.y < 0 ? -1 : 1;
  Crossing before{glm::dvec2(from), grid_.at(from.x, from.y)};
  // Along the way the n-th line of columns comes at n / columns, the m-th one of rows at m / rows.
  std::int64_t n = 0;
  std::int64_t m = 0;
  while (n < columns || m < rows) {
    const bool is_on_edge = columns == 0 || rows == 0;
    const int cell_column = from.x + right * static_cast<int>(n) - (right < 0 ? 1 : 0);
    const int cell_row = from.y + down * static_cast<int>(m) - (down < 0 ? 1 : 0);
    if (!is_on_edge && !is_cell_passable(cell_column, cell_row)) return std::nullopt;
    const std::int64_t column_first = is_on_edge ? (columns == 0 ? 1 : -1) : (n + 1) * rows - (m + 1) * columns;
    if (column_first <= 0) ++n;
    if (column_first >= 0) ++m;
    Crossing next;
    if (column_first == 0 || is_on_edge) {
      const glm::ivec2 post = from + glm::ivec2(right * static_cast<int>(n), down * static_cast<int>(m));
      if (!is_passable(post)) return std::nullopt;
      next = {glm::dvec2(post), grid_.at(post.x, post.y)};
    } else if (column_first < 0) {
      const int column = from.x + right * static_cast<int>(n);
      const double beyond = static_cast<double>(n * rows - m * columns) / static_cast<double>(columns);
      const int row = from.y + down * static_cast<int>(m);
      const double begin_m = grid_.at(column, row);
      next = {{column, row + down * beyond}, begin_m + (grid_.at(column, row + down) - begin_m) * beyond};
    } else {
      const int row = from.y + down * static_cast<int>(m);
      const double beyond = static_cast<double>(m * columns - n * rows) / static_cast<double>(rows);
      const int column = from.x + right * static_cast<int>(n);
      const double begin_m = grid_.at(column, row);
      next = {{column + right * beyond, row}, begin_m + (grid_.at(column + right, row) - begin_m) * beyond};
    }
    if (!add_piece(before, next, figures, steepest_grade)) return std::nullopt;
    before = next;
  }
  figures.steepest_deg = std::atan(steepest_grade) / kRadiansPerDegree;
  return figures;
}

double RouteGround::least_cost_m(glm::ivec2 from, glm::ivec2 to) const {
  // The shortest chain of steps on the map, then at least as long as the rise needs within the limit.
  const double x = std::abs(to.x - from.x);
  const double y = std::abs(to.y - from.y);
  const double more = std::max(x, y);
  const double less = std::min(x, y);
  const double by_steps = 2 * less <= more
                              ? (more - 2 * less) + less * std::sqrt(5.0)
                              : (2 * less - more) * std::sqrt(2.0) + (more - less) * std::sqrt(5.0);
  const double rise_m = std::abs(double{grid_.at(to.x, to.y)} - double{grid_.at(from.x, from.y)});
  const double run_m = std::max(by_steps * grid_.spacing_m, rise_m / most_grade_);
  return std::sqrt(run_m * run_m + rise_m * rise_m);
}

}  // namespace vpe::map
