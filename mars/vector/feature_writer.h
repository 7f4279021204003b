// Writes features as GeoJSON or GeoPackage.
#pragma once

#include <filesystem>

#include "mars/vector/feature.h"

namespace mars {

// Describes what a vector file says about its contents as a whole.
struct FeatureFileInfo {
  double radius_m = 0;      // of the planet's sphere
  std::string body;         // as "Mars"
  std::string description;  // datum, resolution, error: one text for people and programs
};

// Writes a layer to a new file, whose format its extension tells: .geojson, .json or .gpkg. Coordinates are degrees
// east and planetocentric degrees north on the planet's sphere, which GeoPackage names by its CRS and GeoJSON by its
// foreign member "crs". A partial file is removed. Throws SourceError with GDAL's own words, also for other extensions.
void write_features(const std::filesystem::path& path, const FeatureLayer& layer, const FeatureFileInfo& info);

}  // namespace mars
