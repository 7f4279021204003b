// Figures of a whole planet and of its levels, as a build computes them and the planet file keeps them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "vpe/base/shard.h"

namespace paging {

// Describes how far the reference surface lies from the sources' own posts.
struct ResamplingError {
  double max_m = 0;
  double rms_m = 0;
  std::int64_t posts = 0;  // number of source posts that were compared

  bool operator==(const ResamplingError&) const = default;
};

// Accumulates a ResamplingError. The sum of squares has no rounding except that of each error to 2^-20 m, so
// the result does not depend on order, threads or shards.
struct ResamplingSum {
  double max_m = 0;
  std::int64_t posts = 0;
  std::uint64_t high = 0;  // sum of squares = (high 2^64 + low) 2^-40 m^2
  std::uint64_t low = 0;

  // Adds one error, 0 <= deviation_m. In the mean, an error above 2^22 m counts as 2^22 m.
  void add(double deviation_m);
  void include(const ResamplingSum& other);
  ResamplingError error() const;
  bool operator==(const ResamplingSum&) const = default;
};

// Returns a sum with this error, to 1e-12 of its mean square.
ResamplingSum sum_of(const ResamplingError& error);

// Sums of resampling errors by level and by index into PlanetMeta::sources; the index is -1 in shards of builders
// before revision 6, which did not tell sources apart.
using ResamplingSums = std::map<std::pair<int, int>, ResamplingSum>;

// Describes the resampling error at the posts of one source.
struct SourceResampling {
  int source = 0;  // index into PlanetMeta::sources
  ResamplingError error;

  bool operator==(const SourceResampling&) const = default;
};

// Describes the tiles of one level.
struct LevelSummary {
  int level = 0;
  std::int64_t tiles = 0;
  std::int64_t leaf_tiles = 0;
  std::int64_t image_tiles = 0;
  std::int64_t bytes = 0;         // of heights, nodata masks, meshes and images, compressed
  std::int64_t nodata_posts = 0;  // of finest tiles; a post on a shared border counts in each tile
  ResamplingError resampling;     // over the source posts that lie in this level's finest tiles
  std::vector<SourceResampling> resampling_by_source;  // the same by source; empty before format 1.3

  bool operator==(const LevelSummary&) const = default;
};

// Describes a file that holds one shard of a divided build. Kept as `part` in the table `meta`.
struct ShardMeta {
  vpe::base::Shard id;    // which of how many
  double mesh_ratio = 0;  // BuildOptions::mesh_ratio, for the tiles that merging makes
  ResamplingSums resampling;

  bool operator==(const ShardMeta&) const;
};

struct PlanetMeta;

// Sets PlanetMeta::resampling and that of its levels.
void set_resampling(PlanetMeta& meta, const ResamplingSums& sums);

// Converts to JSON text.
std::string to_text(const std::vector<LevelSummary>& levels);
std::string to_text(const ShardMeta& shard);
// Converts JSON text back. Throws nlohmann::json::exception.
std::vector<LevelSummary> levels_from_text(const std::string& text);
ShardMeta shard_from_text(const std::string& text);

}  // namespace paging
