#include "vpe/warp/image_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vpe::warp {

namespace {

// The ring is as wide as this share of the image's longer side: more than a fast turn moves the image between frames.
constexpr double kRing = 0.25;
constexpr double kLeastForward = 1e-3;

glm::dvec2 centre_px(const core::View& view) {
  const core::SubRectangle part = core::drawn_part(view);
  return {0.5 * view.width + view.principal_offset_px.x - part.x,
          0.5 * view.height + view.principal_offset_px.y - part.y};
}

// Returns the places along a side of `length` pixels: those of the cells, and one beyond each end.
std::vector<double> places_along(int length, int cells, double ring_px) {
  std::vector<double> places{-ring_px};
  for (int n = 0; n <= cells; ++n) places.push_back(static_cast<double>(length) * n / cells);
  places.push_back(length + ring_px);
  return places;
}

std::array<double, 6> basis(const glm::dvec2& p) { return {1, p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y}; }

// Solves the nine equations for six factors in the sense of least squares. The points are those of a square, so the inverse
// is known: {-1, 0, 1} has the sums 3, 0, 2 of its powers.
std::array<double, 6> fit_square(const std::array<double, 9>& value) {
  std::array<double, 6> sums{};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      const std::array<double, 6> b = basis({column - 1, row - 1});
      for (std::size_t k = 0; k < 6; ++k) sums[k] += b[k] * value[static_cast<std::size_t>(3 * row + column)];
    }
  // Sums over the nine points: of 1: 9, of x^2 and y^2: 6 each, of x^4: 6, of x^2 y^2: 4, of odd powers: 0.
  const double squares = 0.5 * (sums[3] - 2.0 / 3.0 * sums[0]);
  const double other = 0.5 * (sums[5] - 2.0 / 3.0 * sums[0]);
  return {sums[0] / 9 - 2.0 / 3.0 * (squares + other), sums[1] / 6, sums[2] / 6, squares, sums[4] / 4, other};
}

glm::ivec2 corner_pixel(glm::ivec2 size, glm::ivec2 cells, glm::ivec2 corner) {
  return glm::min(size * corner / cells, size - 1);
}

float at(std::span<const float> range_m, int width, glm::ivec2 p) {
  return range_m[static_cast<std::size_t>(p.y) * static_cast<std::size_t>(width) +
                 static_cast<std::size_t>(p.x)];
}

// Returns the view.
const core::View& check(const core::View& view, std::span<const float> range_m, glm::ivec2 cells,
                        glm::ivec2 size) {
  if (view.projection != core::Projection::kPerspective)
    throw std::invalid_argument("the grid of an image needs a perspective view");
  if (cells.x < 1 || cells.y < 1) throw std::invalid_argument("the grid of an image needs cells");
  if (range_m.size() != static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y))
    throw std::invalid_argument("the grid of an image needs its ranges");
  return view;
}

}  // namespace

template <typename RangeAt>
ImageGrid::ImageGrid(const core::View& view, glm::ivec2 cells, const RangeAt& range_at)
    : view_(view), cells_(cells + 2) {
  const core::SubRectangle part = core::drawn_part(view);
  const double ring_px = kRing * std::max(part.width, part.height);
  const std::vector<double> xs = places_along(part.width, cells.x, ring_px);
  const std::vector<double> ys = places_along(part.height, cells.y, ring_px);
  for (int j = 0; j < static_cast<int>(ys.size()); ++j) {
    for (int i = 0; i < static_cast<int>(xs.size()); ++i) {
      // The ring has the ranges of the image's border.
      const glm::ivec2 corner = glm::clamp(glm::ivec2(i, j) - 1, glm::ivec2(0), cells);
      const glm::ivec2 pixel = corner_pixel({part.width, part.height}, cells, corner);
      const float range = range_at(corner);
      const glm::dvec3 ray = core::pixel_ray(view, part.x + pixel.x + 0.5, part.y + pixel.y + 0.5);
      const double cosine = glm::dot(ray, view.camera.axes.forward);
      places_.emplace_back(xs[static_cast<std::size_t>(i)], ys[static_cast<std::size_t>(j)]);
      depth_m_.push_back(range > 0 ? static_cast<float>(static_cast<double>(range) * cosine)
                                   : std::numeric_limits<float>::infinity());
    }
  }
}

ImageGrid::ImageGrid(const core::View& view, std::span<const float> range_m, glm::ivec2 cells)
    : ImageGrid(check(view, range_m, cells, core::drawn_size(view)), cells, [&](glm::ivec2 corner) {
        const glm::ivec2 size = core::drawn_size(view);
        return at(range_m, size.x, corner_pixel(size, cells, corner));
      }) {}

ImageGrid ImageGrid::of_corners(const core::View& view, std::span<const float> range_m, glm::ivec2 cells) {
  return {check(view, range_m, cells, cells + 1), cells,
          [&](glm::ivec2 corner) { return at(range_m, cells.x + 1, corner); }};
}

glm::vec2 ImageGrid::texture_at(std::size_t vertex) const {
  const core::SubRectangle part = core::drawn_part(view_);
  const glm::vec2 place = places_[vertex] / glm::vec2(part.width, part.height);
  return glm::clamp(place, glm::vec2(0), glm::vec2(1));
}

void ImageGrid::move(const core::View& to, std::vector<MovedVertex>& out) const {
  const mars::Axes& a = view_.camera.axes;
  const mars::Axes& b = to.camera.axes;
  const glm::dvec2 from_centre = centre_px(view_);
  const glm::dvec2 to_centre = centre_px(to);
  const double from_focal = core::focal_px(view_);
  const double to_focal = core::focal_px(to);
  const glm::dvec3 shift_m = to.camera.position_m - view_.camera.position_m;
  out.resize(places_.size());
  for (std::size_t n = 0; n < places_.size(); ++n) {
    // A point at depth 1 along its ray, and the camera's shift seen from there.
    const glm::dvec3 ray = a.forward + (places_[n].x - from_centre.x) / from_focal * a.right -
                           (places_[n].y - from_centre.y) / from_focal * a.up;
    const double nearness = 1 / static_cast<double>(depth_m_[n]);
    const glm::dvec3 point = ray - nearness * shift_m;
    const double ahead = glm::dot(point, b.forward);
    MovedVertex& vertex = out[n];
    vertex.is_ahead = ahead > kLeastForward * glm::length(ray);
    if (!vertex.is_ahead) continue;
    vertex.xy_px = {to_centre.x + to_focal * glm::dot(point, b.right) / ahead,
                    to_centre.y - to_focal * glm::dot(point, b.up) / ahead};
    vertex.inverse_depth = static_cast<float>(nearness / ahead);
  }
}

glm::dvec2 QuadraticMotion::at(const glm::dvec2& place_px) const {
  const std::array<double, 6> b = basis((place_px - middle_px) / half_px);
  glm::dvec2 moved(0);
  for (std::size_t k = 0; k < 6; ++k) moved += b[k] * glm::dvec2(x[k], y[k]);
  return moved;
}

std::optional<QuadraticMotion> fit_motion(const ImageGrid& grid, std::span<const MovedVertex> moved) {
  const glm::ivec2 cells = grid.cells() - 2;
  const core::SubRectangle part = core::drawn_part(grid.view());
  if (cells.x % 2 != 0 || cells.y % 2 != 0 || moved.size() != grid.places().size())
    throw std::invalid_argument("fit_motion: needs all vertices of a grid with an even number of cells a side");
  std::array<double, 9> xs{};
  std::array<double, 9> ys{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const MovedVertex& v =
          moved[static_cast<std::size_t>(grid.index(1 + column * cells.x / 2, 1 + row * cells.y / 2))];
      if (!v.is_ahead) return std::nullopt;
      xs[static_cast<std::size_t>(3 * row + column)] = static_cast<double>(v.xy_px.x);
      ys[static_cast<std::size_t>(3 * row + column)] = static_cast<double>(v.xy_px.y);
    }
  }
  QuadraticMotion motion;
  motion.x = fit_square(xs);
  motion.y = fit_square(ys);
  motion.half_px = 0.5 * glm::dvec2(part.width, part.height);
  motion.middle_px = motion.half_px;
  for (int row = 1; row <= cells.y + 1; ++row) {
    for (int column = 1; column <= cells.x + 1; ++column) {
      const auto n = static_cast<std::size_t>(grid.index(column, row));
      if (!moved[n].is_ahead) continue;
      const glm::dvec2 place(grid.places()[n]);
      motion.residual_px =
          std::max(motion.residual_px, glm::length(motion.at(place) - glm::dvec2(moved[n].xy_px)));
    }
  }
  return motion;
}

std::vector<glm::ivec2> far_to_near(const ImageGrid& grid, std::span<const MovedVertex> moved) {
  std::vector<std::pair<float, glm::ivec2>> cells;
  for (int row = 0; row < grid.cells().y; ++row) {
    for (int column = 0; column < grid.cells().x; ++column) {
      float nearest = 0;
      bool is_ahead = true;
      for (const int v : {grid.index(column, row), grid.index(column + 1, row), grid.index(column, row + 1),
                          grid.index(column + 1, row + 1)}) {
        is_ahead = is_ahead && moved[static_cast<std::size_t>(v)].is_ahead;
        nearest = std::max(nearest, moved[static_cast<std::size_t>(v)].inverse_depth);
      }
      if (is_ahead) cells.emplace_back(nearest, glm::ivec2(column, row));
    }
  }
  std::ranges::stable_sort(cells, {}, [](const auto& cell) { return cell.first; });
  std::vector<glm::ivec2> order;
  order.reserve(cells.size());
  for (const auto& [depth, cell] : cells) order.push_back(cell);
  return order;
}

}  // namespace vpe::warp
