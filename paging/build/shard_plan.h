// Divides a build: selects the tiles that one shard makes.
#pragma once

#include <span>
#include <vector>

#include "paging/build/build_steps.h"
#include "paging/plan/build_plan.h"
#include "vpe/base/shard.h"

namespace paging {

struct ShardPlan {
  std::span<const lod::TileKey> leaves;        // a block in Morton order
  std::vector<lod::TileKey> inner;             // wholly above these leaves, deepest first
  std::vector<lod::TileKey> shared_ancestors;  // above other shards too, deepest first; merging stores them
};

// Selects the tiles of one shard. `plan` must outlive the result. Throws PlanetError when the planet has fewer
// finest tiles than shards.
ShardPlan shard_plan(const BuildPlan& plan, const vpe::base::Shard& shard);

// Holds what a shard knows of a shared ancestor: the errors of its mesh over the shard's own leaves.
struct SharedAncestorTerms {
  InnerTerms terms;
  std::int64_t mesh_checksum = 0;  // checksum(packed key, encode_mesh) of the mesh that was measured
};
inline constexpr std::int64_t kSharedAncestorsCheckpoint = -1;  // number of the checkpoint that holds them

// Converts them to bytes and back; unpack_shared_ancestors() throws CodecError.
Bytes pack_shared_ancestors(const std::map<lod::TileKey, SharedAncestorTerms>& ancestors);
std::map<lod::TileKey, SharedAncestorTerms> unpack_shared_ancestors(std::span<const std::uint8_t> packed);

}  // namespace paging
