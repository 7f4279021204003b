// A read connection of PlanetFile. Included by the files that implement it alone.
#pragma once

#include <optional>
#include <string>

#include "paging/planet/planet_database.h"
#include "paging/planet/planet_file.h"
#include "vpe/base/file.h"

namespace paging {

// Returns the error that tells that a planet's file was replaced while it was in use.
inline PlanetError replaced(const std::string& path) {
  return PlanetError(
      path + ": another planet file was written there while this one was in use; run the command again");
}

// Holds a read connection with its prepared statements.
struct PlanetFile::Connection {
  explicit Connection(const PlanetFile& planet)
      : stamp(vpe::base::file_stamp(planet.path())),
        db(planet.connect()),
        heights(db, "SELECT checksum, data FROM heights WHERE key = ?"),
        nodata(db, "SELECT checksum, data FROM missing WHERE key = ?"),
        node(db, "SELECT steps, sources FROM node WHERE key = ?"),
        mesh(db, "SELECT checksum, data FROM mesh WHERE key = ? AND variant = ?"),
        image(db, "SELECT checksum, data FROM image WHERE key = ?") {
    if (has_table(db, "origin")) origin.emplace(db, "SELECT checksum, data FROM origin WHERE key = ?");
    if (has_table(db, "resampling")) {
      resampling.emplace(db,
                         "SELECT source, posts, max_m, rms_m, checksum FROM resampling WHERE key = ? "
                         "ORDER BY source");
    }
    if (has_table(db, "image_layer"))
      layer.emplace(db, "SELECT checksum, data FROM image_layer WHERE layer = ? AND key = ?");
  }

  void reset() {
    for (Statement* statement : {&heights, &nodata, &node, &mesh, &image}) statement->reset();
    if (origin) origin->reset();
    if (resampling) resampling->reset();
    if (layer) layer->reset();
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
  std::optional<Statement> origin;  // absent before format 1.3, as is the next one
  std::optional<Statement> resampling;
  std::optional<Statement> layer;  // of files with image layers
};

}  // namespace paging
