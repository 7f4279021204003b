#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "paging/planet/codec.h"
#include "paging/planet/planet_database.h"
#include "paging/planet/planet_meta.h"
#include "paging/planet/sqlite.h"

namespace paging {

namespace {

constexpr std::int64_t kEdgeMasks = 16;

}  // namespace

lod::TileInfo tile_info(NodeRow row) {
  return {*lod::unpack(row.key),
          row.min_m,
          row.max_m,
          row.inner,
          row.posts_terms ? lod::StatedTerms(*row.posts_terms) : lod::StatedTerms(),
          std::move(row.variants),
          row.slope};
}

std::optional<std::int64_t> read_nodes(const Database& db, std::vector<NodeRow>& rows) {
  Statement nodes(db,
                  "SELECT key, min_m, max_m, inner, steps, sources, checksum, slope, face, level, i, j "
                  "FROM node ORDER BY key");
  Statement variants(db, "SELECT key, relief_m, sag_m, total_m, triangles FROM variant ORDER BY key, variant");
  bool more = variants.step();
  // Files before format 1.2 do not have this table.
  std::optional<Statement> posts;
  if (has_table(db, "posts_error"))
    posts.emplace(db, "SELECT key, relief_m, sag_m, total_m, checksum FROM posts_error ORDER BY key");
  bool more_posts = posts && posts->step();
  while (nodes.step()) {
    NodeRow row;
    row.key = nodes.integer(0);
    row.min_m = nodes.real(1);
    row.max_m = nodes.real(2);
    row.inner = nodes.integer(3) != 0;
    row.coarser_neighbour_mask = static_cast<int>(nodes.integer(4));
    row.sources = nodes.text(5);
    row.slope = nodes.real(7);
    while (more && variants.integer(0) < row.key) more = variants.step();
    while (more && variants.integer(0) == row.key) {
      row.variants.push_back(lod::MeshVariant{{variants.real(1), variants.real(2), variants.real(3)},
                                              static_cast<std::uint32_t>(variants.integer(4))});
      more = variants.step();
    }
    while (more_posts && posts->integer(0) < row.key) more_posts = posts->step();
    if (more_posts && posts->integer(0) == row.key) {
      row.posts_terms = lod::ErrorTerms{posts->real(1), posts->real(2), posts->real(3)};
      if (posts_checksum(row) != posts->integer(4)) return row.key;
      more_posts = posts->step();
    }
    const std::optional<lod::TileKey> key = lod::unpack(row.key);
    if (!key || checksum(row) != nodes.integer(6)) return row.key;
    if (!source_indices(row.sources) || nodes.integer(4) < 0 || nodes.integer(4) >= kEdgeMasks) return row.key;
    // The columns that help people with SQL must agree with the key.
    if (nodes.integer(8) != static_cast<std::int64_t>(key->face) || nodes.integer(9) != key->level ||
        nodes.integer(10) != std::int64_t{key->i} || nodes.integer(11) != std::int64_t{key->j}) {
      return row.key;
    }
    rows.push_back(std::move(row));
  }
  return std::nullopt;
}

std::vector<LevelSummary> summarize_levels(const Database& db, std::size_t posts) {
  // Grouped here and not by SQL: SQLite would sort the rows with their payloads, in temporary files.
  std::map<std::int64_t, LevelSummary> levels;
  Statement tiles(db, "SELECT level, inner FROM node");
  while (tiles.step()) {
    LevelSummary& level = levels[tiles.integer(0)];
    ++level.tiles;
    level.leaf_tiles += tiles.integer(1) == 0 ? 1 : 0;
  }
  for (const std::string table : {"heights", "missing", "mesh", "image"}) {
    Statement rows(db, "SELECT key >> 54 & 31, length(data) FROM " + table);
    while (rows.step()) {
      LevelSummary& level = levels[rows.integer(0)];
      level.bytes += rows.integer(1);
      level.image_tiles += table == "image" ? 1 : 0;
    }
  }
  Statement masks(db, "SELECT key >> 54 & 31, data FROM missing JOIN node USING (key) WHERE NOT inner");
  while (masks.step()) {
    const std::vector<bool> mask = decode_mask(masks.blob(1), posts);
    levels[masks.integer(0)].nodata_posts += std::count(mask.begin(), mask.end(), true);
  }
  std::vector<LevelSummary> out;
  for (auto& [level, summary] : levels) {
    summary.level = static_cast<int>(level);
    out.push_back(summary);
  }
  return out;
}

std::string content_identity(const Database& db) {
  // In key order, so that the order in which threads finished has no effect.
  Bytes all;
  const auto add = [&](const std::string& table, const std::string& order) {
    Statement rows(db, "SELECT checksum FROM " + table + " ORDER BY " + order);
    while (rows.step()) {
      const auto sum = static_cast<std::uint64_t>(rows.integer(0));
      for (int shift = 0; shift < 64; shift += 8) all.push_back(static_cast<std::uint8_t>(sum >> shift));
    }
  };
  for (const char* table : {"node", "heights", "missing", "image"}) add(table, "key");
  add("mesh", "key, variant");
  // Not of `origin` and other later tables: programs that do not know them must find the same. Layers are shown, so that
  // planets which differ in them alone need two identities.
  if (has_table(db, "image_layer")) add("image_layer", "layer, key");
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(checksum(kApplicationId, all)));
  return text;
}

}  // namespace paging
