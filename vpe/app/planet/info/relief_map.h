// The shaded map of a planet on its page.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/app/planet/info/source_coverage.h"
#include "vpe/base/parallel.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/report/page.h"

namespace vpe::app {

// Says how a map is coloured.
struct ReliefLook {
  double low_m = 0;  // elevations at the palette's ends, low < high
  double high_m = 1;
  double exaggeration = 1;  // of the relief that light falls on
};

// Returns a PNG of the whole planet, linear in longitude and latitude, from 180 degrees west, lit from the north-west at 45
// degrees. Nodata ground has grey stripes. The map is as large as fits `most_bytes`, at most 1440 x 720 pixels. Keeps at
// most about `budget_bytes` of tiles. Does not depend on the pool. Throws paging::PlanetError.
std::vector<std::uint8_t> relief_png(const std::shared_ptr<const paging::PlanetFile>& planet,
                                     const ReliefLook& look, std::size_t most_bytes, std::size_t budget_bytes,
                                     base::ThreadPool& pool);

// Returns the figure of that map: graticule, outlines of the sources that cover a part of it, their numbers at their middles,
// and a legend of elevations.
report::Figure relief_figure(const std::vector<std::uint8_t>& png, const ReliefLook& look,
                             const SourceCoverage& coverage);

// Returns the figure of the map of sources: a colour for each, with a legend of numbers, names and shares.
report::Figure coverage_figure(const SourceCoverage& coverage, const std::vector<std::string>& names);

// Returns the CSS that both figures need.
std::string map_style();

}  // namespace vpe::app
