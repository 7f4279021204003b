// RPC (rational polynomial coefficients) of a raster, and the heights on which they are evaluated.
#pragma once

#include <ogr_spatialref.h>

#include <memory>
#include <string>
#include <vector>

#include "mars/raster/placement/placement_options.h"

class GDALDataset;

namespace mars {

class MemoryFile;

struct RpcModel {
  std::vector<std::string> metadata;  // KEY=VALUE, as GDAL's domain RPC has them
  OGRSpatialReference crs;            // geographic, longitude first
  double height_m = 0;
  std::shared_ptr<const MemoryFile> dem;  // heights in degrees of the RPC; null: height_m counts everywhere
  std::string dem_name;
  std::vector<std::string> dem_files;
  std::vector<std::string> notes;

  // Returns the options of GDAL's transformer.
  std::vector<std::string> transformer_options() const;

  // Returns what it does, for planet files, which store it: it must not change.
  std::string treatment() const;
};

// Most posts of a DEM that are kept for an RPC (64 MiB). A finer one is sampled coarser.
inline constexpr double kMostRpcPosts = 16.0 * 1024 * 1024;

// Reads the RPC of a raster that has one. Its latitudes and longitudes count in PlacementOptions::rpc_crs, its heights
// from the surface of that system. A DEM is any elevation raster, sampled over the raster's box; RPCs do not know
// areoids, so a note tells if its heights count from one. Throws SourceError if a value is absent or no number, a
// system is unknown, not geographic or counts longitudes to the west, both a height and a DEM are given, or the DEM
// cannot be read, is of another body, has radii, or has no post there. Must be called inside a GdalScope.
RpcModel rpc_model(const std::string& path, GDALDataset& dataset, const PlacementOptions& options);

}  // namespace mars
