// A file that holds one shard of a divided build, open for reading.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "paging/build/planet_writer.h"
#include "paging/build/shard_plan.h"
#include "paging/planet/planet_meta.h"
#include "paging/planet/sqlite.h"

namespace paging {

// Returns the summary of the shard that options.output holds if it is complete and undamaged, which is read whole for
// that, and its fingerprint is that of this build. `described` is describe_planet() of the same options and sources.
std::optional<BuildSummary> finished_shard(const BuildOptions& options, const PlanetMeta& described);

// Reads a shard. Used by one thread at a time. Members throw PlanetError when something is damaged; the message
// names file and tile.
//
// Typical usage:
//   ShardFile shard("mars.1-of-4.vpe");
//   for (const NodeRow& row : shard.nodes()) writer.put_tile(row, shard.payload(row));
class ShardFile {
 public:
  // Throws PlanetError for a file that does not exist, is of another kind, is a whole planet, or is damaged.
  explicit ShardFile(const std::string& path);

  const std::string& path() const { return path_; }
  const PlanetMeta& meta() const { return meta_; }  // `shard` is set
  const vpe::base::Shard& id() const { return meta_.shard->id; }
  // Returns the portable fingerprint (build_inputs.h) of the undivided build.
  const std::string& fingerprint() const { return fingerprint_; }

  std::vector<NodeRow> nodes() const;
  std::map<lod::TileKey, SharedAncestorTerms> shared_ancestors() const;
  TilePayload payload(const NodeRow& row);
  std::vector<TileResampling> resampling() const;
  std::vector<std::int64_t> image_keys() const;
  Bytes image(std::int64_t key);
  std::vector<LayerTileKey> layer_keys() const;
  Bytes layer_tile(const LayerTileKey& at);

 private:
  Bytes verified(Statement& statement, std::int64_t key, std::int64_t seed, const char* what) const;
  [[noreturn]] void damaged(const std::string& what) const;

  std::string path_;
  std::unique_ptr<Database> db_;
  PlanetMeta meta_;
  std::string fingerprint_;
  std::unique_ptr<Statement> heights_;
  std::unique_ptr<Statement> nodata_;
  std::unique_ptr<Statement> origin_;  // null in shards of format 1.2
  std::unique_ptr<Statement> mesh_;
  std::unique_ptr<Statement> image_;
  std::unique_ptr<Statement> layer_;  // null without image layers
};

}  // namespace paging
