// A file that holds one part of a divided build, open for reading.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "paging/build/planet_writer.h"
#include "paging/build/shard_plan.h"
#include "paging/planet/planet_meta.h"
#include "paging/planet/sqlite.h"

namespace paging {

// Used by one thread at a time. Members throw PlanetError when something is damaged, naming file and tile.
class ShardFile {
 public:
  // Throws PlanetError for a missing file, another kind of file, a whole planet, a damaged part.
  explicit ShardFile(const std::string& path);

  const std::string& path() const { return path_; }
  const PlanetMeta& meta() const { return meta_; }  // with share
  const vpe::base::Shard& part() const { return meta_.share->part; }
  const std::string& fingerprint() const {
    return fingerprint_;
  }  // without the line that says which part it is

  std::vector<NodeRow> nodes() const;
  std::map<lod::TileKey, SharedAncestorTerms> above() const;
  TilePayload payload(const NodeRow& row);
  std::vector<std::int64_t> image_keys() const;
  Bytes image(std::int64_t key);

 private:
  Bytes verified(Statement& statement, std::int64_t key, std::int64_t seed, const char* what) const;
  [[noreturn]] void damaged(const std::string& what) const;

  std::string path_;
  std::unique_ptr<Database> db_;
  PlanetMeta meta_;
  std::string fingerprint_;
  std::unique_ptr<Statement> heights_;
  std::unique_ptr<Statement> nodata_;
  std::unique_ptr<Statement> mesh_;
  std::unique_ptr<Statement> image_;
};

}  // namespace paging
