// Checks a planet file: that it is what its builder wrote, and that what it states of itself is true.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"

namespace paging {

struct VerifyOptions {
  int threads = 0;  // 0 = all cores
  // This many finest tiles, evenly strewn, are measured again: their own meshes and those of all their
  // ancestors against S, which must stay within the stated errors. 0 = none.
  std::size_t deep_tiles = 0;
};

struct Problem {
  std::string where;  // a tile ("+x/4/3/12"), or a table of the file
  std::string what;
};

struct VerifyReport {
  std::vector<Problem> problems;  // of the file as a whole, then by tile
  std::int64_t tiles = 0;         // checked: posts, range, slope, posts shared with children
  std::int64_t meshes = 0;        // triangles, cover, vertices on posts
  std::int64_t borders = 0;       // between two tiles: equal posts, equal vertices of meshes
  std::int64_t images = 0;
  std::int64_t measured = 0;  // pairs of a mesh and a finest tile
  // The largest share of a stated error that was found, of those measured: near 1 means that bounds are tight.
  double largest_share = 0;
};

// Called with the fraction done, from worker threads, one at a time. May throw to stop.
using VerifyProgress = std::function<void(double fraction)>;

// Reads everything: checksums, codecs, the database's own structure, that errors nest (checked when it was
// opened), that posts and meshes of neighbours and of parents agree to the bit. A damaged tile is a problem,
// not an exception. Throws only what progress() throws.
VerifyReport verify(const PlanetFile& planet, const VerifyOptions& options,
                    const VerifyProgress& progress = {});

}  // namespace paging
