// A model: levels of detail of a mesh with their trees, or sticks of voxels, or a semi-transparent volume, and a ball
// around them.
//
// Typical usage:
//   const Model model("rover", make_levels_apart(std::move(mesh)));
//   const Model::Level& level = model.levels()[model.level_within(0.01)];  // the coarsest within a centimetre
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "objects/model/mesh_level.h"
#include "objects/model/texture_pyramid.h"
#include "objects/sticks/stick_model.h"
#include "objects/volumes/volume_model.h"

namespace objects {

// Immutable once made. Any thread may call any member.
class Model {
 public:
  using Level = MeshLevel;

  // Levels run from the finest, of error 0, to coarser ones with larger errors. Each mesh must pass check(). Takes the
  // textures from level 0. Throws std::invalid_argument if there is no level.
  Model(std::string name, std::vector<Level> levels);
  // Makes a model of sticks, which has no meshes.
  Model(std::string name, std::shared_ptr<const StickModel> sticks);
  // Makes a semi-transparent model, which has neither meshes nor sticks.
  Model(std::string name, std::shared_ptr<const VolumeModel> volume);

  const std::string& name() const { return name_; }
  const std::vector<Level>& levels() const { return levels_; }
  // Returns the sticks, or null for other models.
  const StickModel* sticks() const { return sticks_.get(); }
  // Returns the volume, or null for other models.
  const VolumeModel* volume() const { return volume_.get(); }
  const std::vector<TexturePyramid>& textures() const { return textures_; }
  // A ball around all levels that are drawn.
  const Ball& ball() const { return ball_; }
  // Returns the index of the coarsest level, of meshes, sticks or a volume, whose error is at most geometric_error_m; 0 if none is.
  std::size_t level_within(double geometric_error_m) const;
  // Returns the error of a level.
  double level_error_m(std::size_t level) const { return errors_m_[level]; }

  // The mean area of the silhouette over all directions, square metres, at most pi radius^2: a quarter of the surface of
  // a convex model (Cauchy), and no more than that of the ball for others.
  double mean_silhouette_m2() const { return mean_silhouette_m2_; }
  // The mean colour of the surface by area, 0 to 255, and its mean opacity, 0 to 1.
  const glm::dvec3& mean_colour() const { return mean_colour_; }
  double mean_opacity() const { return mean_opacity_; }
  // Returns true if parts of the model may be semi-transparent: several ranges show in a pixel.
  bool is_see_through() const { return is_see_through_; }

  std::size_t bytes() const;

 private:
  std::string name_;
  std::vector<Level> levels_;
  std::shared_ptr<const StickModel> sticks_;
  std::shared_ptr<const VolumeModel> volume_;
  std::vector<double> errors_m_;  // of levels
  std::vector<TexturePyramid> textures_;
  Ball ball_;
  double mean_silhouette_m2_ = 0;
  glm::dvec3 mean_colour_{0, 0, 0};
  double mean_opacity_ = 1;
  bool is_see_through_ = false;
};

}  // namespace objects
