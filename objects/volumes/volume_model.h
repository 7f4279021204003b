// A semi-transparent model: a field of extinction with coarser levels, of one colour.
//
// Typical usage:
//   const VolumeModel model(volume_by_formula(formula), {200, 170, 140});
//   const VolumeLevel& level = model.levels()[1];
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "objects/model/mesh.h"
#include "objects/volumes/volume_level.h"

namespace objects {

// Says what a volume looks like from far away: means over rays along x, y and z.
struct VolumeLook {
  double silhouette_m2 = 0;  // area of what has any opacity
  double opacity = 0;        // mean over that area, 0 to 1
};

// Immutable. Any thread may call any member.
class VolumeModel {
 public:
  // Makes the coarser levels, as long as they reach little beyond the finest one. `colour` is that of all of it in full
  // light, sRGB; its alpha is ignored. Throws std::invalid_argument if check() finds fault with the level, or if it is
  // empty.
  VolumeModel(VolumeLevel finest, Rgba colour);

  // Levels run from the finest to the coarsest.
  const std::vector<VolumeLevel>& levels() const { return levels_; }
  const Rgba& colour() const { return colour_; }
  // A ball around all extinction of all levels.
  const Ball& ball() const { return ball_; }
  // The box of all extinction of the finest level.
  const glm::vec3& low_m() const { return low_m_; }
  const glm::vec3& high_m() const { return high_m_; }
  const VolumeLook& look() const { return look_; }
  // The largest extinction of a post of the finest level, above 0.
  double largest_per_m() const { return largest_per_m_; }
  // Returns how far a level moves extinction, across a ray: 0 for the finest one, the spacing of its posts for others. This
  // bounds the root mean square, sqrt(2/3) of the spacing; it is no bound of each part's way, as a volume has no surface.
  double level_error_m(std::size_t level) const;
  std::size_t bytes() const;

 private:
  std::vector<VolumeLevel> levels_;
  Rgba colour_;
  Ball ball_;
  glm::vec3 low_m_{0, 0, 0};
  glm::vec3 high_m_{0, 0, 0};
  VolumeLook look_;
  double largest_per_m_ = 0;
};

}  // namespace objects
