// Reading of tiles; planet_file.cpp opens the file and reads its index.
#include <algorithm>

#include "paging/planet/layer_composite.h"
#include "paging/planet/planet_connection.h"
#include "paging/planet/planet_overlay.h"
#include "vpe/core/image/image.h"

namespace paging {

namespace {

constexpr int kTexelsPerSide = kImageIntervals + 1;
constexpr int kReadTries = 20;

std::string damaged(const std::string& path, const lod::TileKey& key, const std::string& what) {
  return path + ": tile " + lod::to_string(key) + " is damaged (" + what + "); build the planet file again";
}

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

// Returns false for a source that has no number.
bool renumber(std::vector<int>& sources, const std::vector<int>& numbers) {
  if (numbers.empty()) return true;
  for (int& source : sources) {
    if (source >= static_cast<int>(numbers.size())) return false;
    source = numbers[static_cast<std::size_t>(source)];
  }
  return true;
}

}  // namespace

const PatchTile* PlanetFile::patched_tile(std::int64_t row) const {
  if (!is_patched()) return nullptr;
  const PlanetOverlay::Tile* found = overlay_->tile(row);
  return found == nullptr ? nullptr : found->tile;
}

template <class Read>
auto PlanetFile::read(const Read& fetch) const {
  auto& connections = file_ ? file_->connections_ : connections_;
  for (int n = 0; n < kReadTries; ++n) {
    auto connection = connections.acquire();
    auto result = fetch(*connection);
    if (connection->is_current()) return result;
    connection.discard();
  }
  throw replaced(path_);
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
  if (before_read_) before_read_(key);
  const std::int64_t row = lod::pack(key);
  struct Stored {
    int coarser_neighbour_mask = 0;
    std::string sources;
    Bytes packed;
    std::optional<Bytes> mask;
    static Stored of(const PatchTile& tile) {
      const Bytes& nodata = tile.payload.nodata;
      return {tile.row.coarser_neighbour_mask, tile.row.sources, tile.payload.heights,
              nodata.empty() ? std::nullopt : std::optional(nodata)};
    }
  };
  TileHeights out;
  try {
    const PatchTile* patched = patched_tile(row);
    const Stored stored = patched != nullptr ? Stored::of(*patched) : read([&](Connection& connection) {
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
    if (is_patched() && !renumber(out.source, overlay_->source_numbers(row)))
      throw PlanetError(damaged(path_, key, "no such source"));
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
  if (before_read_) before_read_(key);
  const std::int64_t row = lod::pack(key);
  const lod::TileInfo* tile = tree_->find(key);
  if (tile == nullptr) throw PlanetError(damaged(path_, key, "not in the index"));
  try {
    if (const PatchTile* patched = patched_tile(row)) {
      const std::vector<Bytes>& meshes = patched->payload.meshes;
      if (variant < 0 || variant >= static_cast<int>(meshes.size()))
        throw PlanetError(damaged(path_, key, "mesh " + std::to_string(variant) + " is missing"));
      return decode_mesh(meshes[static_cast<std::size_t>(variant)],
                         mesh_intervals(meta_.tile, tile->has_children));
    }
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

TileSources PlanetFile::sources(const lod::TileKey& key) const {
  const std::int64_t row = lod::pack(key);
  TileSources out;
  try {
    const PatchTile* patched = patched_tile(row);
    const auto of_patch = [&]() -> std::optional<Bytes> {
      out.of_tile = *source_indices(patched->row.sources);
      out.resampling = patched->resampling;
      if (patched->payload.origin.empty()) return std::nullopt;
      return patched->payload.origin;
    };
    const auto origin = patched != nullptr ? of_patch() : read([&](Connection& connection) {
      connection.node.bind(1, row);
      if (!connection.node.step()) throw PlanetError(damaged(path_, key, "not in the index"));
      const auto sources = source_indices(connection.node.text(1));
      if (!sources) throw PlanetError(damaged(path_, key, "list of sources"));
      out.of_tile = *sources;
      out.resampling.clear();
      std::optional<Bytes> packed;
      if (connection.origin) packed = verified(connection.origin->bind(1, row), row, path_, key, "sources");
      if (connection.resampling) {
        Statement& rows = connection.resampling->bind(1, row);
        while (rows.step()) {
          const TileResampling found{
              row, {static_cast<int>(rows.integer(0)), {rows.real(2), rows.real(3), rows.integer(1)}}};
          if (checksum(found) != rows.integer(4))
            throw PlanetError(damaged(path_, key, "resampling error: wrong checksum"));
          out.resampling.push_back(found.of);
        }
      }
      return packed;
    });
    if (is_patched()) {
      const std::vector<int>& numbers = overlay_->source_numbers(row);
      bool all = renumber(out.of_tile, numbers);
      for (SourceResampling& of : out.resampling) {
        std::vector<int> one{of.source};
        all = renumber(one, numbers) && all;
        of.source = one.front();
      }
      if (!all) throw PlanetError(damaged(path_, key, "no such source"));
    }
    for (const int source : out.of_tile)
      if (source >= static_cast<int>(meta_.sources.size()))
        throw PlanetError(damaged(path_, key, "no such source"));
    if (origin) {
      out.of_post =
          decode_numbers(*origin, static_cast<std::size_t>(meta_.tile.post_count()), out.of_tile.size());
    }
  } catch (const DatabaseError& e) {
    throw PlanetError(damaged(path_, key, e.what()));
  } catch (const CodecError& e) {
    throw PlanetError(damaged(path_, key, e.what()));
  }
  return out;
}

// From the uppermost layer down to the first that hides all below it.
ImageTile PlanetFile::composed_image(const lod::TileKey& key) const {
  LayerComposite composite(key);
  try {
    for (auto look = shown_layers_.rbegin(); look != shown_layers_.rend() && !composite.is_opaque(); ++look) {
      if (look->opacity == 0) continue;
      const auto layer = std::ranges::find(meta_.image_layers, look->name, &ImageLayer::name);
      const std::int64_t number = layer - meta_.image_layers.begin();
      const std::vector<std::int64_t>& keys = (*layer_keys_)[static_cast<std::size_t>(number)];
      lod::TileKey at = lod::ancestor(key, std::min(key.level, layer->finest_level));
      while (!std::ranges::binary_search(keys, lod::pack(at)) && at.level > 0) at = lod::parent(at);
      const std::int64_t row = lod::pack(at);
      if (!std::ranges::binary_search(keys, row)) continue;
      const std::string what = "image layer '" + look->name + "'";
      const auto packed = read([&](Connection& connection) {
        if (!connection.layer) throw PlanetError(damaged(path_, at, what + " is missing"));
        connection.layer->bind(1, number).bind(2, row);
        return verified(*connection.layer, row, path_, at, what.c_str());
      });
      if (!packed) throw PlanetError(damaged(path_, at, what + " is missing"));
      composite.add(*look, decode_layer_tile(*packed), at);
    }
  } catch (const PlanetError&) {
    throw;
  } catch (const std::runtime_error& e) {
    throw PlanetError(damaged(path_, key, e.what()));
  }
  return {composite.texels()};
}

ImageTile PlanetFile::image(const lod::TileKey& key) const {
  if (before_read_) before_read_(key);
  if (!shown_layers_.empty()) return composed_image(key);
  const std::int64_t row = lod::pack(key);
  try {
    const PlanetOverlay::Image* patched = is_patched() ? overlay_->image(row) : nullptr;
    const auto packed =
        patched != nullptr ? std::optional(patched->image->jpeg) : read([&](Connection& connection) {
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
