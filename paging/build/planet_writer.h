// Writes a planet file: PATH.part while it grows, PATH once it is complete.
//
// A build that was stopped or killed leaves PATH.part with whole tiles; the next writer with the same recipe
// continues it. Every transaction ends between two tiles, so what is there is complete whenever the process
// died; when the machine died, all but the last second or so is.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>

#include "paging/build/partial_planet_file.h"
#include "paging/planet/codec.h"
#include "paging/planet/planet_meta.h"

namespace paging {

// All that the file holds of a tile.
struct TilePayload {
  Bytes heights;
  Bytes nodata;               // empty: no post is missing
  std::vector<Bytes> meshes;  // by variant
};

// Members may be called from any thread; they take turns. Throws DatabaseError (disk full, another build at
// work on the same file, ...); after the first one that a put_ or replace_ throws, all of them throw the same.
// The name of the finished file only ever holds a complete one.
class PlanetWriter {
 public:
  // recipe: everything that the content is a function of, as text; two builds with equal recipes make equal
  // tiles. commit_s: how often finished tiles are made safe.
  PlanetWriter(const std::string& path, const std::string& fingerprint, double commit_s = 1.0);
  ~PlanetWriter();  // unless publish() was reached, keeps the .part file; removes it when it holds no work
  PlanetWriter(const PlanetWriter&) = delete;
  PlanetWriter& operator=(const PlanetWriter&) = delete;

  PartialFileStart start() const { return part_.start; }

  // What earlier builds left, at the time of asking.
  std::vector<NodeRow> nodes();
  std::set<std::int64_t> image_keys();
  std::map<std::int64_t, Bytes> checkpoints();
  std::vector<LevelSummary> levels(std::size_t posts);  // summarize_levels

  // Each is stored whole or not at all.
  void put_tile(const NodeRow& row, const TilePayload& payload);
  void put_image(const lod::TileKey& key, std::span<const std::uint8_t> packed);
  // A result on the way to the finished file, by number; replaces an earlier one. Dropped by publish(), but
  // that with a number below 0 stays in a file with PlanetMeta::share.
  void put_checkpoint(std::int64_t number, std::span<const std::uint8_t> packed);
  // Replaces rows of the tile index, all or none.
  void replace_nodes(std::span<const NodeRow> rows);

  // What put_tile stored. Throws DatabaseError also when it is damaged.
  Bytes heights(const lod::TileKey& key);
  Bytes nodata(const lod::TileKey& key);  // empty: no post is missing
  Bytes mesh(const lod::TileKey& key, int variant);

  // Writes meta (identity and program are filled in) and closes the .part file: it can be opened for reading,
  // nothing more can be put.
  void seal(PlanetMeta& meta);
  const std::string& part_path() const { return part_path_; }

  // After seal: writes meta again, syncs the file to disk and renames it to its final name.
  void publish(const PlanetMeta& meta);

 private:
  struct Statements;

  template <typename Puts>
  void write(const Puts& puts);
  void put(Statement& statement, std::int64_t row, std::span<const std::uint8_t> packed);
  void put_node(const NodeRow& row);
  void commit_when_due();
  std::optional<Bytes> find(Statement& statement, const lod::TileKey& key, std::int64_t seed);
  Bytes read(Statement& statement, const lod::TileKey& key, std::int64_t seed);

  std::mutex mutex_;
  std::string path_;
  std::string part_path_;
  std::chrono::duration<double> commit_every_;
  std::chrono::steady_clock::time_point last_commit_ = std::chrono::steady_clock::now();
  PartialPlanetFile part_;
  bool uncommitted_ = false;               // there is work since the last commit
  std::unique_ptr<DatabaseError> broken_;  // the first error of writing
  bool finished_ = false;
  std::unique_ptr<Statements> sql_;
};

}  // namespace paging
