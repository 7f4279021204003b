// The bytes of the coarser levels of a model, as they are kept in files and handed from process to process of one
// machine.
//
// Typical usage:
//   write_level_stream(levels, [&](std::span<const std::uint8_t> bytes) { send(bytes); });
//   std::vector<MeshLevel> levels = read_level_stream(bytes, std::move(finest));
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "objects/model/mesh_level.h"

namespace objects {

// Bounds the number of coarser levels.
inline constexpr std::size_t kMostCoarseLevels = 32;

// Gives the bytes of levels[1] and those after it to `sink` in pieces. Their trees are not written.
void write_level_stream(std::span<const MeshLevel> levels,
                        const std::function<void(std::span<const std::uint8_t>)>& sink);

// Returns `finest` as level 0 and the levels that the bytes hold, with trees. Compares every count with the bytes that are
// left before it allocates. Each mesh passes check(), has the materials of level 0 and no textures; errors are above 0
// and ascend. Throws std::runtime_error for bytes that are damaged, or have another version or other materials; `finest`
// is as before then.
std::vector<MeshLevel> read_level_stream(std::span<const std::uint8_t> bytes, Mesh&& finest);

}  // namespace objects
