// Point clouds: PLY files of vertices without faces. They are read number by number and without assimp, so memory is
// that of the points.
#pragma once

#include <filesystem>
#include <optional>

#include "objects/files/mesh_stream.h"
#include "objects/files/model_file.h"

namespace objects {

// Returns the points of a PLY without faces, in the order of the file; the mesh passes check_points(). Returns nullopt
// for a PLY with faces. Normals and colours are kept where all three numbers of them are there. A full channel of a
// colour is 1 in floats, 65535 in numbers of type ushort and 255 in those of other types. Points whose coordinates are
// not finite are left out with a note; normals without a direction become 0. Throws Refusal for a damaged file, and for
// one of points unless options.allows_points is set.
std::optional<MeshStream> read_ply_points(const std::filesystem::path& path, const ModelFileOptions& options);

}  // namespace objects
