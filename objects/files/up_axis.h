// The axis of a model file that points up. A file with y up faces along its +z, with +x to the left, as glTF has it. A
// file with z up has x to the right and y forward, as Mesh.
#pragma once

#include <cstdint>

namespace objects {

enum class UpAxis : std::uint8_t {
  kAuto,  // y for glTF and OBJ, z for PLY and STL
  kY,
  kZ,
};

}  // namespace objects
