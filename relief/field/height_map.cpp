#include "relief/field/height_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace relief {

namespace {

constexpr double kGridSlack = 1e-9;  // cells: more than the rounding of places on the grid

MapLayout checked(const MapLayout& layout, const std::vector<float>& posts_m) {
  const auto is_side = [](int posts) { return posts >= 2 && posts <= kMaxMapSide; };
  const std::string size =
      "a height map of " + std::to_string(layout.columns) + "x" + std::to_string(layout.rows);
  if (!is_side(layout.columns) || !is_side(layout.rows))
    throw std::invalid_argument(size + " posts: each side must be 2 to " + std::to_string(kMaxMapSide));
  const std::size_t count = static_cast<std::size_t>(layout.columns) * static_cast<std::size_t>(layout.rows);
  if (posts_m.size() != count)
    throw std::invalid_argument(size + " posts was given " + std::to_string(posts_m.size()) + " heights");
  if (!std::all_of(posts_m.begin(), posts_m.end(), [](float h) { return std::isfinite(h); }))
    throw std::invalid_argument(size + " posts has a height that is not finite; fill gaps first");
  if (!(layout.dx_m > 0 && layout.dy_m > 0) || !std::isfinite(layout.dx_m + layout.dy_m) ||
      !std::isfinite(layout.x0_m + layout.y0_m))
    throw std::invalid_argument(size + " posts: its spacings must be positive, and its place finite");
  return layout;
}

}  // namespace

HeightMap::HeightMap(const MapLayout& layout, std::vector<float> posts_m, Interpolation interpolation)
    : layout_(checked(layout, posts_m)),
      interpolation_(interpolation),
      posts_m_(std::move(posts_m)),
      support_{layout.x0_m, layout.y0_m, layout.x0_m + (layout.columns - 1) * layout.dx_m,
               layout.y0_m + (layout.rows - 1) * layout.dy_m},
      pyramid_(make_pyramid()) {}

BoundsPyramid HeightMap::make_pyramid() {
  const int columns = layout_.columns - 1;
  const int rows = layout_.rows - 1;
  std::vector<Interval> cells;
  cells.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const Patch cell = patch(i, j);
      cells.push_back(cell.bounds_m());
      facet_deviation_m_ = std::max(facet_deviation_m_, cell.facet_deviation_m());
    }
  }
  return {columns, rows, cells};
}

double HeightMap::post_beyond(int i, int j) const {
  const auto inner = [](int n, int count) { return std::clamp(n, 0, count - 1); };
  const int ci = inner(i, layout_.columns);
  const int cj = inner(j, layout_.rows);
  if (ci == i && cj == j) return post(i, j);
  // One axis after the other: the line through the last two posts.
  if (ci != i) return 2 * post_beyond(ci, j) - post_beyond(2 * ci - i, j);
  return 2 * post_beyond(i, cj) - post_beyond(i, 2 * cj - j);
}

Patch HeightMap::patch(int i, int j) const {
  if (interpolation_ == Interpolation::kBilinear)
    return Patch::bilinear(post(i, j), post(i + 1, j), post(i, j + 1), post(i + 1, j + 1));
  std::array<double, 16> posts;
  const bool is_inner = i > 0 && j > 0 && i + 2 < layout_.columns && j + 2 < layout_.rows;
  for (int n = 0; n < 16; ++n) {
    const int column = i - 1 + n % 4;
    const int row = j - 1 + n / 4;
    posts[static_cast<std::size_t>(n)] = is_inner ? post(column, row) : post_beyond(column, row);
  }
  return Patch::bicubic(posts);
}

HeightMap::Place HeightMap::place(double x_m, double y_m) const {
  const double x = (x_m - layout_.x0_m) / layout_.dx_m;
  const double y = (y_m - layout_.y0_m) / layout_.dy_m;
  const int i = std::clamp(static_cast<int>(x), 0, layout_.columns - 2);
  const int j = std::clamp(static_cast<int>(y), 0, layout_.rows - 2);
  return {i, j, x - i, y - j};
}

double HeightMap::height_m(double x_m, double y_m) const {
  if (!overlap(support_, {x_m, y_m, x_m, y_m})) return 0;
  const Place at = place(x_m, y_m);
  return patch(at.i, at.j).height_m(at.u, at.v);
}

glm::dvec2 HeightMap::gradient(double x_m, double y_m) const {
  if (!overlap(support_, {x_m, y_m, x_m, y_m})) return {0, 0};
  const Place at = place(x_m, y_m);
  return patch(at.i, at.j).gradient(at.u, at.v) / glm::dvec2(layout_.dx_m, layout_.dy_m);
}

Interval HeightMap::coarse_bounds_m(const Rect& rect) const {
  if (!overlap(support_, rect)) return {0, 0};
  // Casts to int of what lies within the grid: infinite sides are cut before.
  const double x0 = (std::max(rect.x0_m, support_.x0_m) - layout_.x0_m) / layout_.dx_m - kGridSlack;
  const double x1 = (std::min(rect.x1_m, support_.x1_m) - layout_.x0_m) / layout_.dx_m + kGridSlack;
  const double y0 = (std::max(rect.y0_m, support_.y0_m) - layout_.y0_m) / layout_.dy_m - kGridSlack;
  const double y1 = (std::min(rect.y1_m, support_.y1_m) - layout_.y0_m) / layout_.dy_m + kGridSlack;
  const int columns = layout_.columns - 2;
  const int rows = layout_.rows - 2;
  const int i0 = std::clamp(static_cast<int>(x0), 0, columns);
  const int i1 = std::clamp(static_cast<int>(x1), 0, columns);
  const int j0 = std::clamp(static_cast<int>(y0), 0, rows);
  const int j1 = std::clamp(static_cast<int>(y1), 0, rows);
  const Interval found = pyramid_.over(i0, i1, j0, j1);
  const bool is_within = rect.x0_m >= support_.x0_m && rect.x1_m <= support_.x1_m &&
                         rect.y0_m >= support_.y0_m && rect.y1_m <= support_.y1_m;
  return is_within ? found : hull(found, {0, 0});
}

Interval HeightMap::bounds_m(const Rect& rect) const {
  const Interval coarse = coarse_bounds_m(rect);
  if (!overlap(support_, rect)) return coarse;
  const Place low = place(std::max(rect.x0_m, support_.x0_m), std::max(rect.y0_m, support_.y0_m));
  const Place high = place(std::min(rect.x1_m, support_.x1_m), std::min(rect.y1_m, support_.y1_m));
  if (high.i - low.i > 1 || high.j - low.j > 1) return coarse;
  bool is_first = true;
  Interval found;
  for (int j = low.j; j <= high.j; ++j) {
    for (int i = low.i; i <= high.i; ++i) {
      const Interval u{i == low.i ? low.u : 0, i == high.i ? high.u : 1};
      const Interval v{j == low.j ? low.v : 0, j == high.j ? high.v : 1};
      const Interval part = patch(i, j).bounds_m(widened(u, kGridSlack), widened(v, kGridSlack));
      found = is_first ? part : hull(found, part);
      is_first = false;
    }
  }
  const bool is_within = rect.x0_m >= support_.x0_m && rect.x1_m <= support_.x1_m &&
                         rect.y0_m >= support_.y0_m && rect.y1_m <= support_.y1_m;
  return is_within ? found : hull(found, {0, 0});
}

std::vector<float> tapered(std::span<const float> posts_m, int columns, int rows, int border_posts) {
  if (columns < 1 || rows < 1 || border_posts < 1 ||
      posts_m.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw std::invalid_argument(
        "tapering of a height map: the posts must fill the grid, and the border be positive");
  std::vector<float> result(posts_m.begin(), posts_m.end());
  const auto weight = [border_posts](int n, int count) {
    const double t = std::min(1.0, static_cast<double>(std::min(n, count - 1 - n)) / border_posts);
    return t * t * (3 - 2 * t);
  };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      float& post =
          result[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i)];
      post = static_cast<float>(static_cast<double>(post) * weight(i, columns) * weight(j, rows));
    }
  }
  return result;
}

}  // namespace relief
