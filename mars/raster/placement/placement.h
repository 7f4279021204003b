// Rasters without a map: placed by ground control points or an RPC, and warped in memory onto a map.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/raster/placement/control_points.h"
#include "mars/raster/placement/ground_grid.h"
#include "mars/raster/placement/placement_options.h"
#include "mars/raster/placement/rpc_model.h"

class GDALDataset;

namespace mars {

// Any number of threads may call const members at once.
//
// Typical usage:
//   if (const auto placement = find_placement(path, *dataset, {}, false)) dataset = placement->warp(std::move(dataset));
class Placement {
 public:
  using Pointer = GdalPool<GDALDataset>::Pointer;

  // Places a raster that has control points or an RPC, see find_placement().
  Placement(const std::string& path, GDALDataset& dataset, const PlacementOptions& options,
            bool has_special_values);

  // Returns a virtual raster that reads `source`, which must be a handle of the raster, and owns it. Its map has the
  // coordinate system of the control points or of the RPC; nothing is transformed between systems. Pixels are
  // interpolated bilinearly, or taken from the nearest one where values are no numbers: palettes, special values.
  // Outside of the raster it has no data: an alpha band in bytes and words, NaN in all other types, which become
  // floating point so that interpolated values are not rounded. Throws SourceError.
  Pointer warp(Pointer source) const;

  // Returns sentences for the user, without the file's name.
  const std::vector<std::string>& notes() const { return notes_; }

  // Returns the text for planet files, which store it: it must not change.
  const std::string& treatment() const { return treatment_; }

  // Returns the files that it reads besides those of the raster.
  const std::vector<std::string>& files() const { return files_; }

 private:
  Pointer with_points(GDALDataset& source) const;

  std::string path_;
  std::optional<ControlPoints> points_;
  std::optional<RpcModel> rpc_;
  std::vector<std::string> options_;  // of GDAL's transformer
  GroundGrid grid_;
  bool is_nearest_ = false;
  std::string treatment_;
  std::vector<std::string> notes_;
  std::vector<std::string> files_;
};

// Returns how a raster without a map is placed, or null if it has neither control points nor an RPC. An RPC counts
// before control points unless `options` has a method for these. `has_special_values`: stored values other than GDAL's
// one nodata value mean nodata. Throws SourceError if they do not place it. Must be called inside a GdalScope.
std::shared_ptr<const Placement> find_placement(const std::string& path, GDALDataset& dataset,
                                                const PlacementOptions& options, bool has_special_values);

}  // namespace mars
