// Writes a planet file: PATH.part while it grows, PATH once it is complete.
#pragma once

#include <memory>
#include <mutex>
#include <span>

#include "paging/codec.h"
#include "paging/planet_meta.h"
#include "paging/sqlite.h"

namespace paging {

// Members may be called from any thread; they take turns. Throws DatabaseError (disk full, ...); the name of the finished file only ever holds a complete one.
class PlanetWriter {
 public:
  explicit PlanetWriter(const std::string& path);
  ~PlanetWriter();  // removes the .part file unless publish() was reached

  void put_heights(const lod::TileKey& key, std::span<const std::uint8_t> packed);
  void put_missing(const lod::TileKey& key, std::span<const std::uint8_t> packed);
  void put_mesh(const lod::TileKey& key, int variant, std::span<const std::uint8_t> packed);
  void put_image(const lod::TileKey& key, std::span<const std::uint8_t> packed);
  void put_node(const NodeRow& row);

  // What put_heights stored.
  Bytes heights(const lod::TileKey& key);

  Bytes mesh(const lod::TileKey& key, int variant);

  // Writes meta (identity and program are filled in) and closes the .part file: it can be opened for reading,
  // nothing more can be put.
  void seal(PlanetMeta& meta);
  const std::string& part_path() const { return part_; }

  // After seal: writes meta again, syncs the file to disk and renames it to its final name.
  void publish(const PlanetMeta& meta);

 private:
  void put(Statement& statement, const lod::TileKey& key, std::span<const std::uint8_t> packed);
  void commit_now_and_then();
  Bytes read(Statement& statement, const lod::TileKey& key);
  std::string identity();

  std::mutex mutex_;
  std::string path_;
  std::string part_;
  std::unique_ptr<Database> db_;
  bool finished_ = false;
  std::size_t bytes_since_commit_ = 0;
  struct Statements;
  std::unique_ptr<Statements> sql_;
};

}  // namespace paging
