// Coarse, conservative extent of a raster on the planet.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "mars/raster/gdal_georeference.h"
#include "mars/sources/source.h"

namespace mars {

// States what a part of a raster holds as far as its file tells without being read.
enum class Coverage { kNone, kSome, kAll };

// Returns windows outside of which the raster has no data, in the order of rows and columns of a coarse grid. They
// do not overlap. `coverage` is asked some thousand times at most. Returns the whole raster as one window unless
// parts can be left out, and no window if there is no data.
std::vector<PixelWindow> data_windows(const PixelGrid& grid,
                                      const std::function<Coverage(const PixelWindow&)>& coverage);

// Returns true if a window shares pixels with any of `windows`.
bool overlaps(const std::vector<PixelWindow>& windows, const PixelWindow& window);

class Footprint {
 public:
  // Divides the raster into parts and encloses what these have of the windows in a cap each, and in one for each
  // window.
  Footprint(const Georeference& georeference, const std::vector<PixelWindow>& windows);

  bool is_empty() const { return areas_.empty(); }

  // Returns true if the cap may contain a place of the windows, false only if it contains none.
  bool touches(const Cap& cap) const;

 private:
  struct Area {
    Cap cap;
    std::vector<Cap> windows;  // if these are smaller than the area
  };

  std::vector<Area> areas_;
  Cap whole_;
};

}  // namespace mars
