// The part of `vpe object` that is for point clouds.
#pragma once

#include <string>

#include "objects/files/model_file.h"

namespace vpe::app {

struct Common;

struct PointArguments {
  std::string model;   // .ply
  std::string output;  // "": the points are described
  int voxels = 256;
  int close_voxels = 1;
};

// Describes the points of a file that was read, or writes a model of sticks of them. Throws base::FileError.
void run_points(const PointArguments& arguments, const objects::ModelFile& file, const Common& common);

}  // namespace vpe::app
