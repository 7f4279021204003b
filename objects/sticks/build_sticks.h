// Makes a model of sticks from a grid of voxels: runs, the table of sticks, coarser levels.
//
// Typical usage:
//   const StickModel model = build_sticks(voxelise(mesh, textures));
//   const std::size_t level = ...;  // the coarsest with stick_error_m(model, level) below what a pixel covers
#pragma once

#include <cstddef>

#include "objects/sticks/stick_model.h"
#include "objects/sticks/voxel_grid.h"

namespace objects {

// Returns the model of a grid, with levels down to at most 4 voxels along each axis (halve_voxels.h says what they
// keep). Level 0 has the voxels of the grid; colours that nobody can see are lost. Equal sticks are stored once, and
// equal rows of colours too. The same grid gives the same model on every machine. Throws std::invalid_argument for
// more coloured voxels than StickLimits allows.
StickModel build_sticks(VoxelGrid voxels);

// Returns a bound, in metres, of the Hausdorff distance between the voxels of a level and those of level 0, opaque or
// semi-transparent, of a model from build_sticks(): sqrt(6) times the edge for each halving. 0 for level 0. Pure.
double stick_error_m(const StickModel& model, std::size_t level);

}  // namespace objects
