// The first hits of a tile of pixels, by quarters of the screen and halves in depth.
#pragma once

#include <span>
#include <vector>

#include "relief/cast/ray_caster.h"
#include "relief/cast/ray_forms.h"
#include "vpe/core/view.h"

namespace relief {

// The sides of a tile in pixels: 2^kTileLevels.
inline constexpr int kTileLevels = 6;
inline constexpr int kTileSide = 1 << kTileLevels;

// Holds a perspective view and a surface as its rays see it. Immutable; every const function may be called from any number
// of threads at once.
class ScreenRays {
 public:
  // Expects a surface that outlives it, and a view that check() accepts.
  ScreenRays(const Surface& surface, const vpe::core::View& view);

  // Holds a piece as the rays see it.
  struct PieceForms {
    LinearForm x;
    LinearForm y;
    LinearForm w;
    std::vector<LinearForm> sides;
  };

  const Surface& surface() const { return surface_; }
  const RayCaster& caster() const { return caster_; }
  const QuadraticForm& first() const { return first_; }
  const QuadraticForm& second() const { return second_; }
  const PieceForms& piece(std::size_t n) const { return pieces_[n]; }

  int width() const { return width_; }
  int height() const { return height_; }
  double tangent_per_px() const { return 1 / focal_px_; }

  // Returns the tangents of the centres of pixels x0 to x1 - 1 and y0 to y1 - 1 of the drawn part.
  Tangents tangents(int x0, int x1, int y0, int y1) const;

  // Returns the ray of tangents (x, y); its parameter is the depth.
  Ray ray(double x, double y) const;

 private:
  const Surface& surface_;
  RayCaster caster_;
  RayAxes axes_;
  QuadraticForm first_;
  QuadraticForm second_;
  std::vector<PieceForms> pieces_;
  double focal_px_ = 1;
  double left_px_ = 0;  // of the drawn part's corner from the principal point, x right, y down
  double top_px_ = 0;
  int width_ = 0;
  int height_ = 0;
};

// Writes the ranges of the tile whose first pixel is (x0, y0) into an image of the drawn part's size, and returns the
// counts of its work. Other pixels are left alone.
CastCounts cast_tile(const ScreenRays& rays, const CastOptions& options, int x0, int y0,
                     std::span<double> range_m);

}  // namespace relief
