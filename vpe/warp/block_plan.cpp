#include "vpe/warp/block_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>

#include "vpe/warp/block_kernel.h"

namespace vpe::warp {

namespace {

// What is computed at the corners of a block holds within it with so much to spare.
constexpr double kSpare = 1.05;
constexpr double kLeastMargin = 0.01;
constexpr double kMostMargin = 0.5;
constexpr double kNoBound = std::numeric_limits<double>::infinity();

double largest_side(const glm::dvec2& v) { return std::max(std::abs(v.x), std::abs(v.y)); }

// Holds a facet: homogeneous points in the new camera's axes.
struct Facet {
  glm::dvec3 by_column{}, by_row{}, at_first{};
  glm::dvec3 at(const glm::dvec2& place) const { return place.x * by_column + place.y * by_row + at_first; }
};

// Holds a plane of inverse depths over a block.
struct ExactPlane {
  double at_first = 0;
  double by_column = 0;
  double by_row = 0;
};

// Tries blocks of the first image.
class BlockFitter {
 public:
  BlockFitter(const Motion& motion, const MovedPixels& pixels, glm::ivec2 new_size, const CarryOptions& options)
      : exact_(motion.exact()), pixels_(pixels), new_size_(new_size), gap_px_(options.gap_px) {
    most_parted_px_ = std::min(static_cast<double>(options.most_added_px), gap_px_ - 1 + kCarriedPosition_px);
  }

  struct Fit {
    FlatBlock block;  // without pixels if the new image does not show it
    double added_px = 0;
  };
  // Returns the block of `size` cells at a pixel, or nullopt if it is rough.
  std::optional<Fit> fit(glm::ivec2 first, glm::ivec2 size) const;

 private:
  // What the corners of a facet say about it.
  struct Corners {
    glm::dvec2 low{kNoBound};
    glm::dvec2 high{-kNoBound};
    double px_m = 0;  // largest displacement of a pixel for 1 / m of inverse depth
    double least_z = kNoBound;
    double widest_px = 0;           // of a cell
    double least_scale = kNoBound;  // pixels of the new image for one of the first
  };
  ExactPlane plane_of(glm::ivec2 first, glm::ivec2 size) const;
  Facet facet_of(glm::ivec2 first, const ExactPlane& plane) const;
  std::optional<Corners> corners_of(const Facet& facet, glm::ivec2 size) const;
  // Returns what a column and a row are in the new image, at a point.
  glm::dmat2 steps_at(const Facet& facet, const glm::dvec3& point) const;
  // Returns the product of a row of a matrix with a pixel's ray in the new camera's axes.
  Linear linear(const glm::dvec3& row, glm::ivec2 origin) const;
  void place(const Facet& facet, const ExactPlane& plane, FlatBlock& block) const;

  const Motion::Exact& exact_;
  const MovedPixels& pixels_;
  glm::ivec2 new_size_;
  double gap_px_;
  double most_parted_px_ = 0;
};

ExactPlane BlockFitter::plane_of(glm::ivec2 first, glm::ivec2 size) const {
  const auto depth_at = [&](int x, int y) {
    return static_cast<double>(pixels_.first_inverse_depth[pixels_.index(first.x + x, first.y + y)]);
  };
  const double a = depth_at(0, 0);
  const double b = depth_at(size.x, 0);
  const double c = depth_at(0, size.y);
  const double d = depth_at(size.x, size.y);
  ExactPlane plane;
  plane.by_column = (b + d - a - c) / (2.0 * size.x);
  plane.by_row = (c + d - a - b) / (2.0 * size.y);
  plane.at_first = 0.25 * (a + b + c + d) - 0.5 * (plane.by_column * size.x + plane.by_row * size.y);
  return plane;
}

Facet BlockFitter::facet_of(glm::ivec2 first, const ExactPlane& plane) const {
  const glm::dvec3 shift = exact_.focal * exact_.shift_m;
  return {exact_.by_column - plane.by_column * shift, exact_.by_row - plane.by_row * shift,
          exact_.first + static_cast<double>(first.x) * exact_.by_column +
              static_cast<double>(first.y) * exact_.by_row - plane.at_first * shift};
}

glm::dmat2 BlockFitter::steps_at(const Facet& facet, const glm::dvec3& point) const {
  const double scale = exact_.new_focal / (point.z * point.z);
  const auto step = [&](const glm::dvec3& by) {
    return scale * glm::dvec2(by.x * point.z - point.x * by.z, point.y * by.z - by.y * point.z);
  };
  return {step(facet.by_column), step(facet.by_row)};
}

std::optional<BlockFitter::Corners> BlockFitter::corners_of(const Facet& facet, glm::ivec2 size) const {
  Corners out;
  const glm::dvec2 end(size);
  const glm::dvec3& shift = exact_.shift_m;
  for (const glm::dvec2& place : {glm::dvec2(0, 0), glm::dvec2(end.x, 0), glm::dvec2(0, end.y), end}) {
    const glm::dvec3 point = facet.at(place);
    out.least_z = std::min(out.least_z, point.z);
    if (!(point.z > 2 * static_cast<double>(Motion::kLeastForward) * exact_.focal)) return std::nullopt;
    const double scale = exact_.new_focal / point.z;
    const glm::dvec2 xy = exact_.new_centre_px + scale * glm::dvec2(point.x, -point.y);
    out.low = glm::min(out.low, xy);
    out.high = glm::max(out.high, xy);
    const glm::dvec2 moves(point.x * shift.z - shift.x * point.z, point.y * shift.z - shift.y * point.z);
    out.px_m = std::max(out.px_m, exact_.focal * scale / point.z * largest_side(moves));
    const glm::dmat2 steps = steps_at(facet, point);
    const double turns = steps[0].x * steps[1].y - steps[0].y * steps[1].x;
    if (!(turns > 0)) return std::nullopt;  // the back of the ground
    const double squares = glm::dot(steps[0], steps[0]) + glm::dot(steps[1], steps[1]);
    out.least_scale = std::min(out.least_scale, turns / std::sqrt(squares));
    for (const glm::dvec2& side : {steps[0], steps[1], steps[0] - steps[1]})
      out.widest_px = std::max(out.widest_px, largest_side(side));
  }
  return out;
}

Linear BlockFitter::linear(const glm::dvec3& row, glm::ivec2 origin) const {
  const double x = row.x / exact_.new_focal;
  const double y = -row.y / exact_.new_focal;
  const glm::dvec2 from = glm::dvec2(origin) - exact_.new_centre_px;
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(row.z + x * from.x + y * from.y)};
}

void BlockFitter::place(const Facet& facet, const ExactPlane& plane, FlatBlock& block) const {
  block.origin = block.low;
  // Rows of the inverse of the matrix whose columns are those of the facet.
  const glm::dvec3 column = glm::cross(facet.by_row, facet.at_first);
  const glm::dvec3 row = glm::cross(facet.at_first, facet.by_column);
  const glm::dvec3 divisor = glm::cross(facet.by_column, facet.by_row);
  const double volume = glm::dot(facet.by_column, column);
  const glm::dvec3 middle = facet.at(0.5 * glm::dvec2(block.size));
  const double scale = middle.z / volume;  // so that the divisor is 1 at the middle
  block.column = linear(scale * column, block.origin);
  block.row = linear(scale * row, block.origin);
  block.divisor = linear(scale * divisor, block.origin);
  block.inverse_depth =
      linear(exact_.focal / volume * (plane.by_column * column + plane.by_row * row + plane.at_first * divisor),
             block.origin);
  const glm::dmat2 steps = steps_at(facet, middle);
  block.column_step = steps[0];
  block.row_step = steps[1];
}

std::optional<BlockFitter::Fit> BlockFitter::fit(glm::ivec2 first, glm::ivec2 size) const {
  const ExactPlane plane = plane_of(first, size);
  if (!std::isfinite(plane.at_first)) return std::nullopt;
  const Facet facet = facet_of(first, plane);
  const std::optional<Corners> corners = corners_of(facet, size);
  if (!corners || !(kSpare * corners->widest_px <= gap_px_)) return std::nullopt;
  const double px_m = kSpare * corners->px_m;
  const double sloped_px = px_m * (std::abs(plane.by_column) + std::abs(plane.by_row));
  if (!(sloped_px <= most_parted_px_)) return std::nullopt;
  const DepthRest rest = rest_of(&pixels_.first_inverse_depth[pixels_.index(first.x, first.y)],
                                 static_cast<std::size_t>(pixels_.width), size.x + 1, size.y + 1,
                                 {static_cast<float>(plane.at_first), static_cast<float>(plane.by_column),
                                  static_cast<float>(plane.by_row)});
  const double rest_px = px_m * static_cast<double>(rest.rest);
  Fit out;
  // Neighbours may both be off, each to its own side; so may what lies between them.
  out.added_px = sloped_px + 4 * rest_px;
  const bool is_sky = rest.largest == 0;
  const double rest_z = exact_.focal * static_cast<double>(rest.rest) * std::abs(exact_.shift_m.z);
  if (!(is_sky || rest.least > 0) || !(rest_px <= kMostFlat_px) || !(out.added_px <= most_parted_px_) ||
      !(rest_z <= 0.01 * corners->least_z))
    return std::nullopt;
  FlatBlock& block = out.block;
  const double margin = std::min(kLeastMargin + 2 * rest_px / corners->least_scale, kMostMargin);
  const double margin_px = 2 * margin * corners->widest_px + 0.02;
  block.low = glm::max(glm::ivec2(glm::floor(glm::max(corners->low - margin_px, -1.0))), 0);
  block.end =
      glm::min(glm::ivec2(glm::ceil(glm::min(corners->high + margin_px, glm::dvec2(new_size_)))), new_size_);
  if (block.low.x >= block.end.x || block.low.y >= block.end.y) {
    block.end = block.low;
    return out;
  }
  block.first = first;
  block.size = size;
  block.margin = static_cast<float>(margin);
  block.is_sky = is_sky;
  place(facet, plane, block);
  return out;
}

}  // namespace

BlockPlan::BlockPlan(const Motion& motion, const MovedPixels& pixels, glm::ivec2 new_size,
                     const CarryOptions& options, base::ThreadPool& pool) {
  const glm::ivec2 cells(pixels.width - 1, pixels.height - 1);
  if (cells.x < 1 || cells.y < 1) return;
  const bool has_taps = std::min(pixels.width, pixels.height) >= 4;  // which colours are mixed of
  const BlockFitter fitter(motion, pixels, new_size, options);
  rows_.resize(static_cast<std::size_t>((cells.y + kLarge - 1) / kLarge));
  std::vector<double> added_px(rows_.size());
  pool.run(rows_.size(), [&](std::size_t task) {
    Row& row = rows_[task];
    row.low = new_size.y;
    const auto take = [&](glm::ivec2 first, int most) {
      const auto fit = fitter.fit(first, glm::min(glm::ivec2(most), cells - first));
      if (!fit) return false;
      if (fit->block.low == fit->block.end) return true;
      added_px[task] = std::max(added_px[task], fit->added_px);
      row.low = std::min(row.low, fit->block.low.y);
      row.end = std::max(row.end, fit->block.end.y);
      row.flat.push_back(fit->block);
      return true;
    };
    const int top = static_cast<int>(task) * kLarge;
    for (int left = 0; left < cells.x; left += kLarge) {
      if (has_taps && take({left, top}, kLarge)) continue;
      for (int y = top; y < std::min(top + kLarge, cells.y); y += kSmall)
        for (int x = left; x < std::min(left + kLarge, cells.x); x += kSmall)
          if (!has_taps || !take({x, y}, kSmall)) row.rough.emplace_back(x, y);
    }
  });
  added_px_ = *std::ranges::max_element(added_px);
}

}  // namespace vpe::warp
