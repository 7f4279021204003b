// The part of `vpe object` that is for semi-transparent volumes.
#pragma once

#include <string>

#include "objects/files/model_file.h"

namespace vpe::app {

struct Common;

struct VolumeArguments {
  std::string model;   // .volume or .vdb, or any raster with levels_m
  std::string output;  // "": the volume is described
  objects::ModelFileOptions options;
  std::string colour;  // "rrggbb"; "": that of the file
  double density = 1;  // factor on the extinction
  double levels_m =
      0;  // distance of the posts of a raster with a band for each level; 0: the model is no raster
};

// Describes a volume, or writes it as .volume. Throws UsageError, base::FileError and
// mars::SourceError.
void run_volume(const VolumeArguments& arguments, const Common& common);

}  // namespace vpe::app
