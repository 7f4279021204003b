// Sources of rasters that have no map, with options of how they are placed.
#pragma once

#include <memory>
#include <string>

#include "mars/raster/placement/placement_options.h"
#include "mars/sources/source.h"

namespace mars {

// Do the same as open_elevation() and open_image() of mars/sources/source.h, which have the default options. The options
// have no effect on rasters that have a map. SourceInfo::notes say how a raster was placed, with the residuals of its
// control points, and SourceInfo::files include those of a DEM. Throw SourceError.
std::shared_ptr<const ElevationSource> open_elevation(const std::string& path,
                                                      const PlacementOptions& placement);
std::shared_ptr<const ImageSource> open_image(const std::string& path, const PlacementOptions& placement);

}  // namespace mars
