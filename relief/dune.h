// Dunes: a crest with a gentle stoss side and a slip face.
//
// The wind blows towards +x. With v = 2 |y| / width_m the crest lies at x = horn_m v^2 and has the height H(v), which is
// height_m in the middle and 0 at the ends. Before the crest the height is the parabola H (1 - (s / stoss_m)^2) of the way s
// to the crest, behind it the slip face falls along x with the slope of repose_deg to 0.
//
// Barchans have H = height_m (1 - v^2)^2 and horns that point downwind; transverse dunes are straight, with H = height_m
// up to v = 0.6. Forms of barchans: Bagnold 1941, The Physics of Blown Sand and Desert Dunes; Hesp and Hastings 1998,
// Geomorphology 22, 193-204 (width about ten times the height). Slip faces on Mars: 33 to 34 degrees (Atwood-Stone and
// McEwen 2013, Geophys. Res. Lett. 40, 2929-2934).
#pragma once

#include "relief/shape.h"

namespace relief {

struct DuneSize {
  double height_m = 0;     // of the crest; 0 or more
  double width_m = 0;      // across the wind; above 0
  double stoss_m = 0;      // length of the stoss side; above 0
  double horn_m = 0;       // how far the horns lie downwind of the middle of the crest; 0 or more
  double repose_deg = 33;  // slope of the slip face along the wind; above 0, below 90
  bool is_barchan = true;
};

class DuneShape final : public Shape {
 public:
  explicit DuneShape(const DuneSize& size);

  Rect support() const override;
  double height_m(double x_m, double y_m) const override;
  glm::dvec2 gradient(double x_m, double y_m) const override;
  Interval bounds_m(const Rect& rect) const override;

 private:
  double crest_m(double v) const;
  double crest_slope_m(double v) const;
  double profile_m(double way_m, double crest_m) const;

  DuneSize size_;
  double slope_;  // of the slip face, rise by run
};

}  // namespace relief
