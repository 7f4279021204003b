// Converts heights from one vertical datum to another.
#pragma once

#include <memory>

#include "mars/sources/adjusted.h"
#include "mars/sources/source.h"

namespace mars {

struct Conversion {
  HeightAdjustment adjustment;  // empty if nothing is to be done
  std::string treatment;
};

// Returns the conversion of a source's heights to datum `to`. `areoid` gives the areoid's radii, or its heights
// above a sphere or an ellipsoid. It is needed if exactly one of the two datums is the areoid; else it may be
// null. Where the areoid is nodata, so is the result. The rounding error is at most 1e-8 m, plus the areoid's
// own error where it is used. Throws SourceError if a datum is unknown, or if the areoid is not given or of
// unknown datum.
Conversion conversion(const SourceInfo& source, const VerticalDatum& to,
                      const std::shared_ptr<const ElevationSource>& areoid);

}  // namespace mars
