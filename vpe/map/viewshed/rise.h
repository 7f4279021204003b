// Heights of a sphere's ground as a plane would show them to an observer.
#pragma once

#include <span>

namespace vpe::map {

// Stands for a post whose rise is not known. It hides nothing.
inline constexpr float kNoRise = -1e30F;

// Describes an observer for whom rises are computed.
struct RiseView {
  double observer_m = 0;     // height of the eye above the sphere
  double radius_m = 0;       // of the sphere; infinity: a plane
  double spacing_m = 1;      // of posts
  double reach_squared = 0;  // square of the distance beyond which posts are unknown, in posts
};

// Computes the rise of posts of one row: the height over the eye that a point of a plane must have at the same distance
// to be seen under the same elevation. A rise divided by its distance is the tangent of that elevation, so rises
// of posts in one direction compare as heights over a plane do. On a sphere of radius R the point of height h at the
// angle a from the eye of height e has the rise a R ((R + h) cos a - (R + e)) / ((R + h) sin a). The relative error is
// that of float numbers. `added_m` is added to the heights. `across` is the number of posts from the row to the eye,
// `first` that of posts from the eye's column to the first height, negative to the west. Gives kNoRise where a height
// is not finite, is farther than 1e9 m from the sphere or at its centre, or is out of reach. The reach must be at most a quarter of the
// circumference.
void rises(const RiseView& view, std::span<const float> heights_m, float added_m, int across, int first,
           std::span<float> rises_m);

// Computes the heights that posts of one row must have for their rise to be `rises_m`, over their heights, in metres; at
// least 0. Infinity where no height has that rise, NaN where a height has none. The other arguments are those of rises().
void heights_to_rise(const RiseView& view, std::span<const float> heights_m, int across, int first,
                     std::span<float> rises_m);

}  // namespace vpe::map
