// How a build is divided: which tiles one part makes.
#pragma once

#include <span>
#include <vector>

#include "paging/build/build_steps.h"
#include "paging/build/build_plan.h"
#include "vpe/base/shard.h"

namespace paging {

struct Share {
  std::span<const lod::TileKey> leaves;  // a block along the curve
  std::vector<lod::TileKey> inner;       // wholly above them, deepest first
  std::vector<lod::TileKey> above;       // above them and other parts' too, deepest first: made by merge_parts
};

// `plan` must outlive it. Throws PlanetError when the planet has fewer finest tiles than parts.
Share share_of(const Plan& plan, const vpe::base::Shard& part);

// What a part knows of a tile in Share::above: the errors over its own leaves, of which mesh.
struct AboveNote {
  InnerTerms terms;
  std::int64_t mesh_checksum = 0;  // checksum(packed key, encode_mesh)
};
inline constexpr std::int64_t kAboveNote = -1;  // its number in the table `note`

// As bytes and back; unpack throws CodecError.
Bytes pack_above(const std::map<lod::TileKey, AboveNote>& notes);
std::map<lod::TileKey, AboveNote> unpack_above(std::span<const std::uint8_t> packed);

}  // namespace paging
