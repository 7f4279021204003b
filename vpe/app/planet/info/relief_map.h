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

// Holds PNGs of the whole planet and of its poles.
struct ReliefImages {
  std::vector<std::uint8_t> whole;  // linear in longitude and latitude, from 180 degrees west
  std::vector<std::uint8_t> north;  // polar_map.h
  std::vector<std::uint8_t> south;
};

// Limits the sizes of PNGs.
struct ReliefLimits {
  std::size_t whole_bytes = 600'000;  // a third more as text
  std::size_t inset_bytes = 80'000;   // of each
};

// Returns maps of a planet, lit from their upper left, at 45 degrees. Nodata ground has grey stripes. Maps are as large as fits
// the limits, at most 1440 x 720 and 440 x 440 pixels. Keeps at most about `budget_bytes` of tiles. Does not depend on the pool.
// Throws paging::PlanetError.
ReliefImages relief_images(const std::shared_ptr<const paging::PlanetFile>& planet, const ReliefLook& look,
                           const ReliefLimits& limits, std::size_t budget_bytes, base::ThreadPool& pool);

// Returns the figure of the map of the whole planet: graticule, outlines of the sources that cover a part of it, their numbers at
// their middles, and a legend of elevations.
report::Figure relief_figure(const std::vector<std::uint8_t>& png, const ReliefLook& look,
                             const SourceCoverage& coverage);

// Returns the figure of the maps of both poles, with graticules and the numbers of sources whose middles they show.
report::Figure polar_figure(const ReliefImages& images, const SourceCoverage& coverage);

// Returns the figure of the map of sources: a colour for each, with a legend of numbers, names and shares.
report::Figure coverage_figure(const SourceCoverage& coverage, const std::vector<std::string>& names);

// Returns the CSS that both figures need.
std::string map_style();

}  // namespace vpe::app
