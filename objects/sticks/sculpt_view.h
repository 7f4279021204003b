// A photograph in the grid of voxels, for sculpt.h.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "objects/sticks/sculpt.h"

namespace objects {

// Which way a photograph looks, in axes of the model: 0 to 2.
struct SculptAxes {
  int across = 0;  // axis along rows of pixels
  int up = 2;      // axis from the foot to the top of the image
  int depth = 1;
  bool runs_back = false;  // pixels from left to right run against `across`
  int toward = 1;          // direction of the camera along `depth`: 1 or -1
};
SculptAxes axes_of(SculptSide side);

// The box of pixels around a silhouette.
struct PixelBox {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};
// Returns nullopt for a mask that shows nothing.
std::optional<PixelBox> silhouette_box(const PhotoMask& mask);

// A view whose silhouette is as large as a grid of voxels.
class ProjectedView {
 public:
  // Keeps a reference to `view`, whose mask must show something.
  ProjectedView(const SculptView& view, const glm::ivec3& voxels);

  const SculptAxes& axes() const { return axes_; }
  int voxels_across() const { return across_; }
  int voxels_up() const { return up_; }
  // Whether at least half of the square of voxel (across, up) is on the mask.
  bool shows(int across, int up) const { return shows_[index(across, up)] != 0; }
  // Returns the mean of the pixels of a voxel's square that are on the mask, by area; nullopt if there is none.
  std::optional<glm::dvec3> colour(int across, int up) const;

 private:
  struct PixelRange {
    double begin = 0;
    double end = 0;
  };
  std::size_t index(int across, int up) const {
    return static_cast<std::size_t>(up) * static_cast<std::size_t>(across_) + static_cast<std::size_t>(across);
  }
  PixelRange columns(int across) const;
  PixelRange rows(int up) const;

  const SculptView& view_;
  SculptAxes axes_;
  PixelBox box_;
  int across_ = 0;
  int up_ = 0;
  std::vector<std::uint8_t> shows_;
};

// Gives colours and normals to the surface of carved voxels.
void colour_surface(VoxelGrid& voxels, std::span<const ProjectedView> views);

}  // namespace objects
