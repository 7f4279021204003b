// The frame between frames: a finished image as a coarse grid that follows the camera until the next image is there.
//
// Source: Cohen-Or, Rich, Lerner, Shenkar (1996), section 4: frames at the rate of the display are made of a rendered one
// by two polynomials of the second degree, fitted to points of the ground. Here also by a grid whose vertices have ranges
// of their own. Pure.
//
// Typical usage:
//   const ImageGrid grid(view, frame.range_m, {64, 36});
//   grid.move(newest_view, vertices);                   // each frame of the display
//   for (const glm::ivec2& cell : far_to_near(grid, vertices)) draw(cell);
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "vpe/core/view.h"

namespace vpe::warp {

struct MovedVertex {
  glm::vec2 xy_px{};        // in the new image's drawn part; no meaning if the vertex is not ahead
  float inverse_depth = 0;  // 1 / m along the new camera's axis; 0 for sky
  bool is_ahead = false;    // of the new camera
};

// A perspective image's drawn part in cells of equal size, with a ring of cells around it that continues its border.
// Vertices are numbered row by row from the top left of the ring.
class ImageGrid {
 public:
  // Takes the ranges of the drawn part, as core::Frame::range_m; a vertex has that of the nearest pixel. `cells` of the
  // image, 1 or more a side, without the ring. Throws std::invalid_argument where sizes do not fit and for other
  // projections.
  ImageGrid(const core::View& view, std::span<const float> range_m, glm::ivec2 cells);

  // Takes the ranges of the pixels at the corners of cells alone, row by row: corner n of a side of `length` pixels has pixel
  // min(length * n / cells, length - 1). The grid is that of all ranges. Throws as the constructor.
  static ImageGrid of_corners(const core::View& view, std::span<const float> range_m, glm::ivec2 cells);

  const core::View& view() const { return view_; }
  // Returns the number of cells with the ring, and of vertices.
  glm::ivec2 cells() const { return cells_; }
  glm::ivec2 vertices() const { return cells_ + 1; }
  int index(int column, int row) const { return row * (cells_.x + 1) + column; }
  // Returns places of vertices in the image, pixels of the drawn part; the ring's are outside of it.
  std::span<const glm::vec2> places() const { return places_; }
  // Returns what a place shows: itself, or the nearest place of the image. Shares of the drawn part's sides.
  glm::vec2 texture_at(std::size_t vertex) const;

  // Computes where a new perspective view sees the vertices: the point that a vertex shows is at its place within
  // 1e-3 px. Replaces `out`.
  void move(const core::View& to, std::vector<MovedVertex>& out) const;

 private:
  template <typename RangeAt>  // of a corner
  ImageGrid(const core::View& view, glm::ivec2 cells, const RangeAt& range_at);

  core::View view_;
  glm::ivec2 cells_;
  std::vector<glm::vec2> places_;
  std::vector<float> depth_m_;  // along the camera's axis; infinite for sky
};

// A motion of an image as two polynomials of the second degree in the place.
struct QuadraticMotion {
  std::array<double, 6>
      x{};  // factors of 1, x, y, x^2, x y, y^2, of places in halves of the image from its middle
  std::array<double, 6> y{};
  // Largest distance, pixels, to the places that ImageGrid::move() finds for the vertices of the image itself.
  double residual_px = 0;
  glm::dvec2 middle_px{};  // of the places
  glm::dvec2 half_px{1, 1};

  glm::dvec2 at(const glm::dvec2& place_px) const;
};

// Fits the polynomials to nine points: the vertices at the corners of the image, at the middles of its sides, and at its
// middle. Returns nullopt where one of them is not ahead of the new camera. Throws std::invalid_argument unless `moved` is
// of this grid and its image has an even number of cells a side.
std::optional<QuadraticMotion> fit_motion(const ImageGrid& grid, std::span<const MovedVertex> moved);

// Returns the cells, as their top left vertices, that can be drawn: all corners are ahead. The farthest come first, so that
// nearer ground covers it.
std::vector<glm::ivec2> far_to_near(const ImageGrid& grid, std::span<const MovedVertex> moved);

}  // namespace vpe::warp
