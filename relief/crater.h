// Impact craters by published scaling.
//
// A profile of the distance r from the centre, with the ground before the impact at 0:
//   r < floor         rim_m - depth_m, flat; a central peak rises from it
//   floor < r < R     rim_m - depth_m (1 - t^2), t from 0 at the floor's border to 1 at the rim's crest
//   r > R             rim_m (r / R)^-3, faded to 0 from half of the way to the end of the ejecta on
//
// Sizes that the user does not give follow from the diameter D = 2 R of the crest, as observed:
// - depth from the crest to the floor: 0.2 D of fresh simple craters (Pike 1974, Geophys. Res. Lett. 1, 291-294; Pike
//   1977, Proc. Lunar Sci. Conf. 8, 3427-3436, has 0.196 D^1.01), or 0.36 D^0.49 km of complex craters on Mars where that
//   is less (D in km; Garvin, Sakimoto and Frawley 2003, Sixth Int. Conf. on Mars, abstract 3277). Both meet at 3.2 km.
// - the rim's height above the ground: a fifth of the depth, 0.04 D for simple craters (Pike 1977).
// - from kComplexDiameter_m on (simple craters on Mars end at 7.5 to 8.5 km: Garvin and Frawley 1998, Geophys. Res. Lett.
//   25, 4405-4408) a flat floor with a diameter of 0.187 D^1.249 km (Pike 1977) and a central peak of 0.04 D^0.51 km (Garvin
//   et al. 2003), at most half of the depth. Both grow from nothing over one doubling of D, so that nothing jumps while
//   a diameter is animated.
// - ejecta fall as r^-3 (McGetchin, Settle and Head 1973, Earth Planet. Sci. Lett. 20, 226-236).
#pragma once

#include "relief/shape.h"

namespace relief {

// Craters of this diameter and less are bowls.
inline constexpr double kComplexDiameter_m = 7000;

struct CraterSize {
  double radius_m = 0;      // of the crest; above 0
  double depth_m = 0;       // from the crest to the floor; 0 or more
  double rim_m = 0;         // height of the crest above the ground; 0 or more
  double floor_ratio = 0;   // radius of the flat floor by radius_m; 0 to 0.9
  double peak_m = 0;        // height of the central peak above the floor; 0 or more
  double ejecta_ratio = 5;  // radius of the end of the ejecta by radius_m; above 1
};

// Returns the sizes of a fresh crater on Mars. They are continuous in the radius.
CraterSize mars_crater(double radius_m);

class CraterShape final : public Shape {
 public:
  explicit CraterShape(const CraterSize& size);

  Rect support() const override;
  double height_m(double x_m, double y_m) const override;
  glm::dvec2 gradient(double x_m, double y_m) const override;
  Interval bounds_m(const Rect& rect) const override;

 private:
  double bowl_m(double ratio) const;
  double peak_m(double ratio) const;
  double ejecta_m(double ratio) const;

  CraterSize size_;
  double peak_ratio_;  // radius of the central peak by radius_m
  double fade_ratio_;  // where ejecta begin to fade
};

}  // namespace relief
