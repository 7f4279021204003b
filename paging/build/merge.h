// Parts of a divided build -> planet file.
#pragma once

#include <string>
#include <vector>

#include "paging/build/builder.h"

namespace paging {

struct MergeOptions {
  std::vector<std::string> parts;  // files that build_planet made with BuildOptions::part, in any order
  std::string output;              // the planet file to make
  int threads = 0;                 // 0 = all cores
  double commit_s = 1.0;           // as in BuildOptions
};

// Joins all parts: tiles are copied with their checksums verified, the inner tiles above several parts are
// made, and the planet file has the content and meta of the undivided build, bit for bit. No source is read.
// Continues OUTPUT.part like build_planet. The parts are left as they are. Throws PlanetError (a part that is
// missing, double, damaged, no part, or of other sources, options or version; names it), DatabaseError.
BuildSummary merge_parts(const MergeOptions& options, const ProgressFunction& progress = {});

}  // namespace paging
