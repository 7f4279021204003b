// A patch that turns one planet file into another, for tests of patched planets.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "paging/planet/tile_patch.h"
#include "tests/paging/planet_fixture.h"

namespace test_support {

// Holds all that a planet file stores of a tile or an image tile.
struct StoredTiles {
  std::map<std::int64_t, paging::PatchTile> tiles;
  std::map<std::int64_t, paging::Bytes> images;
};

inline StoredTiles read_stored(const paging::PlanetFile& planet) {
  StoredTiles out;
  const paging::Database db = planet.connect();
  std::vector<paging::NodeRow> rows;
  EXPECT_FALSE(paging::read_nodes(db, rows));
  for (paging::NodeRow& row : rows) {
    const std::int64_t key = row.key;
    out.tiles[key].row = std::move(row);
  }
  const auto each = [&](const std::string& sql, const auto& put) {
    paging::Statement statement(db, sql);
    while (statement.step()) {
      const auto blob = statement.blob(1);
      put(statement.integer(0), paging::Bytes(blob.begin(), blob.end()));
    }
  };
  using paging::Bytes;
  each("SELECT key, data FROM heights",
       [&](std::int64_t k, Bytes b) { out.tiles[k].payload.heights = std::move(b); });
  each("SELECT key, data FROM missing",
       [&](std::int64_t k, Bytes b) { out.tiles[k].payload.nodata = std::move(b); });
  each("SELECT key, data FROM origin",
       [&](std::int64_t k, Bytes b) { out.tiles[k].payload.origin = std::move(b); });
  each("SELECT key, data FROM mesh ORDER BY key, variant",
       [&](std::int64_t k, Bytes b) { out.tiles[k].payload.meshes.push_back(std::move(b)); });
  each("SELECT key, data FROM image", [&](std::int64_t k, Bytes b) { out.images[k] = std::move(b); });
  for (const paging::TileResampling& row : paging::read_resampling(db))
    out.tiles[row.key].resampling.push_back(row.of);
  return out;
}

inline bool same_stored(const paging::PatchTile& a, const paging::PatchTile& b) {
  const auto posts = [](const paging::NodeRow& row) { return row.posts_terms ? posts_checksum(row) : 0; };
  return checksum(a.row) == checksum(b.row) && posts(a.row) == posts(b.row) &&
         a.payload.heights == b.payload.heights && a.payload.nodata == b.payload.nodata &&
         a.payload.origin == b.payload.origin && a.payload.meshes == b.payload.meshes &&
         a.resampling == b.resampling;
}

// Returns the tiles of `to` that `from` does not have, or has otherwise.
inline std::shared_ptr<paging::TilePatch> patch_between(const paging::PlanetFile& from,
                                                        const paging::PlanetFile& to) {
  const StoredTiles a = read_stored(from);
  const StoredTiles b = read_stored(to);
  auto patch = std::make_shared<paging::TilePatch>();
  patch->meta = to.meta();
  for (const auto& [key, tile] : b.tiles) {
    const auto there = a.tiles.find(key);
    if (there == a.tiles.end() || !same_stored(there->second, tile)) patch->tiles.push_back(tile);
  }
  for (const auto& [key, jpeg] : b.images) {
    const auto there = a.images.find(key);
    if (there == a.images.end() || there->second != jpeg) patch->images.push_back({key, jpeg});
  }
  return patch;
}

inline bool patches(const paging::TilePatch& patch, const lod::TileKey& key) {
  return std::ranges::any_of(patch.tiles, [&](const auto& tile) { return tile.row.key == lod::pack(key); });
}

// Cap in which the planets below differ: near a corner of the cube, so across three faces.
inline const glm::dvec3 kPatched = glm::normalize(glm::dvec3(1.02, 1, 0.98));
inline constexpr double kPatchedReach_rad = 0.03;

// Describes how a planet differs from the one without a patch, within the reach.
struct PlanetChange {
  double raised_m = 0;                  // in the middle
  bool is_finer = false;                // its finest tiles are divided once more
  bool has_nodata = false;              // no data in the middle
  bool has_image = false;               // both planets have one
  bool is_painted = false;              // the image is another one
  std::optional<mars::Cap> tower = {};  // 20 km higher
};

class ChangedImage : public FakeImage {
 public:
  explicit ChangedImage(bool is_painted) : is_painted_(is_painted) {}
  void sample(std::span<const glm::dvec3> directions, double spacing_m, std::span<vpe::base::Rgb> colours,
              std::span<std::uint8_t> alpha) const override {
    FakeImage::sample(directions, spacing_m, colours, alpha);
    for (std::size_t n = 0; is_painted_ && n < directions.size(); ++n)
      if (glm::length(directions[n] - kPatched) < kPatchedReach_rad) colours[n] = {250, 40, 90};
  }

  double spacing_in(const mars::Cap& cap) const override {
    return glm::length(cap.centre - kPatched) < cap.radius_rad + 2 * kPatchedReach_rad ? 8000 : 100000;
  }

 private:
  bool is_painted_;
};

inline std::shared_ptr<const paging::PlanetFile> build_changed(
    const std::filesystem::path& path, const PlanetChange& change,
    paging::PlanetFile::BeforeRead before_read = {}) {
  const auto height = [change](const glm::dvec3& d) {
    const double share = glm::length(d - kPatched) / kPatchedReach_rad;
    if (change.has_nodata && share < 0.3) return std::numeric_limits<double>::quiet_NaN();
    if (change.tower && glm::length(d - change.tower->centre) < change.tower->radius_rad)
      return bumpy_height(d) + 20000;
    // A cliff, so that normals and shadows beyond the reach change, too.
    return bumpy_height(d) + (share < 1 ? change.raised_m * (1 - 0.5 * share) : 0);
  };
  const auto spacing = [change](const mars::Cap& cap) {
    const double distance = glm::length(cap.centre - kPatched) - cap.radius_rad;
    if (change.is_finer && distance < 0.5 * kPatchedReach_rad) return 4000.0;
    return distance < 3 * kPatchedReach_rad ? 9000.0 : 1e9;
  };
  paging::BuildOptions options;
  options.output = path.string();
  options.base_spacing_m = 120000;
  options.threads = 2;
  options.tile_k = 4;
  options.resampling_posts = 5000;
  const ChangedImage image(change.is_painted);
  paging::build_planet(options, FakeElevation(height, spacing), change.has_image ? &image : nullptr);
  return paging::PlanetFile::open(options.output, std::move(before_read));
}

}  // namespace test_support
