#include "paging/planet/verify.h"

#include <mutex>

#include "paging/planet/check_meta.h"
#include "paging/planet/sqlite.h"
#include "paging/planet/verify_tile.h"
#include "vpe/base/parallel.h"

namespace paging {

namespace {

void check_layer_rows(const PlanetMeta& meta, const Database& db, VerifyReport& report) {
  if (meta.image_layers.empty()) return;
  std::vector<ImageLayer> found = meta.image_layers;
  for (ImageLayer& layer : found) layer.bytes = 0;
  Statement rows(db, "SELECT layer, length(data) FROM image_layer");
  while (rows.step()) found.at(static_cast<std::size_t>(rows.integer(0))).bytes += rows.integer(1);
  if (found != meta.image_layers)
    report.problems.push_back({"meta", "'image_layers' differs from what the tables hold"});
}

void check_database(const PlanetFile& planet, VerifyReport& report) {
  try {
    Database db = planet.connect();
    Statement check(db, "PRAGMA integrity_check(5)");
    while (check.step()) {
      if (check.text(0) != "ok") report.problems.push_back({"database", check.text(0)});
    }
    if (content_identity(db) != planet.meta().identity) {
      report.problems.push_back({"meta", "the identity does not match the content"});
    }
    std::int64_t meshes = 0;
    std::int64_t variants = 0;
    for (const lod::TileInfo& tile : planet.tree().tiles()) {
      variants += static_cast<std::int64_t>(tile.variants.size());
      meshes += static_cast<std::int64_t>(tile.variants.size()) - (tile.has_children ? 0 : 1);
    }
    const auto posts = static_cast<std::size_t>(planet.meta().tile.post_count());
    const auto expect_rows = [&](const char* table, std::int64_t count) {
      const std::int64_t found = db.integer(std::string("SELECT count(*) FROM ") + table);
      if (found == count) return;
      report.problems.push_back({table, std::to_string(found) + " rows instead of " + std::to_string(count)});
    };
    expect_rows("node", planet.meta().tiles);
    expect_rows("heights", planet.meta().tiles);
    expect_rows("variant", variants);
    expect_rows("mesh", meshes);
    expect_rows("image", planet.meta().image_tiles);
    check_layer_rows(planet.meta(), db, report);
    for (const std::string& wrong :
         wrong_meta(planet.meta(), planet.tree().tiles(), summarize_levels(db, posts)))
      report.problems.push_back({"meta", wrong});
    if (const std::string wrong = wrong_resampling(planet, db); !wrong.empty())
      report.problems.push_back({"resampling", wrong});
  } catch (const std::runtime_error& e) {  // DatabaseError, PlanetError, CodecError
    report.problems.push_back({"database", e.what()});
  }
}

// An image tile of a planet that shows one layer alone.
struct LayerImage {
  std::shared_ptr<const PlanetFile> planet;
  lod::TileKey key;
};

std::vector<LayerImage> layer_images(const PlanetFile& planet) {
  std::vector<LayerImage> images;
  for (const ImageLayer& layer : planet.meta().image_layers) {
    vpe::core::ImageLayerLook look;
    look.name = layer.name;
    const auto alone = planet.with_images({look});
    for (const lod::TileKey& key : alone->image_keys()) images.push_back({alone, key});
  }
  return images;
}

void add(const TileFindings& tile, VerifyReport& all) {
  all.problems.insert(all.problems.end(), tile.report.problems.begin(), tile.report.problems.end());
  all.tiles += tile.report.tiles;
  all.meshes += tile.report.meshes;
  all.borders += tile.report.borders;
  all.images += tile.report.images;
  all.measured += tile.report.measured;
  all.largest_share = std::max(all.largest_share, tile.report.largest_share);
}

}  // namespace

VerifyReport verify(const PlanetFile& planet, const VerifyOptions& options, const VerifyProgress& progress) {
  VerifyReport report;
  if (!planet.is_patched()) check_database(planet, report);

  const auto tiles = planet.tree().tiles();
  const std::vector<lod::TileKey> images = planet.image_keys();
  const std::vector<LayerImage> layers = layer_images(planet);
  std::vector<const lod::TileInfo*> deep;
  {
    std::vector<const lod::TileInfo*> leaves;
    for (const lod::TileInfo& tile : tiles) {
      if (!tile.has_children) leaves.push_back(&tile);
    }
    const std::size_t count = std::min(options.deep_tiles, leaves.size());
    for (std::size_t n = 0; n < count; ++n) deep.push_back(leaves[n * leaves.size() / count]);
  }

  const std::size_t after_images = tiles.size() + images.size();
  const std::size_t total = after_images + layers.size() + deep.size();
  std::vector<TileFindings> found(total);
  std::mutex mutex;
  std::size_t done = 0;
  vpe::base::parallel_for(total, options.threads > 0 ? options.threads : vpe::base::default_threads(),
                          [&](std::size_t n) {
                            if (n < tiles.size()) {
                              found[n] = check_tile(planet, tiles[n]);
                            } else if (n - tiles.size() < images.size()) {
                              found[n] = check_image(planet, images[n - tiles.size()]);
                            } else if (n - after_images < layers.size()) {
                              const LayerImage& at = layers[n - after_images];
                              found[n] = check_image(*at.planet, at.key);
                            } else {
                              found[n] = measure_tile(planet, *deep[n - after_images - layers.size()]);
                            }
                            if (!progress) return;
                            const std::lock_guard lock(mutex);
                            progress(static_cast<double>(++done) / static_cast<double>(total));
                          });
  for (const TileFindings& tile : found) add(tile, report);
  return report;
}

}  // namespace paging
