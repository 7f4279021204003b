#include "panorama/viewer/pixel_probe.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "panorama/viewer/render_view.h"

namespace panorama {

namespace {

std::vector<std::string> band_names(const std::string& layer, std::size_t bands) {
  if (layer == "range" && bands == 1) return {"range_m"};
  if (layer == "elevation" && bands == 1) return {"elevation_m"};
  if (layer == "lonlat" && bands == 2) return {"lon_deg", "lat_deg"};
  if ((layer == "slope" || layer == "incidence") && bands == 1) return {layer + "_deg"};
  std::vector<std::string> names;
  for (std::size_t band = 0; band < bands; ++band)
    names.push_back(bands == 1 ? layer : layer + "_" + std::to_string(band + 1));
  return names;
}

}  // namespace

PixelProbe::PixelProbe(const PanoramaDescription& description) : map_(description.map) {
  for (const PlaneName& name : description.planes) {
    layers_.push_back(
        {name.name, RasterPlane(description.image.parent_path() / name.file, map_.width_px, map_.height_px)});
  }
}

std::optional<ProbeResult> PixelProbe::at_pixel(double x, double y) const {
  const bool inside = x >= 0.0 && y >= 0.0 && x <= static_cast<double>(map_.width_px) &&
                      y <= static_cast<double>(map_.height_px);
  if (!inside) return std::nullopt;
  return probe(x, y);
}

std::optional<ProbeResult> PixelProbe::at(const Direction& direction) const {
  const auto shown = shown_place(map_, direction);
  if (!shown) return std::nullopt;
  // An image may be narrower than a full circle by a part of a pixel; the last column is then the nearest.
  return probe(std::min(shown->x, static_cast<double>(map_.width_px)), shown->y);
}

ProbeResult PixelProbe::probe(double x, double y) const {
  ProbeResult result{x, y, map_.to_direction(x, y), {}};
  const auto column = std::clamp<std::int64_t>(static_cast<std::int64_t>(x), 0, map_.width_px - 1);
  const auto row = std::clamp<std::int64_t>(static_cast<std::int64_t>(y), 0, map_.height_px - 1);
  for (const Layer& layer : layers_) {
    const std::vector<double> values = layer.raster.at(column, row);
    std::vector<std::string> names = band_names(layer.name, values.size());
    for (std::size_t n = 0; n < values.size(); ++n) {
      const bool known = std::isfinite(values[n]);
      result.values.push_back({std::move(names[n]), known ? std::optional(values[n]) : std::nullopt});
    }
  }
  return result;
}

}  // namespace panorama
