// Levels of detail of models, made by a program of its own: a damaged or hostile mesh can only end that program, and the
// library that simplifies meshes is not loaded by this process.
//
// Typical usage:
//   std::vector<MeshLevel> levels = make_levels_apart(std::move(mesh));
#pragma once

#include <string>
#include <vector>

#include "objects/model/mesh_level.h"

namespace objects {

struct LevelProgramOptions {
  // Limits the address space of the program, 0.25 to 1024.
  double memory_gb = 4;
  // Limits the processor time of the program, 1 to 1e6.
  double time_s = 300;
};

// Returns what make_levels() (objects/levels/mesh_levels.h) returns, by the program vpe-model-levels. Throws
// std::runtime_error with the reason if that is missing, ends by a signal, takes more than it may or sends what are no
// levels; `mesh` is as before then. Throws std::invalid_argument for options out of range.
std::vector<MeshLevel> make_levels_apart(Mesh&& mesh, const LevelProgramOptions& options = {});

// Returns the path of vpe-model-levels, which is looked for as model_reader_program() is: in $VPE_MODEL_LEVELS, beside this
// program, and so on. Returns an empty string if there is none.
std::string model_levels_program();

}  // namespace objects
