// Planet files with wrong content and right checksums: what a checksum without a key cannot tell from a file
// that vpe wrote.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "paging/planet/codec.h"
#include "paging/planet/planet_database.h"
#include "paging/planet/planet_meta.h"
#include "paging/planet/sqlite.h"
#include "paging/planet/tile_sources.h"

namespace test_support {

// Computes the checksum of the table meta as docs/design/planet-file.md describes it, from the rows themselves.
inline void forge_meta_checksum(paging::Database& db) {
  paging::Bytes bytes;
  {
    paging::Statement rows(db, "SELECT key, value FROM meta WHERE key <> 'checksum' ORDER BY key");
    while (rows.step()) {
      for (const std::string& part : {rows.text(0), rows.text(1)}) {
        bytes.insert(bytes.end(), part.begin(), part.end());
        bytes.push_back(0);
      }
    }
  }
  db.execute("UPDATE meta SET value = '" + std::to_string(paging::checksum(0, bytes)) +
             "' WHERE key = 'checksum'");
}

// Computes the checksums of all payloads of a table from its rows.
inline void forge_payload_checksums(paging::Database& db, const std::string& table) {
  std::vector<std::pair<std::int64_t, std::int64_t>> sums;
  {
    const std::string seed = table == "mesh" ? "key + variant" : "key";
    paging::Statement rows(db, "SELECT rowid, " + seed + ", data FROM " + table);
    while (rows.step()) sums.emplace_back(rows.integer(0), paging::checksum(rows.integer(1), rows.blob(2)));
  }
  paging::Statement update(db, "UPDATE " + table + " SET checksum = ? WHERE rowid = ?");
  for (const auto& [row, sum] : sums) update.bind(1, sum).bind(2, row).step();
}

// Computes the checksums of the tile index from its rows. Rows are read here, because read_nodes() stops at the
// first that is wrong.
inline void forge_index_checksums(paging::Database& db) {
  std::map<std::int64_t, paging::NodeRow> nodes;
  {
    paging::Statement rows(db, "SELECT key, min_m, max_m, inner, steps, sources, slope FROM node");
    while (rows.step()) {
      paging::NodeRow& node = nodes[rows.integer(0)];
      node.key = rows.integer(0);
      node.min_m = rows.real(1);
      node.max_m = rows.real(2);
      node.inner = rows.integer(3) != 0;
      node.coarser_neighbour_mask = static_cast<int>(rows.integer(4));
      node.sources = rows.text(5);
      node.slope = rows.real(6);
    }
    paging::Statement variants(
        db, "SELECT key, relief_m, sag_m, total_m, triangles FROM variant ORDER BY key, variant");
    while (variants.step()) {
      nodes[variants.integer(0)].variants.push_back({{variants.real(1), variants.real(2), variants.real(3)},
                                                     static_cast<std::uint32_t>(variants.integer(4))});
    }
    paging::Statement posts(db, "SELECT key, relief_m, sag_m, total_m FROM posts_error");
    while (posts.step())
      nodes[posts.integer(0)].posts_terms = lod::ErrorTerms{posts.real(1), posts.real(2), posts.real(3)};
  }
  paging::Statement update(db, "UPDATE node SET checksum = ? WHERE key = ?");
  paging::Statement update_posts(db, "UPDATE posts_error SET checksum = ? WHERE key = ?");
  for (const auto& [key, node] : nodes) {
    update.bind(1, paging::checksum(node)).bind(2, key).step();
    if (node.posts_terms) update_posts.bind(1, paging::posts_checksum(node)).bind(2, key).step();
  }
}

// Computes the checksums of the table `resampling` from its rows.
inline void forge_resampling_checksums(paging::Database& db) {
  std::vector<paging::TileResampling> all;
  {
    paging::Statement rows(db, "SELECT key, source, posts, max_m, rms_m FROM resampling");
    while (rows.step()) {
      all.push_back({rows.integer(0),
                     {static_cast<int>(rows.integer(1)), {rows.real(3), rows.real(4), rows.integer(2)}}});
    }
  }
  paging::Statement update(db, "UPDATE resampling SET checksum = ? WHERE key = ? AND source = ?");
  for (const paging::TileResampling& row : all)
    update.bind(1, paging::checksum(row)).bind(2, row.key).bind(3, std::int64_t{row.of.source}).step();
}

// Computes every checksum and the identity from the content as it is now.
inline void forge_checksums(const std::string& path) {
  paging::Database db(path, paging::Database::Mode::kCreate);
  db.execute("BEGIN");
  for (const char* table : {"heights", "missing", "origin", "mesh", "image"})
    forge_payload_checksums(db, table);
  forge_index_checksums(db);
  forge_resampling_checksums(db);
  db.execute("UPDATE meta SET value = '" + paging::content_identity(db) + "' WHERE key = 'identity'");
  forge_meta_checksum(db);
  db.execute("COMMIT");
}

// Makes a file of format 1.2, 1.1 or 1.0 of one of a newer minor format: removes what it does not have.
inline void make_older(const std::string& path, const std::string& format) {
  paging::Database db(path, paging::Database::Mode::kCreate);
  db.execute("DROP TABLE IF EXISTS origin; DROP TABLE IF EXISTS resampling");
  // The figures by source in `levels` stay in an older file as keys that nobody reads; they are removed here.
  {
    const std::map<std::string, std::string> rows = paging::read_meta_rows(db);
    if (rows.contains("levels")) {
      std::vector<paging::LevelSummary> levels = paging::levels_from_text(rows.at("levels"));
      for (paging::LevelSummary& level : levels) level.resampling_by_source.clear();
      const std::string text = paging::to_text(levels);
      paging::Statement update(db, "UPDATE meta SET value = ? WHERE key = 'levels'");
      update.bind(1, std::string_view(text)).step();
    }
  }
  if (format < "1.2") db.execute("DROP TABLE IF EXISTS posts_error");
  if (format < "1.4") db.execute("DELETE FROM meta WHERE key IN ('build', 'arguments')");
  if (format < "1.1") db.execute("DELETE FROM meta WHERE key = 'levels'");
  db.execute("UPDATE meta SET value = '" + format + "' WHERE key = 'format'");
  db.execute("UPDATE meta SET value = '" + paging::content_identity(db) + "' WHERE key = 'identity'");
  forge_meta_checksum(db);
}

// Runs SQL that changes the content, then computes every checksum again.
inline void forge(const std::string& path, const std::string& sql) {
  paging::Database(path, paging::Database::Mode::kCreate).execute(sql);
  forge_checksums(path);
}

}  // namespace test_support
