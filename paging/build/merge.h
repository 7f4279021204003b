// Merges the shards of a divided build into a planet file.
#pragma once

#include <string>
#include <vector>

#include "paging/build/builder.h"

namespace paging {

struct MergeOptions {
  std::vector<std::string> shards;  // files that build_planet() made with BuildOptions::shard, in any order
  std::string output;               // the planet file to make
  int threads = 0;                  // 0 = all cores
  double commit_s = 1.0;            // as in BuildOptions
};

// Merges all shards: copies tiles after verifying their checksums, and makes the inner tiles that lie above
// several shards. The planet file has the content and meta of the undivided build, bit for bit. Reads no
// source. Continues OUTPUT.part like build_planet(). Leaves the shards as they are.
//
// Throws DatabaseError, and PlanetError for a shard that does not exist, is given twice, is damaged, is
// another kind of file, or has other sources, options or version; the message names it.
BuildSummary merge_shards(const MergeOptions& options, const ProgressFunction& progress = {});

}  // namespace paging
