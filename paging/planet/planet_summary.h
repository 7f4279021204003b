// What a build says of the planet when it ends, level by level; kept in the planet file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vpe/base/shard.h"

namespace paging {

struct ResamplingError {
  double max_m = 0;
  double rms_m = 0;
  std::int64_t posts = 0;  // how many of the sources' own posts were compared

  bool operator==(const ResamplingError&) const = default;
};

// Errors on their way to a ResamplingError. The sum of squares has no rounding beyond that of each error to
// 2^-20 m, so that it does not depend on order, threads or parts.
struct ResamplingSum {
  double max_m = 0;
  std::int64_t posts = 0;
  std::uint64_t high = 0;  // sum of squares = (high 2^64 + low) 2^-40 m^2
  std::uint64_t low = 0;

  void add(double deviation_m);  // 0 <= deviation_m; one beyond 2^22 m counts as that in the mean
  void include(const ResamplingSum& other);
  ResamplingError error() const;
  bool operator==(const ResamplingSum&) const = default;
};

struct LevelSummary {
  int level = 0;
  std::int64_t tiles = 0;
  std::int64_t leaf_tiles = 0;
  std::int64_t image_tiles = 0;
  std::int64_t bytes = 0;  // of heights, missing masks, meshes and images, compressed
  std::int64_t nodata_posts =
      0;                       // posts of finest tiles that no source has; a shared border counts in each tile
  ResamplingError resampling;  // over the source posts that lie in this level's finest tiles

  bool operator==(const LevelSummary&) const = default;
};

// What a file says that holds one part of a divided build.
struct ShardMeta {
  vpe::base::Shard part;
  double mesh_ratio = 0;                  // BuildOptions::mesh_ratio, for the tiles that joining makes
  std::vector<ResamplingSum> resampling;  // by level, from 0 on

  bool operator==(const ShardMeta&) const;
};

struct PlanetMeta;

// PlanetMeta::resampling and that of its levels, from sums by level.
void set_resampling(PlanetMeta& meta, const std::vector<ResamplingSum>& by_level);

// As text of JSON, and back; from_text throws nlohmann::json::exception.
std::string to_text(const std::vector<LevelSummary>& levels);
std::string to_text(const ShardMeta& share);
std::vector<LevelSummary> levels_from_text(const std::string& text);
ShardMeta shard_from_text(const std::string& text);

}  // namespace paging
