// What a panorama shows at a place of its image or in a direction, with the values of its planes there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "panorama/image/raster_plane.h"
#include "panorama/metadata/open_panorama.h"

namespace panorama {

// A band of a plane. Bands whose meaning is known have names with units: "range_m", "lon_deg", "lat_deg",
// "elevation_m", "slope_deg", "incidence_deg"; others the plane's, with _1, _2 ... where it has several.
struct PlaneValue {
  std::string name;
  std::optional<double> value;  // nothing where the plane has none, as for the sky
};

struct ProbeResult {
  double x = 0;  // of the image (of one eye's in a pair), pixel centres at +0.5
  double y = 0;
  Direction direction;
  std::vector<PlaneValue> values;  // in the order of the planes
};

// All const members may be called from any number of threads.
class PixelProbe {
 public:
  // Opens the planes. Throws vpe::base::FileError when one cannot be used.
  explicit PixelProbe(const PanoramaDescription& description);

  // Nothing where the image shows nothing. Read a tile of each plane and throw vpe::base::FileError.
  std::optional<ProbeResult> at(const Direction& direction) const;
  std::optional<ProbeResult> at_pixel(double x, double y) const;

 private:
  struct Plane {
    std::string name;
    RasterPlane raster;
  };
  ProbeResult read(double x, double y) const;

  PanoramaMap map_;
  std::vector<Plane> planes_;
};

}  // namespace panorama
