// Semi-transparent models from files: .volume (objects/volumes/volume_file.h) and OpenVDB (.vdb).
//
// Typical usage:
//   const VolumeModel smoke = read_volume_model("smoke.vdb");
#pragma once

#include <filesystem>

#include "objects/files/model_file.h"
#include "objects/volumes/volume_model.h"

namespace objects {

// Returns true for the extensions that read_volume_model() accepts, in any case.
bool is_volume_path(const std::filesystem::path& path);

// Reads a volume. Of an OpenVDB file takes the grid "density", else the first one of floats that is no level set: its values
// are the extinction along one unit of length of the file, UpAxis::kAuto means y, and the colour is a light grey. Such files
// are read by vpe-vdb-reader, which vpe-model-reader becomes and which is built where OpenVDB is installed. The options are of no effect for
// .volume. Throws what read_model_file() and read_volume_file() throw.
VolumeModel read_volume_model(const std::filesystem::path& path, const ModelFileOptions& options = {});

}  // namespace objects
