// How a build is divided: which tiles one part makes.
#pragma once

#include <span>
#include <vector>

#include "paging/build/build_plan.h"
#include "paging/build/build_steps.h"
#include "vpe/base/shard.h"

namespace paging {

struct ShardPlan {
  std::span<const lod::TileKey> leaves;  // a block along the curve
  std::vector<lod::TileKey> inner;       // wholly above them, deepest first
  std::vector<lod::TileKey> above;       // above them and other parts' too, deepest first: made by merge_parts
};

// `plan` must outlive it. Throws PlanetError when the planet has fewer finest tiles than parts.
ShardPlan shard_plan(const BuildPlan& plan, const vpe::base::Shard& part);

// What a part knows of a tile in Share::above: the errors over its own leaves, of which mesh.
struct SharedAncestorTerms {
  InnerTerms terms;
  std::int64_t mesh_checksum = 0;  // checksum(packed key, encode_mesh)
};
inline constexpr std::int64_t kSharedAncestorsCheckpoint = -1;  // its number in the table `note`

// As bytes and back; unpack throws CodecError.
Bytes pack_shared_ancestors(const std::map<lod::TileKey, SharedAncestorTerms>& checkpoints);
std::map<lod::TileKey, SharedAncestorTerms> unpack_shared_ancestors(std::span<const std::uint8_t> packed);

}  // namespace paging
