// Areas in which each source of a planet decides the elevations.
//
// Typical usage:
//   const SourceCoverage coverage = source_coverage(planet, budget_bytes, pool);
//   const double share = coverage.sources.at(0).share;
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/base/parallel.h"

namespace vpe::app {

// Describes the ground of one source.
struct CoveredArea {
  double share = 0;     // of the sphere's area
  mars::LonLat middle;  // mean direction of it
};

inline constexpr std::int16_t kNoSource = -1;  // no data
inline constexpr std::int16_t kUnknownSource =
    -2;  // the file does not tell: tiles of several sources before format 1.3

// Holds a plain map, linear in longitude and latitude, row 0 at the north, column 0 at 180 degrees west.
struct SourceMap {
  int width = 0;
  int height = 0;
  std::vector<std::int16_t>
      source;  // of the post nearest to each pixel's middle: index, kNoSource or kUnknownSource
};

struct SourceCoverage {
  std::vector<CoveredArea> sources;  // by index into PlanetMeta::sources
  double nodata_share = 0;
  double unknown_share = 0;
  SourceMap map;
};

// Sums the area around each post of each finest tile, and makes a map. Shares add up to 1. Reads the sources of every finest
// tile, and its heights where posts have no data; keeps at most about `budget_bytes` of them. Does not depend on the number of
// threads. Throws paging::PlanetError.
SourceCoverage source_coverage(const std::shared_ptr<const paging::PlanetFile>& planet,
                               std::size_t budget_bytes, base::ThreadPool& pool,
                               const std::function<void(double)>& tell = {});

}  // namespace vpe::app
