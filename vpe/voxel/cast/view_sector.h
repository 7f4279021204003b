// Fans: how a perspective image of any pitch and roll is cut into columns.
//
// All planes through the camera and the planet's centre appear in an image as lines through one point, the
// vanishing point V of the vertical. Diagonals through V part the image into up to four sectors. In a sector,
// lines are a fixed distance apart on the image's row (or column) farthest from V, and a line's sample r lies
// where it crosses the r-th row of pixel centres; along it slopes are (a0 + a1 r) / (b0 + b1 r). So a pixel's
// nearest sample is in its own row, half the spacing away at most, and finding it is one affine map a row.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "vpe/core/view.h"
#include "vpe/voxel/cast/columns.h"

namespace vpe::voxel {

// One sector. Steps run along y where `upright`, else along x; lines cross them at `s`, the other coordinate.
struct ViewSector {
  bool upright = true;
  bool forward = true;  // its steps grow away from V
  int first_step = 0;   // pixels of the full image
  int steps = 0;
  double reference = 0;   // step coordinate that lines are even at
  double first_line = 0;  // s of line 0 there
  double spacing = 1;     // pixels
  int lines = 0;
  bool rising = true;  // slopes rise with the step

  // s at step t of what crosses the reference at s_ref is (s_ref - shift) / stretch; s_ref = stretch s + shift.
  struct Map {
    double off_axis_magnification;
    double shift;
  };
  std::vector<Map> maps;  // by step
  // The same for positions among the lines, in float: line = line_stretch (s - origin) + line_shift.
  double origin = 0;
  std::vector<float> line_stretch;
  std::vector<float> line_shift;
};

// What a line's columns need.
struct SectorLine {
  glm::dvec3 azimuth;  // unit, body-fixed
  double a0 = 0;       // rows counted so that slopes rise
  double a1 = 0;
  double b0 = 0;
  double b1 = 0;
  int row_begin = 0;
  int row_end = 0;  // past the last that is in the drawn part
};

class SectorPlan {
 public:
  // spacing_px in (0, 1]. The view is perspective; `up` is the vertical at the camera.
  SectorPlan(const core::View& view, const glm::dvec3& up, double spacing_px);

  const std::vector<ViewSector>& sectors() const { return sectors_; }
  SectorLine line(const ViewSector& sector, int index) const;

  // The sector of an image position.
  struct Side {
    bool upright;
    bool forward;
  };
  Side side_of(double x, double y) const;
  // nullptr where the drawn part has none of it.
  const ViewSector* sector_of(Side side) const {
    const int index = index_[side.upright ? 1 : 0][side.forward ? 1 : 0];
    return index < 0 ? nullptr : &sectors_[static_cast<std::size_t>(index)];
  }

  // Pixels [begin, end) of the drawn part's row, counted from its left, that are in an upright sector.
  struct Span {
    int begin;
    int end;
  };
  Span upright_span(int row) const;

 private:
  void add(bool upright, bool forward);

  core::View view_;
  core::SubRectangle part_;
  glm::dvec3 up_;
  double focal_;
  double cx_;
  double cy_;
  // V in homogeneous image coordinates: (vx, vy) / vw.
  double vx_;
  double vy_;
  double vw_;
  double spacing_;
  std::vector<ViewSector> sectors_;
  int index_[2][2] = {{-1, -1}, {-1, -1}};
};

}  // namespace vpe::voxel
