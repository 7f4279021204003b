// Writes a planet file: PATH.part while it grows, PATH once it is complete.
//
// A build that was stopped or killed leaves PATH.part with whole tiles; the next writer with the same
// fingerprint continues it. Every transaction ends between two tiles, so all stored tiles are complete
// whenever the process dies. When the machine dies, only the last second or so is lost.
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
#include "paging/planet/tile_payload.h"
#include "paging/planet/tile_sources.h"
#include "paging/planet/tile_store.h"

namespace paging {

// Writes and reads back the tiles of a build. Members may be called from any thread; a lock lets one run at a
// time. They throw DatabaseError (disk full, another build writes the same file, ...). After the first error
// of a put_ or replace_ member, all of them throw the same error. A file with the final name is always
// complete.
//
// Typical usage:
//   PlanetWriter writer(path, fingerprint);
//   for (const NodeRow& row : writer.nodes()) skip(row.key);  // of an earlier build
//   writer.put_tile(row, payload);
//   writer.seal(meta);
//   writer.publish(meta);
class PlanetWriter : public TileStore {
 public:
  // `fingerprint` is everything that the content is a function of, as text: two builds with equal fingerprints
  // make equal tiles. `commit_s` is the time between commits: a build that is killed loses less when it is
  // smaller, and writes faster when it is larger.
  //
  // With `patch`, a new file begins with the kept tiles of a finished planet file.
  PlanetWriter(const std::string& path, const std::string& fingerprint, double commit_s = 1.0,
               const PatchStart* patch = nullptr);
  // Without publish(), keeps the .part file, or removes it when it holds no tiles or after discard().
  ~PlanetWriter() override;
  PlanetWriter(const PlanetWriter&) = delete;
  PlanetWriter& operator=(const PlanetWriter&) = delete;

  PartialFileStart start() const { return partial_.start; }

  // Return what the file holds now, which at first is what earlier builds left.
  std::vector<NodeRow> nodes();
  std::set<std::int64_t> image_keys();
  std::map<std::int64_t, Bytes> checkpoints();
  std::vector<LevelSummary> levels(std::size_t posts);  // as summarize_levels()
  std::set<LayerTileKey> layer_keys();
  // Sets level, number and bytes of the tiles of each layer.
  void count_layers(std::vector<ImageLayer>& layers);

  // Store a tile or image tile, whole or not at all.
  void put_tile(const NodeRow& row, const TilePayload& payload) override;
  void put_image(const lod::TileKey& key, std::span<const std::uint8_t> packed);
  // Stores a tile of an image layer. begin_layers() makes the table, if it is not there yet.
  void begin_layers();
  void put_layer_tile(const LayerTileKey& key, std::span<const std::uint8_t> packed);
  // Stores an intermediate result by number; replaces an earlier one. publish() drops checkpoints, except that
  // a shard keeps those with numbers below 0.
  void put_checkpoint(std::int64_t number, std::span<const std::uint8_t> packed);
  // Stores or replaces resampling errors of tiles, all of them or none.
  void put_resampling(std::span<const TileResampling> rows);
  std::vector<TileResampling> resampling();  // in order of key and source
  // Replaces rows of the tile index, all of them or none.
  void replace_nodes(std::span<const NodeRow> rows);

  // Read back what put_tile() stored. Throw DatabaseError also when it is damaged.
  Bytes heights(const lod::TileKey& key) override;
  Bytes nodata(const lod::TileKey& key) override;
  Bytes mesh(const lod::TileKey& key, int variant) override;

  // Fills in identity and program, writes meta and closes the .part file. After that it can be opened for
  // reading, and nothing more can be stored.
  void seal(PlanetMeta& meta);
  const std::string& part_path() const { return part_path_; }

  // Finishes after seal(): writes meta again, syncs the file to disk and renames it to its final name.
  void publish(const PlanetMeta& meta);

  // Lets the destructor remove the .part file, because no later build can use it.
  void discard() { discarded_ = true; }

 private:
  struct Statements;

  template <typename Puts>
  void write(const Puts& puts);
  void put(Statement& statement, std::int64_t row, std::span<const std::uint8_t> packed);
  void put_node(const NodeRow& row);
  void commit_when_due();
  void commit();
  void renumber_sources(const PatchStart& patch);
  void put_row(const TileResampling& row);
  std::optional<Bytes> find(Statement& statement, const lod::TileKey& key, std::int64_t seed);
  Bytes read(Statement& statement, const lod::TileKey& key, std::int64_t seed);

  std::mutex mutex_;
  std::string path_;
  std::string part_path_;
  std::chrono::duration<double> commit_every_;
  std::chrono::steady_clock::time_point last_commit_ = std::chrono::steady_clock::now();
  PartialPlanetFile partial_;
  bool uncommitted_ = false;               // something was written since the last commit
  std::unique_ptr<DatabaseError> broken_;  // the first error of writing
  bool finished_ = false;
  bool discarded_ = false;
  std::unique_ptr<Statements> sql_;
};

}  // namespace paging
