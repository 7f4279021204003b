// The terrain volume of one height grid of a planet.
//
// A level is a step of H (vpe/voxel/columns/height_grid.h), so that straight lines stay straight in the voxels of a grid, and
// no height is sampled anew: voxel (i, j, k) stands over post (i, j), at H = k level_m.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>

#include "mars/geodesy/cube.h"
#include "vpe/voxel/columns/height_grid.h"
#include "vpe/voxel/volume/band_volume.h"

namespace vpe::voxel {

// Immutable; any thread may read it.
struct GridVolume {
  mars::Face face = mars::Face::kPlusX;
  HeightGridFrame frame;
  DepthPlane reference;
  double level_m = 1;  // H of a level
  double voxel_m = 1;  // side of a voxel in the middle of the grid
  BandVolume voxels;
  // Bounds of the distance along the vertical between the reference surface over the grid and the surface of the voxels, and
  // any point of their boundary cells.
  double deviation_m = 0;
  double boundary_deviation_m = 0;

  // Returns the voxel coordinates of a point over the grid, in metres about the planet's centre.
  glm::dvec3 voxel_of(const glm::dvec3& place_m, double radius_m) const;
  // Returns the height above the planet's sphere of a point in voxel coordinates.
  double height_m(const glm::dvec3& voxel, double radius_m) const;
  // Returns a radius that no boundary cell reaches.
  double highest_m(double radius_m) const;
  std::size_t bytes() const { return sizeof(GridVolume) + voxels.bytes(); }
};

// Makes the volume of a grid whose lines are of `family`. Voxels are as high as wide in the middle of the grid, or higher where
// the ground would take more than kMostBandLevel levels either way. Throws what make_band_volume() throws.
GridVolume make_grid_volume(mars::Face face, const HeightGridFrame& frame, const HeightGridLines<float>& lines,
                            LineFamily family, double radius_m, const BandSpec& spec);

}  // namespace vpe::voxel
