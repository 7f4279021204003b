// Files of models: glTF 2.0 (.gltf, .glb), Wavefront OBJ, PLY and STL.
//
// A separate program, vpe-model-reader, reads each file by means of the library assimp, so that a damaged or hostile
// file can only end that program. Nothing of assimp is loaded by this process.
//
// Typical usage:
//   const ModelFile rover = read_model_file("rover.glb");
//   for (const std::string& note : rover.notes) tell(note);                         // "2 animations are ignored"
//   const ModelFile part = read_model_file("part.stl", {.unit_m = 0.001});          // a drawing in millimetres
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "objects/files/up_axis.h"
#include "objects/model/mesh.h"

namespace objects {

struct ModelFileOptions {
  double unit_m = 1;  // the length of the file's unit; above 0
  UpAxis up = UpAxis::kAuto;
  // Limits the address space of the reader, 0.25 to 1024. 0.4 is enough for an STL of 2 million triangles without
  // textures (measured), so that a triangle takes some 200 bytes.
  double memory_gb = 2;
  // Limits the processor time of the reader, 1 to 1e6.
  double time_s = 120;
  // Reads a PLY of points, too. Without it such a file is an error whose message says how to make sticks of it.
  bool allows_points = false;
};

struct ModelFile {
  Mesh mesh;  // passes check(); where points are allowed and it has no triangle, check_points()
  std::vector<std::string> notes;  // what was ignored or repaired, a line each
};

// Reads a model. Instances of a part become copies. Materials keep their base colour, its texture, opacity and sides;
// the rest is ignored with a note. Textures and buffers must lie in the folder of the file, or below it. Throws
// vpe::base::FileError, which names the file, also when the reader is not installed, ends by a signal or takes more
// than its time. Throws std::invalid_argument for options out of range.
ModelFile read_model_file(const std::filesystem::path& path, const ModelFileOptions& options = {});

// Returns what vpe-model-reader writes about a file (mesh_stream.h, or the bytes of a volume). Throws as read_model_file()
// does where the program fails, but looks at no extension. Internal to objects/files.
std::vector<std::uint8_t> output_of_model_reader(const std::filesystem::path& path,
                                                 const ModelFileOptions& options);

// Returns true for the extensions that read_model_file() accepts, in any case.
bool is_model_path(const std::filesystem::path& path);

// Returns the path of vpe-model-reader: $VPE_MODEL_READER alone where that is set, else the first that exists of: beside
// this program, in libexec/vpe beside the program's bin, in the folder in which this program was built. Returns an empty
// string if there is none.
std::string model_reader_program();

}  // namespace objects
