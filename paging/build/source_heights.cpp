#include "paging/build/source_heights.h"

#include <cmath>
#include <limits>
#include <string>

#include "mars/geodesy/sphere.h"
#include "vpe/base/number.h"

namespace paging {

namespace {

using vpe::base::format_general;
using vpe::base::format_number;

[[noreturn]] void refuse_height(const glm::dvec3& direction, double height_m, const std::string& trouble,
                                const std::string& advice, const mars::ElevationSource& elevation) {
  int source = -1;
  elevation.origin({&direction, 1}, {&source, 1});
  const std::vector<mars::SourceInfo> infos = elevation.infos();
  if (source < 0 && infos.size() == 1) source = 0;
  const std::string name = source >= 0 ? infos.at(static_cast<std::size_t>(source)).name + ": " : "";
  const mars::LonLat at = mars::lon_lat(direction);
  throw UnusableSource(name + "the height at lon " + format_general(at.lon_deg, 10) + " lat " +
                       format_general(at.lat_deg, 10) + " is " + format_number(height_m) + " m, " + trouble +
                       "; " + advice);
}

}  // namespace

void check_heights(std::span<const glm::dvec3> directions, std::span<const double> heights_m,
                   const PlanetMeta& meta, const mars::ElevationSource& elevation) {
  const double most_m = std::numeric_limits<std::int32_t>::max() * meta.quantum_m;
  const double least_m = (kLeastRadius - 1) * meta.radius_m;
  for (std::size_t n = 0; n < heights_m.size(); ++n) {
    const double h = heights_m[n];
    if (!std::isfinite(h)) continue;
    if (h < least_m) {
      refuse_height(
          directions[n], h,
          "at or below the centre of a planet with a radius of " + format_number(meta.radius_m) + " m",
          "if it stands for nodata, mark it in the raster (gdal_edit.py -a_nodata); if the raster is "
          "of another body, name that (--body, --radius)",
          elevation);
    }
    if (std::abs(h) > most_m) {
      refuse_height(directions[n], h,
                    "which cannot be stored in steps of " + format_number(meta.quantum_m) + " m",
                    "mark such values as nodata in the raster (gdal_edit.py -a_nodata)", elevation);
    }
  }
}

void check_files(std::span<const mars::SourceInfo> sources) {
  for (const mars::SourceInfo& source : sources) {
    const std::string path = mars::changed_file(source.files);
    if (path.empty()) continue;
    throw UnusableSource(path +
                         ": has changed while the planet was built from it, which would have old and new " +
                         "values side by side; build again when the file is complete");
  }
}

}  // namespace paging
