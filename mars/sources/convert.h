// From one vertical datum to another.
#pragma once

#include <memory>

#include "mars/sources/adjusted.h"
#include "mars/sources/source.h"

namespace mars {

// How a source's heights come into datum `to`. `areoid` gives the areoid's radii, or its heights above a sphere
// or an ellipsoid, and is needed when one of both datums is the areoid and the other is not; null when there is
// none. Where the areoid has no value the result has none. Rounding error <= 1e-8 m; between the areoid and
// anything else, the areoid's own. Without `adjust` when nothing is to be done. Throws SourceError: a datum is
// unknown, or the areoid is missing or of unknown datum.
struct Conversion {
  Adjust adjust;
  std::string treatment;
};
Conversion conversion(const SourceInfo& source, const VerticalDatum& to,
                      const std::shared_ptr<const ElevationSource>& areoid);

}  // namespace mars
