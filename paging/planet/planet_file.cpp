#include "paging/planet/planet_file.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "paging/planet/check_meta.h"
#include "paging/planet/planet_database.h"
#include "vpe/base/file.h"
#include "vpe/core/image/image.h"

namespace paging {

namespace {

constexpr int kTexelsPerSide = kImageIntervals + 1;
constexpr int kReadTries = 20;

std::string damaged(const std::string& path, const lod::TileKey& key, const std::string& what) {
  return path + ": tile " + lod::to_string(key) + " is damaged (" + what + "); build the planet file again";
}

PlanetError replaced(const std::string& path) {
  return PlanetError(
      path + ": another planet file was written there while this one was in use; run the command again");
}

}  // namespace

// Holds a read connection with its prepared statements.
struct PlanetFile::Connection {
  explicit Connection(const PlanetFile& planet)
      : stamp(vpe::base::file_stamp(planet.path())),
        db(planet.connect()),
        heights(db, "SELECT checksum, data FROM heights WHERE key = ?"),
        nodata(db, "SELECT checksum, data FROM missing WHERE key = ?"),
        node(db, "SELECT steps, sources FROM node WHERE key = ?"),
        mesh(db, "SELECT checksum, data FROM mesh WHERE key = ? AND variant = ?"),
        image(db, "SELECT checksum, data FROM image WHERE key = ?") {}

  void reset() {
    for (Statement* statement : {&heights, &nodata, &node, &mesh, &image}) statement->reset();
  }

  // Returns false if the file was written to since the connection was opened. Pages that SQLite keeps may then
  // be of the former content. A file that another one has replaced stays as it was.
  bool is_current() const {
    const auto now = vpe::base::file_stamp(db.path());
    return !stamp || !now || !now->is_same_file(*stamp) || *now == *stamp;
  }

  std::optional<vpe::base::FileStamp> stamp;  // taken before the file is opened
  Database db;
  Statement heights;
  Statement nodata;
  Statement node;
  Statement mesh;
  Statement image;
};

namespace {

// Returns the blob of the row that `statement` is bound to after verifying its checksum, or nullopt when there
// is no such row.
std::optional<Bytes> verified(Statement& statement, std::int64_t row, const std::string& path,
                              const lod::TileKey& key, const char* what) {
  if (!statement.step()) return std::nullopt;
  const std::span<const std::uint8_t> data = statement.blob(1);
  if (checksum(row, data) != statement.integer(0)) {
    throw PlanetError(damaged(path, key, std::string(what) + ": wrong checksum"));
  }
  return Bytes(data.begin(), data.end());
}

}  // namespace

std::shared_ptr<const PlanetFile> PlanetFile::open(const std::string& path) {
  return std::shared_ptr<const PlanetFile>(new PlanetFile(path));
}

PlanetFile::~PlanetFile() = default;

PlanetFile::PlanetFile(const std::string& path)
    : path_(path),
      connections_([this] { return std::make_unique<Connection>(*this); },
                   {.reset = [](Connection& connection) { connection.reset(); }}) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw PlanetError(path + ": no such planet file; make one with 'vpe build DEM -o " + path + "'");
  }
  if (std::filesystem::is_regular_file(path, error) && ::access(path.c_str(), R_OK) != 0) {
    throw PlanetError(path + ": cannot open: " + std::strerror(errno) + "; it must be readable (chmod u+r)");
  }
  try {
    const Database db = open_planet_database(path);
    const std::map<std::string, std::string> rows = read_meta_rows(db);
    meta_ = from_rows(rows, path);
    meta_checksum_ = rows.at(kMetaChecksumKey);
    if (meta_.shard) {
      const std::string of = std::to_string(meta_.shard->id.of);
      throw PlanetError(path + ": part " + std::to_string(meta_.shard->id.number) + " of " + of +
                        " of a planet; join all " + of + " with 'vpe merge PART... -o PLANET.vpe'");
    }
    read_index(connect());
  } catch (const DatabaseError& e) {
    throw PlanetError(std::string(e.what()) + "; not a planet file, or damaged: build it again");
  }
}

Database PlanetFile::connect() const {
  Database db = open_planet_database(path_);
  Statement sum(db, "SELECT value FROM meta WHERE key = ?");
  if (!sum.bind(1, std::string_view(kMetaChecksumKey)).step() || sum.text(0) != meta_checksum_)
    throw replaced(path_);
  return db;
}

template <class Read>
auto PlanetFile::read(const Read& fetch) const {
  for (int n = 0; n < kReadTries; ++n) {
    auto connection = connections_.acquire();
    auto result = fetch(*connection);
    if (connection->is_current()) return result;
    connection.discard();
  }
  throw replaced(path_);
}

void PlanetFile::read_index(const Database& db) {
  const auto damage = [this](const std::string& what) {
    return PlanetError(path_ + ": damaged: " + what + "; build the planet file again");
  };
  std::vector<NodeRow> rows;
  const auto bad = read_nodes(db, rows);
  if (bad) throw damage("the tile index is wrong at row " + std::to_string(*bad));
  std::vector<lod::TileInfo> tiles;
  tiles.reserve(rows.size());
  for (NodeRow& row : rows) {
    const std::vector<int> sources = *source_indices(row.sources);
    if (!sources.empty() && std::ranges::max(sources) >= static_cast<int>(meta_.sources.size()))
      throw damage("the tile index is wrong at row " + std::to_string(row.key) + ": no such source");
    tiles.push_back({*lod::unpack(row.key), row.min_m, row.max_m, row.inner,
                     row.posts_terms ? lod::StatedTerms(*row.posts_terms) : lod::StatedTerms(),
                     std::move(row.variants), row.slope});
  }
  if (static_cast<std::int64_t>(tiles.size()) != meta_.tiles) {
    throw damage(std::to_string(tiles.size()) + " of " + std::to_string(meta_.tiles) +
                 " tiles are in the index");
  }
  try {
    tree_ =
        std::make_unique<lod::TileTree>(std::move(tiles), meta_.tile, meta_.radius_m, meta_.lowest_radius_m);
  } catch (const std::runtime_error& e) {
    throw damage(e.what());
  }
  Statement images(db, "SELECT key FROM image ORDER BY key");
  while (images.step()) image_keys_.push_back(images.integer(0));
  if (static_cast<std::int64_t>(image_keys_.size()) != meta_.image_tiles)
    throw damage("image tiles are missing");
  if (const std::string wrong = unsafe_meta(meta_, tree_->tiles(), image_keys_); !wrong.empty())
    throw damage(wrong);
  Statement masks(db, "SELECT key FROM missing");
  while (masks.step()) {
    const auto key = lod::unpack(masks.integer(0));
    if (!key) throw damage("nodata mask for a tile that does not exist");
    nodata_keys_.push_back(masks.integer(0));
    for (lod::TileKey at = *key; at.level > 0;) nodata_keys_.push_back(lod::pack(at = lod::parent(at)));
  }
  std::sort(nodata_keys_.begin(), nodata_keys_.end());
  nodata_keys_.erase(std::unique(nodata_keys_.begin(), nodata_keys_.end()), nodata_keys_.end());
}

bool PlanetFile::has_nodata(const lod::TileKey& key) const {
  return std::binary_search(nodata_keys_.begin(), nodata_keys_.end(), lod::pack(key));
}

void put_on_coarser_edges(TileHeights& heights, double radius_m, double exaggeration) {
  if (heights.coarser_neighbour_mask == 0) return;
  const lod::GridLines lines = lod::grid_lines(heights.posts.key, heights.posts.intervals);
  for (const lod::Edge edge : lod::kEdges) {
    if ((heights.coarser_neighbour_mask >> static_cast<int>(edge) & 1) != 0)
      lod::constrain_edge(heights.posts, lines, edge, 2, radius_m, exaggeration);
  }
}

TileHeights PlanetFile::heights(const lod::TileKey& key, double exaggeration) const {
  const std::int64_t row = lod::pack(key);
  struct Stored {
    int coarser_neighbour_mask = 0;
    std::string sources;
    Bytes packed;
    std::optional<Bytes> mask;
  };
  TileHeights out;
  try {
    const Stored stored = read([&](Connection& connection) {
      Stored found;
      connection.node.bind(1, row);
      if (!connection.node.step()) throw PlanetError(damaged(path_, key, "not in the index"));
      found.coarser_neighbour_mask = static_cast<int>(connection.node.integer(0));
      found.sources = connection.node.text(1);
      connection.heights.bind(1, row);
      auto packed = verified(connection.heights, row, path_, key, "heights");
      if (!packed) throw PlanetError(damaged(path_, key, "heights are missing"));
      found.packed = std::move(*packed);
      connection.nodata.bind(1, row);
      found.mask = verified(connection.nodata, row, path_, key, "nodata mask");
      return found;
    });
    const auto sources = source_indices(stored.sources);
    if (!sources) throw PlanetError(damaged(path_, key, "list of sources '" + stored.sources + "'"));
    out.source = *sources;
    out.coarser_neighbour_mask = stored.coarser_neighbour_mask;
    const std::vector<std::int32_t> quanta = decode_heights(stored.packed, meta_.tile.posts());
    out.posts.key = key;
    out.posts.intervals = meta_.tile.intervals();
    out.posts.height_m.resize(quanta.size());
    std::transform(quanta.begin(), quanta.end(), out.posts.height_m.begin(),
                   [q = meta_.quantum_m](std::int32_t n) { return n * q; });
    if (stored.mask) out.nodata = decode_mask(*stored.mask, quanta.size());
  } catch (const DatabaseError& e) {
    throw PlanetError(damaged(path_, key, e.what()));
  } catch (const CodecError& e) {
    throw PlanetError(damaged(path_, key, e.what()));
  }
  put_on_coarser_edges(out, meta_.radius_m, exaggeration);
  return out;
}

PackedMesh PlanetFile::mesh(const lod::TileKey& key, int variant) const {
  const std::int64_t row = lod::pack(key);
  const lod::TileInfo* tile = tree_->find(key);
  if (tile == nullptr) throw PlanetError(damaged(path_, key, "not in the index"));
  try {
    const auto packed = read([&](Connection& connection) {
      connection.mesh.bind(1, row).bind(2, static_cast<std::int64_t>(variant));
      return verified(connection.mesh, row + variant, path_, key, "mesh");
    });
    if (!packed) throw PlanetError(damaged(path_, key, "mesh " + std::to_string(variant) + " is missing"));
    return decode_mesh(*packed, mesh_intervals(meta_.tile, tile->has_children));
  } catch (const DatabaseError& e) {
    throw PlanetError(damaged(path_, key, e.what()));
  } catch (const CodecError& e) {
    throw PlanetError(damaged(path_, key, e.what()));
  }
}

std::optional<lod::TileKey> PlanetFile::image_key(const lod::TileKey& key) const {
  for (int level = std::min(key.level, meta_.finest_image_level); level >= 0; --level) {
    const lod::TileKey candidate = lod::ancestor(key, level);
    if (std::binary_search(image_keys_.begin(), image_keys_.end(), lod::pack(candidate))) return candidate;
  }
  return std::nullopt;
}

std::vector<lod::TileKey> PlanetFile::image_keys() const {
  std::vector<lod::TileKey> keys;
  for (const std::int64_t row : image_keys_) {
    if (const auto key = lod::unpack(row)) keys.push_back(*key);
  }
  return keys;
}

ImageTile PlanetFile::image(const lod::TileKey& key) const {
  const std::int64_t row = lod::pack(key);
  try {
    const auto packed = read([&](Connection& connection) {
      connection.image.bind(1, row);
      return verified(connection.image, row, path_, key, "image");
    });
    if (!packed) throw PlanetError(damaged(path_, key, "image is missing"));
    vpe::core::RgbImage decoded =
        vpe::core::decode_jpeg(*packed, std::int64_t{kTexelsPerSide} * kTexelsPerSide);
    if (decoded.width != kTexelsPerSide || decoded.height != kTexelsPerSide) {
      throw PlanetError(damaged(path_, key, "image of the wrong size"));
    }
    return {std::move(decoded.pixels)};
  } catch (const PlanetError&) {
    throw;
  } catch (const std::runtime_error& e) {
    throw PlanetError(damaged(path_, key, e.what()));
  }
}

}  // namespace paging
