// Reading of volumes by means of OpenVDB, inside vpe-vdb-reader.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "objects/files/model_file.h"

namespace objects {

// Returns the bytes of a volume (objects/volumes/volume_file.h). Throws Refusal. Whoever calls it must be ready for
// faults of OpenVDB, which end the process.
std::vector<std::uint8_t> read_with_openvdb(const std::filesystem::path& path, const ModelFileOptions& options);

}  // namespace objects
