// Sectors: divides a perspective image of any pitch and roll into vertical columns.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): SectorCaster makes a SectorPlan for each image and casts
// every ViewSector as a ColumnBatch.
//
// All planes through the camera and the planet's centre appear in an image as lines through one point, the
// vanishing point V of the vertical. Diagonals through V divide the image into up to four sides, and where lines
// would be crowded near V a side is divided into rings of rows (or columns), each a sector with lines of its own. In a
// sector, lines are a fixed distance apart on the row (or column) farthest from V, and sample r of a line lies
// where the line crosses the r-th row of pixel centres. Along a line the slopes of rays are (a0 + a1 r) / (b0 +
// b1 r). So a pixel's nearest sample is in its own row, half the spacing away at most, and one affine map for
// each row finds it (docs/design/rays.md).
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "vpe/core/view.h"
#include "vpe/voxel/columns/columns.h"

namespace vpe::voxel {

// Describes one sector. Steps are rows of pixels (t = y) if `upright`, else columns of pixels (t = x). Lines
// cross the steps at s, the other coordinate.
struct ViewSector {
  bool upright = true;
  bool forward = true;  // steps grow away from V
  int first_step = 0;   // pixel of the full image
  int steps = 0;
  double reference = 0;   // t at which the lines are evenly spaced
  double first_line = 0;  // s of line 0 at the reference
  double spacing = 1;     // of lines at the reference, pixels
  int lines = 0;
  bool rising = true;  // slopes rise with the step

  // Maps s of a step to s of the same line at the reference: s_reference = scale s + shift.
  struct Map {
    double scale;
    double shift;
  };
  std::vector<Map> maps;  // by step
  // Maps s to a position among the lines, in float: line = line_scale (s - origin) + line_shift, by step.
  double origin = 0;
  std::vector<float> line_scale;
  std::vector<float> line_shift;
};

// Describes the column of one line.
struct SectorLine {
  glm::dvec3 azimuth;  // unit, body-fixed
  double a0 = 0;       // slope coefficients; rows are counted so that slopes rise
  double a1 = 0;
  double b0 = 0;
  double b1 = 0;
  int row_begin = 0;
  int row_end = 0;  // past the last that is in the drawn part
};

// Divides one image into sectors. Immutable; any thread may read it.
class SectorPlan {
 public:
  // The view must be perspective; `up` is the unit vertical at the camera. spacing_px > 0: smaller finds narrower ridges and makes
  // more columns; 1 gives each pixel samples at most half a pixel away. A sector may have more rows than lines. A side has at most
  // `most_rings` sectors, and several only where that saves samples.
  SectorPlan(const core::View& view, const glm::dvec3& up, double spacing_px, int most_rings = kMostRings);
  static constexpr int kMostRings = 4;

  const std::vector<ViewSector>& sectors() const { return sectors_; }
  // Returns the column of line `index`, 0 <= index < sector.lines.
  SectorLine line(const ViewSector& sector, int index) const;

  // The lines and steps of a sector that hold the samples of some pixels.
  struct Window {
    int first_line = 0;
    int end_line = 0;
    int first_step = 0;
    int end_step = 0;
    bool is_empty() const { return first_line >= end_line || first_step >= end_step; }
  };
  // Returns lines and steps that hold all samples beside the pixels of a rectangle of the full image.
  static Window window(const ViewSector& sector, const core::SubRectangle& pixels);

  // Names a sector by its direction from V, and its place among those of that direction, the farthest from V first.
  struct Side {
    bool upright;
    bool forward;
    int ring = 0;
  };
  // Returns the side of V that a pixel's centre lies on.
  Side side_of(double x, double y) const;
  // Returns the sector on a side, or nullptr if the drawn part has no pixels of it.
  const ViewSector* sector_of(Side side) const {
    const Rings& rings = rings_of(side);
    return side.ring < rings.count ? &sectors_[static_cast<std::size_t>(rings.first + side.ring)] : nullptr;
  }
  // Returns how many pixels from step `step` of the full image on, at least one, belong to the same sector as its pixels on this side;
  // at most `most`.
  int steps_alike(Side side, int step, int most) const;

  // Range [begin, end) of pixels, counted from the left of the drawn part.
  struct Span {
    int begin;
    int end;
  };
  // Returns the pixels of a row of the drawn part that lie in upright sectors.
  Span upright_span(int row) const;

 private:
  // The sectors of a direction: so many from `first` on.
  struct Rings {
    int first = 0;
    int count = 0;
  };
  // Range of s of the centres of a step's pixels on one side. Empty, low above high, where it has none.
  struct Reach {
    double low;
    double high;
  };

  const Rings& rings_of(Side side) const { return rings_[side.upright ? 1 : 0][side.forward ? 1 : 0]; }
  void add(bool upright, bool forward, int most_rings);
  // Adds the sector of the steps from `first_step` on; none if it has no pixels.
  void add_ring(bool upright, bool forward, int first_step, std::span<const Reach> reach);

  core::View view_;
  core::SubRectangle part_;
  glm::dvec3 up_;
  double focal_;
  double cx_;
  double cy_;
  // V in homogeneous image coordinates, (vx, vy) / vw, with vw >= 0.
  double vx_;
  double vy_;
  double vw_;
  double spacing_;
  double margin_px_;
  std::vector<ViewSector> sectors_;
  Rings rings_[2][2];
};

}  // namespace vpe::voxel
