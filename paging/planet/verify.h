// Checks that a planet file is what its builder wrote, and that what it states of itself is true.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"

namespace paging {

struct VerifyOptions {
  int threads = 0;  // 0 = all cores
  // Number of finest tiles, evenly spread, that are measured again: their own meshes and those of all their
  // ancestors against the reference surface, which must stay within the stated errors. 0 = none. Larger:
  // slower, and more likely to find an error that is stated too small.
  std::size_t deep_tiles = 0;
};

struct Problem {
  std::string where;  // a tile ("+x/4/3/12"), or a table of the file
  std::string what;
};

struct VerifyReport {
  std::vector<Problem> problems;  // of the file as a whole, then by tile
  std::int64_t tiles = 0;         // checked: posts, range, slope, posts shared with children
  std::int64_t meshes = 0;        // checked: triangles, cover, vertices on posts
  std::int64_t borders = 0;       // checked between two tiles: equal posts, equal vertices of meshes
  std::int64_t images = 0;
  std::int64_t measured = 0;  // pairs of a mesh and a finest tile
  // Largest ratio of a measured error to the stated one: near 1 means that bounds are tight.
  double largest_share = 0;
};

// Receives the fraction done. Called from worker threads, one at a time. May throw to stop.
using VerifyProgress = std::function<void(double fraction)>;

// Reads the whole file and checks checksums, codecs, the database's own structure, and that posts and meshes
// of neighbours and of parents agree to the bit. (Opening the file has checked that errors nest.) Reports a
// damaged tile as a problem, not as an exception. Of a patched planet it reads all tiles, but no database. Throws
// only what progress() throws.
//
// Typical usage:
//   const VerifyReport report = verify(*PlanetFile::open(path), {.deep_tiles = 100});
//   for (const Problem& problem : report.problems) print(problem.where, problem.what);
VerifyReport verify(const PlanetFile& planet, const VerifyOptions& options,
                    const VerifyProgress& progress = {});

}  // namespace paging
