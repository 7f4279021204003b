#include "mars/sources/convert.h"

#include <vector>

#include "mars/sources/adjusted.h"

namespace mars {
namespace {

// Sets `radii` to the radii of the areoid at directions.
void areoid_radii(const ElevationSource& areoid, const VerticalDatum& datum,
                  std::span<const glm::dvec3> directions, std::vector<double>& radii) {
  radii.resize(directions.size());
  areoid.sample(directions, 0, radii);
  for (std::size_t i = 0; i < radii.size(); ++i) radii[i] = radius_at(datum, directions[i], radii[i]);
}

}  // namespace

Conversion conversion(const SourceInfo& info, const VerticalDatum& to,
                      const std::shared_ptr<const ElevationSource>& areoid) {
  const VerticalDatum from = info.datum;
  if (from == to) return {};
  if (!from.is_known() || !to.is_known()) {
    throw SourceError(info.name + ": its vertical datum is not known, so it cannot be converted to '" +
                      to_string(to) + "'; name it (--datum)");
  }
  VerticalDatum areoid_datum;
  std::string through;
  if (from.kind == DatumKind::kAreoid || to.kind == DatumKind::kAreoid) {
    if (areoid == nullptr) {
      throw SourceError(info.name + ": converting its heights from '" + to_string(from) + "' to '" +
                        to_string(to) + "' needs a raster of the areoid; give one, e.g. MOLA's MEGA product " +
                        "(--areoid FILE)");
    }
    const SourceInfo grid = areoid->infos().front();
    areoid_datum = grid.datum;
    if (!areoid_datum.is_geometric()) {
      throw SourceError(grid.name +
                        ": a raster of the areoid must give radii, or heights above a sphere or an " +
                        "ellipsoid, but its datum is '" + to_string(areoid_datum) + "'; name it (--datum)");
    }
    through = " through " + grid.name + " (" + std::to_string(grid.size_bytes) + " bytes of " +
              std::to_string(grid.mtime_s) + ")";
  }
  Conversion made;
  made.adjustment = [from, to, areoid, areoid_datum](std::span<const glm::dvec3> directions,
                                                     std::span<double> heights_m) {
    std::vector<double> base;
    if (areoid_datum.is_known()) areoid_radii(*areoid, areoid_datum, directions, base);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const double radius = from.kind == DatumKind::kAreoid ? base[i] + heights_m[i]
                                                            : radius_at(from, directions[i], heights_m[i]);
      heights_m[i] = to.kind == DatumKind::kAreoid ? radius - base[i] : height_at(to, directions[i], radius);
    }
  };
  made.treatment = "converted from " + to_string(from) + " to " + to_string(to) + through;
  return made;
}

}  // namespace mars
