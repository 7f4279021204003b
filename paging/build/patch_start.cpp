#include "paging/build/patch_start.h"

#include <algorithm>
#include <filesystem>

#include "paging/planet/planet_database.h"

namespace paging {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& reason) {
  throw PlanetError(path + ": cannot be patched: " + reason);
}

std::string settings_difference(const std::string& is, const std::string& wanted) {
  const auto [a, b] = std::ranges::mismatch(is, wanted);
  const auto line = [](const std::string& text, std::string::const_iterator at) {
    const auto begin = std::find(std::make_reverse_iterator(at), text.rend(), '\n').base();
    return std::string(begin, std::find(at, text.end(), '\n'));
  };
  return "'" + line(is, a) + "', not '" + line(wanted, b) + "'";
}

void require_equal_planets(const std::string& path, const PlanetMeta& is, const PlanetMeta& wanted) {
  const char* const kAgain = "; build the planet again from all sources";
  if (is.shard) refuse(path, "it is one part of a planet; join the parts with 'vpe merge' first");
  if (is.build_settings.empty())
    refuse(path, std::string("it does not tell how it was built, as an older version made it") + kAgain);
  if (is.body != wanted.body) refuse(path, "it is " + is.body + ", and the sources are of " + wanted.body);
  if (!(is.datum == wanted.datum) || is.shape != wanted.shape) {
    refuse(path, "its heights have datum '" + to_string(is.datum) + "' and shape '" + is.shape +
                     "', those of the sources '" + to_string(wanted.datum) + "' and '" + wanted.shape + "'");
  }
  if (is.build_settings != wanted.build_settings)
    refuse(path, "it was built with " + settings_difference(is.build_settings, wanted.build_settings) + kAgain);
  if (is.radius_m != wanted.radius_m || is.tile.k != wanted.tile.k || is.quantum_m != wanted.quantum_m)
    refuse(path, std::string("its radius, size of tiles or step of heights is another") + kAgain);
}

bool is_same_source(const mars::SourceInfo& a, const mars::SourceInfo& b) {
  const auto file = [](const mars::SourceInfo& s) { return std::filesystem::path(s.name).filename().string(); };
  if (file(a) != file(b) || a.resolution_m != b.resolution_m || a.quantum_m != b.quantum_m ||
      !(a.datum == b.datum))
    return false;
  // Samples of the content do not show every change, so only a copy elsewhere may have another time.
  const bool is_same_file = a.size_bytes == b.size_bytes && a.mtime_s == b.mtime_s;
  return a.content == b.content && (is_same_file || (!a.content.empty() && a.name != b.name));
}

// Returns the number of each source of `before` among `now`, where they must stand in the same order.
std::vector<int> numbers_now(const std::string& path, const std::vector<mars::SourceInfo>& before,
                             const std::vector<mars::SourceInfo>& now) {
  std::vector<int> numbers;
  auto at = now.begin();
  for (const mars::SourceInfo& source : before) {
    at = std::find_if(at, now.end(), [&](const mars::SourceInfo& s) { return is_same_source(source, s); });
    if (at == now.end()) {
      refuse(path, "its source " + source.name +
                       " is not what it was built from: another size, time or content; build the planet again");
    }
    numbers.push_back(static_cast<int>(at++ - now.begin()));
  }
  return numbers;
}

std::set<std::int64_t> keys_of(const Database& db, const char* table) {
  std::set<std::int64_t> keys;
  Statement rows(db, std::string("SELECT key FROM ") + table);
  while (rows.step()) keys.insert(rows.integer(0));
  return keys;
}

std::set<LayerTileKey> layer_tiles_of(const Database& db) {
  std::set<LayerTileKey> keys;
  if (!has_table(db, "image_layer")) return keys;
  Statement rows(db, "SELECT layer, key FROM image_layer");
  while (rows.step()) keys.insert({rows.integer(0), rows.integer(1)});
  return keys;
}

// Sets which tiles of the file's layers stay, and under which numbers.
void plan_layer_tiles(const FinishedPlanet& finished, const PatchedPlanet& patched, const PlanetMeta& meta,
                      const std::vector<std::vector<lod::TileKey>>& layers, PatchStart& start) {
  const std::vector<ImageLayer>& before = finished.meta.image_layers;
  auto at = meta.image_layers.begin();
  for (const ImageLayer& layer : before) {
    at = std::find_if(at, meta.image_layers.end(), [&](const ImageLayer& l) { return l.name == layer.name; });
    if (at == meta.image_layers.end())
      refuse(finished.path,
             "its image layer '" + layer.name + "' has another name or place now; build the planet again");
    start.layer_numbers.push_back(static_cast<int>(at++ - meta.image_layers.begin()));
  }
  std::set<LayerTileKey> kept;
  for (std::size_t n = 0; n < before.size(); ++n) {
    for (const lod::TileKey& key : layers[static_cast<std::size_t>(start.layer_numbers[n])]) {
      if (!patched.image_changes(surroundings(key, kImageIntervals)))
        kept.insert({static_cast<std::int64_t>(n), lod::pack(key)});
    }
  }
  for (const LayerTileKey& key : finished.layer_tiles)
    if (!kept.contains(key)) start.dropped_layer_tiles.push_back(key);
}

}  // namespace

FinishedPlanet read_finished(const std::string& path) {
  const Database db = open_planet_database(path);
  FinishedPlanet finished{path,
                          from_rows(read_meta_rows(db), path),
                          {},
                          keys_of(db, "missing"),
                          keys_of(db, "image"),
                          layer_tiles_of(db)};
  if (read_nodes(db, finished.rows)) refuse(path, "its tile index is damaged; build the planet again");
  return finished;
}

PatchStart plan_patch(const FinishedPlanet& finished, const PatchedPlanet& patched, const PlanetMeta& meta,
                      const BuildPlan& plan, const PlannedImages& images) {
  const PlanetMeta& before = finished.meta;
  require_equal_planets(finished.path, before, meta);
  PatchStart start{
      finished.path, before.identity, {}, {}, {}, numbers_now(finished.path, before.sources, meta.sources)};
  try {
    start.kept = kept_tiles({finished.rows, finished.with_nodata}, plan, meta, patched.elevation_changes);
  } catch (const std::runtime_error& e) {
    refuse(finished.path, std::string(e.what()) + "; build the planet again");
  }
  for (const NodeRow& row : finished.rows)
    if (!start.kept.contains(*lod::unpack(row.key))) start.dropped.push_back(row.key);

  std::set<std::int64_t> images_now;
  numbers_now(finished.path, before.image_sources, meta.image_sources);
  for (const lod::TileKey& key : images.composed)
    if (!patched.image_changes(surroundings(key, kImageIntervals))) images_now.insert(lod::pack(key));
  for (const std::int64_t key : finished.images)
    if (!images_now.contains(key)) start.dropped_images.push_back(key);
  plan_layer_tiles(finished, patched, meta, images.layers, start);
  return start;
}

}  // namespace paging
