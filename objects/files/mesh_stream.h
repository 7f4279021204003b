// The bytes by which vpe-model-reader hands a model to the program that started it. Both run on one machine, so numbers
// have that machine's byte order.
//
// Typical usage:
//   write_mesh_stream({mesh, notes}, [&](std::span<const std::uint8_t> bytes) { send(bytes); });
//   const MeshStream received = read_mesh_stream(bytes);
//   if (!received.error.empty()) complain(received.error, received.advice);
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "objects/model/mesh.h"

namespace objects {

struct MeshStream {
  Mesh mesh;
  std::vector<std::string> notes;  // what the reader ignored, a line each
  std::string error;               // why there is no mesh; empty: there is one
  std::string advice;              // what to do about the error
};

// Gives the limits that both functions enforce.
struct MeshStreamLimits {
  static constexpr std::size_t kMostNotes = 1000;
  static constexpr std::size_t kLongestText_bytes = 4096;
};

// Gives the bytes of a model to `sink` in pieces. Leaves the mesh out where there is an error. Shortens lists and texts
// that exceed the limits.
void write_mesh_stream(const MeshStream& stream,
                       const std::function<void(std::span<const std::uint8_t>)>& sink);

// Returns what the bytes hold. Compares every count with the bytes that are left before it allocates. A returned mesh
// passes check(); with `allows_points` one without triangles passes check_points() instead. Throws std::runtime_error
// for bytes that are damaged or have another version, with what is wrong.
MeshStream read_mesh_stream(std::span<const std::uint8_t> bytes, bool allows_points = false);

}  // namespace objects
