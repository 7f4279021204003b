// Checks that a file with one shard of a divided build is what its builder wrote.
#pragma once

#include <string>

#include "paging/planet/verify.h"

namespace paging {

// Reads the whole shard and checks the database's own structure, that index, counts and identity fit, every
// checksum, and that heights, masks, meshes and images can be decoded. What lies between shards (borders, bounds,
// the levels above) can be checked after merging only. Reports a damaged tile as a problem. Throws PlanetError
// for a file that is no shard, and what progress() throws.
VerifyReport verify_shard(const std::string& path, const VerifyProgress& progress = {});

}  // namespace paging
