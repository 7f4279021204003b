// The part of `vpe object` that is for semi-transparent volumes.
#pragma once

#include <string>

#include "objects/files/model_file.h"

namespace vpe::app {

struct Common;

struct VolumeArguments {
  std::string model;   // .volume or .vdb
  std::string output;  // "": the volume is described
  objects::ModelFileOptions options;
  std::string colour;  // "rrggbb"; "": that of the file
  double density = 1;  // factor on the extinction
};

// Describes a volume, or writes it as .volume. Throws UsageError, base::FileError.
void run_volume(const VolumeArguments& arguments, const Common& common);

}  // namespace vpe::app
