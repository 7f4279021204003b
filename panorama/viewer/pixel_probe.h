// Queries of single pixels: the direction that a panorama shows there, and the values of its auxiliary layers.
//
// Typical usage:
//   const PixelProbe probe(describe(path));
//   if (const auto result = probe.at({azimuth_deg, elevation_deg})) use(result->values);
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "panorama/image/raster_plane.h"
#include "panorama/metadata/open_panorama.h"

namespace panorama {

// Holds the value of one band of a layer. Bands whose meaning is known have names with units: "range_m",
// "lon_deg", "lat_deg", "elevation_m", "slope_deg", "incidence_deg"; others have the layer's name, with _1, _2
// ... where it has several bands.
struct PlaneValue {
  std::string name;
  std::optional<double> value;  // absent where the layer has none, as for the sky
};

struct ProbeResult {
  double x = 0;  // of the image (of one eye's in a pair), pixel centres at +0.5
  double y = 0;
  Direction direction;
  std::vector<PlaneValue> values;  // in the order of the layers
};

// Reads layers of one panorama. All const members may be called from any number of threads.
class PixelProbe {
 public:
  // Opens the layers. Throws vpe::base::FileError when one cannot be used.
  explicit PixelProbe(const PanoramaDescription& description);

  // Probe a direction, or a place in the image. Return nullopt where the image shows nothing. Read one tile of
  // each layer and throw vpe::base::FileError.
  std::optional<ProbeResult> at(const Direction& direction) const;
  std::optional<ProbeResult> at_pixel(double x, double y) const;

 private:
  struct Layer {
    std::string name;
    RasterPlane raster;
  };
  ProbeResult probe(double x, double y) const;

  PanoramaMap map_;
  std::vector<Layer> layers_;
};

}  // namespace panorama
