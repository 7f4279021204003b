// Makes maps in strips of rows, which survive an interruption.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "paging/planet/planet_file.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/map/map_request.h"
#include "vpe/base/shard.h"

namespace vpe::app {

// Holds the strips of a map: FILE.strips/ beside the file until it is complete. Their height follows from the map alone,
// so that runs with other memory or threads, and parts on other machines, use the same.
class MapMaker {
 public:
  // Throws UsageError for a map that is not possible, and std::runtime_error.
  MapMaker(std::shared_ptr<const paging::PlanetFile> planet, MapRequest request, std::filesystem::path output,
           const Common& common);

  const map::MapGrid& grid() const { return grid_; }

  // Makes the missing strips of a share. Strips of another map in the folder are
  // removed if the share is all of the work, else they are an error. Returns the number of strips that are still missing.
  // Throws Interrupted, paging::PlanetError, mars::SourceError and std::runtime_error.
  int make_strips(const base::Shard& shard);

  // Joins all strips to the file, and removes them. Returns the description of the map.
  nlohmann::json join();

 private:
  std::filesystem::path strip_path(int strip) const;
  std::filesystem::path ground_path(int strip) const;
  int strip_rows(int strip) const;
  std::string recipe() const;
  void claim_folder(const base::Shard& shard) const;

  std::shared_ptr<const paging::PlanetFile> planet_;
  MapRequest request_;
  std::filesystem::path output_;
  std::filesystem::path folder_;
  const Common& common_;
  mars::MapCrs crs_;
  map::MapGrid grid_;
  mars::RasterInfo info_;
  int rows_ = 0;  // of a strip but the last
  int strips_ = 0;
};

}  // namespace vpe::app
