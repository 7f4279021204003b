#include "paging/planet/planet_file.h"

#include <algorithm>
#include <filesystem>

#include "paging/planet/planet_database.h"
#include "paging/planet/sqlite.h"
#include "vpe/core/image/image.h"

namespace paging {

namespace {

constexpr int kImageSide = kImageIntervals + 1;

std::string damaged(const std::string& path, const lod::TileKey& key, const std::string& what) {
  return path + ": tile " + lod::to_string(key) + " is damaged (" + what + "); build the planet file again";
}

std::vector<int> parse_sources(const std::string& text) {
  std::vector<int> out;
  for (std::size_t at = 0; at < text.size();) {
    std::size_t used = 0;
    out.push_back(std::stoi(text.substr(at), &used));
    at += used + 1;
  }
  return out;
}

}  // namespace

// Holds a read connection with its prepared statements.
struct PlanetFile::Connection {
  explicit Connection(const std::string& path)
      : db(open_planet_database(path)),
        heights(db, "SELECT checksum, data FROM heights WHERE key = ?"),
        nodata(db, "SELECT checksum, data FROM missing WHERE key = ?"),
        node(db, "SELECT steps, sources FROM node WHERE key = ?"),
        mesh(db, "SELECT checksum, data FROM mesh WHERE key = ? AND variant = ?"),
        image(db, "SELECT checksum, data FROM image WHERE key = ?") {}

  void reset() {
    for (Statement* statement : {&heights, &nodata, &node, &mesh, &image}) statement->reset();
  }

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
      connections_([this] { return std::make_unique<Connection>(path_); },
                   {.reset = [](Connection& connection) { connection.reset(); }}) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw PlanetError(path + ": no such planet file; make one with 'vpe build DEM -o " + path + "'");
  }
  try {
    meta_ = from_rows(read_meta_rows(open_planet_database(path)), path);
    if (meta_.shard) {
      const std::string of = std::to_string(meta_.shard->id.of);
      throw PlanetError(path + ": part " + std::to_string(meta_.shard->id.number) + " of " + of +
                        " of a planet; join all " + of + " with 'vpe merge PART... -o PLANET.vpe'");
    }
    read_index(*connections_.acquire());
  } catch (const DatabaseError& e) {
    throw PlanetError(std::string(e.what()) + "; not a planet file, or damaged: build it again");
  }
}

void PlanetFile::read_index(Connection& connection) {
  std::vector<NodeRow> rows;
  const auto bad = read_nodes(connection.db, rows);
  if (bad) {
    throw PlanetError(path_ + ": damaged: the tile index is wrong at row " + std::to_string(*bad) +
                      "; build the planet file again");
  }
  std::vector<lod::TileInfo> tiles;
  tiles.reserve(rows.size());
  for (NodeRow& row : rows) {
    tiles.push_back({*lod::unpack(row.key), row.min_m, row.max_m, row.inner,
                     row.posts_terms ? lod::StatedTerms(*row.posts_terms) : lod::StatedTerms(),
                     std::move(row.variants), row.slope});
  }
  if (static_cast<std::int64_t>(tiles.size()) != meta_.tiles) {
    throw PlanetError(path_ + ": damaged: " + std::to_string(tiles.size()) + " of " +
                      std::to_string(meta_.tiles) + " tiles are in the index; build the planet file again");
  }
  try {
    tree_ =
        std::make_unique<lod::TileTree>(std::move(tiles), meta_.tile, meta_.radius_m, meta_.lowest_radius_m);
  } catch (const std::runtime_error& e) {
    throw PlanetError(path_ + ": damaged: " + e.what() + "; build the planet file again");
  }
  Statement images(connection.db, "SELECT key FROM image ORDER BY key");
  while (images.step()) image_keys_.push_back(images.integer(0));
  if (static_cast<std::int64_t>(image_keys_.size()) != meta_.image_tiles) {
    throw PlanetError(path_ + ": damaged: image tiles are missing; build the planet file again");
  }
  Statement masks(connection.db, "SELECT key FROM missing");
  while (masks.step()) {
    const auto key = lod::unpack(masks.integer(0));
    if (!key)
      throw PlanetError(path_ +
                        ": damaged: nodata mask for a tile that does not exist; build the planet file again");
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
  TileHeights out;
  Bytes packed;
  std::optional<Bytes> mask;
  try {
    const auto connection = connections_.acquire();
    connection->node.bind(1, row);
    if (!connection->node.step()) throw PlanetError(damaged(path_, key, "not in the index"));
    out.coarser_neighbour_mask = static_cast<int>(connection->node.integer(0));
    out.source = parse_sources(connection->node.text(1));
    connection->heights.bind(1, row);
    auto found = verified(connection->heights, row, path_, key, "heights");
    if (!found) throw PlanetError(damaged(path_, key, "heights are missing"));
    packed = std::move(*found);
    connection->nodata.bind(1, row);
    mask = verified(connection->nodata, row, path_, key, "nodata mask");
  } catch (const DatabaseError& e) {
    throw PlanetError(damaged(path_, key, e.what()));
  }
  try {
    const std::vector<std::int32_t> quanta = decode_heights(packed, meta_.tile.posts());
    out.posts.key = key;
    out.posts.intervals = meta_.tile.intervals();
    out.posts.height_m.resize(quanta.size());
    std::transform(quanta.begin(), quanta.end(), out.posts.height_m.begin(),
                   [q = meta_.quantum_m](std::int32_t n) { return n * q; });
    if (mask) out.nodata = decode_mask(*mask, quanta.size());
  } catch (const CodecError& e) {
    throw PlanetError(damaged(path_, key, e.what()));
  }
  put_on_coarser_edges(out, meta_.radius_m, exaggeration);
  return out;
}

PackedMesh PlanetFile::mesh(const lod::TileKey& key, int variant) const {
  const std::int64_t row = lod::pack(key);
  try {
    const auto connection = connections_.acquire();
    connection->mesh.bind(1, row).bind(2, static_cast<std::int64_t>(variant));
    const auto packed = verified(connection->mesh, row + variant, path_, key, "mesh");
    if (!packed) throw PlanetError(damaged(path_, key, "mesh " + std::to_string(variant) + " is missing"));
    return decode_mesh(*packed);
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
    const auto connection = connections_.acquire();
    connection->image.bind(1, row);
    const auto packed = verified(connection->image, row, path_, key, "image");
    if (!packed) throw PlanetError(damaged(path_, key, "image is missing"));
    vpe::core::RgbImage decoded = vpe::core::decode_jpeg(*packed);
    if (decoded.width != kImageSide || decoded.height != kImageSide) {
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
