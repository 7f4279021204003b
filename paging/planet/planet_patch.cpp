// Lays a patch over a planet: PlanetFile::with().
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <unordered_set>

#include "paging/planet/check_meta.h"
#include "paging/planet/planet_connection.h"
#include "paging/planet/planet_overlay.h"
#include "paging/planet/planet_user.h"
#include "vpe/core/frame.h"
#include "vpe/core/image/image.h"

namespace paging {

namespace {

constexpr int kEdgeSets = 16;

// Holds what is wrong with a patch; the planet's path is added where it is caught.
class WrongPatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

[[noreturn]] void refuse(const std::string& what) { throw WrongPatch(what); }
[[noreturn]] void refuse(const lod::TileKey& key, const std::string& what) {
  refuse("tile " + lod::to_string(key) + ": " + what);
}

lod::TileKey checked_key(std::int64_t row, const char* of) {
  const auto key = lod::unpack(row);
  if (!key) refuse("it has " + std::string(of) + " of key " + std::to_string(row) + ", which no tile has");
  return *key;
}

void check_patch_meta(const PlanetMeta& base, const PlanetMeta& meta) {
  if (meta.shard) refuse("it describes a part of a planet");
  if (meta.body != base.body || meta.shape != base.shape || !(meta.datum == base.datum) ||
      meta.radius_m != base.radius_m)
    refuse("it is of another body, radius or datum");
  if (meta.tile.k != base.tile.k || meta.quantum_m != base.quantum_m)
    refuse("its tiles have another shape or quantum");
  if (!std::isfinite(meta.lowest_radius_m) || !std::isfinite(meta.highest_radius_m))
    refuse("its bounds of the radius are not finite");
  if (meta.sources.size() < base.sources.size()) refuse("it lacks sources that the planet's tiles name");
}

void check_source_numbers(const PlanetMeta& base, const TilePatch& patch) {
  const std::vector<int>& numbers = patch.source_numbers;
  if (numbers.empty()) return;
  const bool ascends = std::ranges::adjacent_find(numbers, std::ranges::greater_equal()) == numbers.end();
  if (numbers.size() != base.sources.size() || !ascends || numbers.front() < 0 ||
      numbers.back() >= static_cast<int>(patch.meta.sources.size()))
    refuse("its numbers of the planet's sources are not one for each, ascending");
}

void check_row(const NodeRow& row, const lod::TileKey& key, const PlanetMeta& meta) {
  const auto sources = source_indices(row.sources);
  if (!sources ||
      std::ranges::any_of(*sources, [&](int n) { return n >= static_cast<int>(meta.sources.size()); }))
    refuse(key, "list of sources '" + row.sources + "'");
  if (!std::is_sorted(sources->begin(), sources->end())) refuse(key, "sources out of order");
  if (row.coarser_neighbour_mask < 0 || row.coarser_neighbour_mask >= kEdgeSets)
    refuse(key, "edges of no tile");
}

// Decodes everything, so that readers cannot meet a wrong payload.
void check_payload(const PatchTile& tile, const lod::TileKey& key, const PlanetMeta& meta) {
  const NodeRow& row = tile.row;
  const TilePayload& payload = tile.payload;
  const auto posts = static_cast<std::size_t>(meta.tile.post_count());
  const std::size_t meshes = row.variants.size() - (row.inner || row.variants.empty() ? 0 : 1);
  if (payload.meshes.size() != meshes) {
    refuse(key, std::to_string(payload.meshes.size()) + " meshes instead of " + std::to_string(meshes));
  }
  try {
    decode_heights(payload.heights, meta.tile.posts());
    if (!payload.nodata.empty()) decode_mask(payload.nodata, posts);
    if (!payload.origin.empty()) decode_numbers(payload.origin, posts, source_indices(row.sources)->size());
    for (std::size_t v = 0; v < meshes; ++v) {
      const PackedMesh mesh = decode_mesh(payload.meshes[v], mesh_intervals(meta.tile, row.inner));
      if (mesh.mesh.triangles.size() != 3 * std::size_t{row.variants[v].triangles})
        refuse(key, "mesh " + std::to_string(v) + " has another number of triangles than its row states");
    }
  } catch (const CodecError& e) {
    refuse(key, e.what());
  }
  for (const SourceResampling& of : tile.resampling) {
    if (of.source < 0 || of.source >= static_cast<int>(meta.sources.size()))
      refuse(key, "resampling error of no source");
  }
}

// Returns the tiles of the planet with the patch.
std::vector<lod::TileInfo> merged_tiles(const lod::TileTree& tree, const TilePatch& patch) {
  std::vector<lod::TileInfo> tiles(tree.tiles().begin(), tree.tiles().end());
  std::unordered_set<std::int64_t> keys;
  for (const PatchTile& tile : patch.tiles) {
    const lod::TileKey key = checked_key(tile.row.key, "a tile");
    if (!keys.insert(tile.row.key).second) refuse(key, "there twice");
    const lod::TileInfo* there = tree.find(key);
    if (there != nullptr && there->has_children && !tile.row.inner)
      refuse(key, "a finest tile in place of one with children");
    check_row(tile.row, key, patch.meta);
    check_payload(tile, key, patch.meta);
    if (there == nullptr) {
      tiles.push_back(tile_info(tile.row));
    } else {
      tiles[static_cast<std::size_t>(there - tree.tiles().data())] = tile_info(tile.row);
    }
  }
  return tiles;
}

std::vector<std::int64_t> merged_images(const std::vector<std::int64_t>& base, const TilePatch& patch) {
  std::vector<std::int64_t> keys = base;
  std::unordered_set<std::int64_t> own;
  for (const PatchImage& image : patch.images) {
    const lod::TileKey key = checked_key(image.key, "an image tile");
    if (!own.insert(image.key).second) refuse(key, "its image is there twice");
    try {
      const vpe::core::RgbImage texels =
          vpe::core::decode_jpeg(image.jpeg, std::int64_t{kImageIntervals + 1} * (kImageIntervals + 1));
      if (texels.width != kImageIntervals + 1 || texels.height != kImageIntervals + 1)
        refuse(key, "image of the wrong size");
    } catch (const WrongPatch&) {
      throw;
    } catch (const std::runtime_error& e) {
      refuse(key, e.what());
    }
    keys.push_back(image.key);
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  const auto has = [&](const lod::TileKey& key) {
    return std::binary_search(keys.begin(), keys.end(), lod::pack(key));
  };
  for (const PatchImage& image : patch.images) {
    const lod::TileKey key = *lod::unpack(image.key);
    if (key.level > 0 && !has(lod::parent(key))) refuse(key, "image without an image of its parent");
  }
  for (int face = 0; face < mars::kFaces && !patch.images.empty(); ++face) {
    const lod::TileKey root{static_cast<mars::Face>(face), 0, 0, 0};
    if (!has(root)) refuse(root, "image is missing");
  }
  return keys;
}

// Depends on the content of both, and not on the order of the tiles.
std::string patched_identity(const std::string& base, const TilePatch& patch) {
  std::vector<std::pair<std::int64_t, std::int64_t>> sums;
  for (const PatchTile& tile : patch.tiles) {
    const std::int64_t key = tile.row.key;
    const auto add = [&](std::int64_t sum) { sums.emplace_back(key, sum); };
    add(checksum(tile.row));
    if (tile.row.posts_terms) add(posts_checksum(tile.row));
    for (const Bytes* bytes : {&tile.payload.heights, &tile.payload.nodata, &tile.payload.origin})
      add(checksum(key, *bytes));
    for (std::size_t v = 0; v < tile.payload.meshes.size(); ++v)
      add(checksum(key + static_cast<std::int64_t>(v), tile.payload.meshes[v]));
    for (const SourceResampling& of : tile.resampling) add(checksum(TileResampling{key, of}));
  }
  std::stable_sort(sums.begin(), sums.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::pair<std::int64_t, std::int64_t>> images;
  for (const PatchImage& image : patch.images) images.emplace_back(image.key, checksum(image.key, image.jpeg));
  std::sort(images.begin(), images.end());
  PlanetMeta meta = patch.meta;
  meta.identity.clear();
  Bytes all(base.begin(), base.end());
  const auto put = [&](std::int64_t number) {
    for (int shift = 0; shift < 64; shift += 8)
      all.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> shift));
  };
  for (const auto* list : {&sums, &images}) {
    put(static_cast<std::int64_t>(list->size()));
    for (const auto& [key, sum] : *list) put(key), put(sum);
  }
  put(static_cast<std::int64_t>(patch.source_numbers.size()));
  for (const int number : patch.source_numbers) put(number);
  const std::string of_meta = to_rows(meta).at(kMetaChecksumKey);
  all.insert(all.end(), of_meta.begin(), of_meta.end());
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(checksum(kApplicationId, all)));
  return text;
}

}  // namespace

std::shared_ptr<const PlanetFile> PlanetFile::with(std::shared_ptr<const TilePatch> patch,
                                                   const std::shared_ptr<const PlanetFile>& former) const {
  try {
    if (!patch) refuse("there is none");
    return std::shared_ptr<const PlanetFile>(new PlanetFile(*this, std::move(patch), former.get()));
  } catch (const WrongPatch& e) {
    throw PlanetError(path_ + ": the patch cannot be laid over it: " + e.what() +
                      "; make the patch again, of this planet");
  }
}

PlanetFile::PlanetFile(const PlanetFile& base, std::shared_ptr<const TilePatch> patch, const PlanetFile* former)
    : path_(base.path_),
      before_read_(base.before_read_),
      meta_(patch->meta),
      mask_keys_(base.mask_keys_),
      version_(next_version()),
      file_(base.file_ ? base.file_ : base.shared_from_this()),
      connections_([this] { return std::make_unique<Connection>(*this); }),
      earlier_(base.earlier_),
      compared_version_(base.compared_version_),
      layer_keys_(base.layer_keys_),
      shown_layers_(base.shown_layers_),
      composed_keys_(base.composed_keys_),
      ground_version_(version_),
      images_version_(base.images_version_) {
  meta_.image_layers = base.meta_.image_layers;
  check_patch_meta(base.meta_, meta_);
  check_source_numbers(base.meta_, *patch);
  try {
    tree_ = std::make_shared<const lod::TileTree>(merged_tiles(*base.tree_, *patch), meta_.tile, meta_.radius_m,
                                                  meta_.lowest_radius_m);
  } catch (const WrongPatch&) {
    throw;
  } catch (const std::runtime_error& e) {
    refuse(e.what());
  }
  image_keys_ = merged_images(base.image_keys_, *patch);
  if (meta_.tiles != static_cast<std::int64_t>(tree_->size())) {
    refuse("its meta states " + std::to_string(meta_.tiles) + " tiles, and there are " +
           std::to_string(tree_->size()));
  }
  if (meta_.image_tiles != static_cast<std::int64_t>(image_keys_.size())) {
    refuse("its meta states " + std::to_string(meta_.image_tiles) + " image tiles, and there are " +
           std::to_string(image_keys_.size()));
  }
  if (const std::string wrong = unsafe_meta(meta_, tree_->tiles(), image_keys_); !wrong.empty()) refuse(wrong);
  meta_.identity = patched_identity(base.meta_.identity, *patch);

  std::unordered_set<std::int64_t> replaced;
  for (const PatchTile& tile : patch->tiles) replaced.insert(tile.row.key);
  std::erase_if(mask_keys_, [&](std::int64_t row) { return replaced.contains(row); });
  for (const PatchTile& tile : patch->tiles)
    if (!tile.payload.nodata.empty()) mask_keys_.push_back(tile.row.key);
  set_nodata();

  auto overlay =
      base.overlay_ ? std::make_shared<PlanetOverlay>(*base.overlay_) : std::make_shared<PlanetOverlay>();
  overlay->add(patch, version_);
  overlay->include_radius(base.meta_.lowest_radius_m, base.meta_.highest_radius_m);
  overlay->include_radius(meta_.lowest_radius_m, meta_.highest_radius_m);
  const bool can_share = former != nullptr && former->overlay_ && former->file_ == file_ &&
                         former->compared_version_ == compared_version_;
  if (can_share) overlay->follow(*former->overlay_, version_);
  if (former != nullptr && former->shown_layers_ != shown_layers_) images_version_ = version_;
  if (former != nullptr && former->shown_layers_ == shown_layers_ && is_same_file(*former))
    images_version_ = former->images_version_;
  overlay_ = std::move(overlay);
}

void change_planet(vpe::core::Renderer& renderer, std::shared_ptr<const PlanetFile> planet) {
  auto* user = dynamic_cast<PlanetUser*>(&renderer);
  if (user == nullptr) throw std::invalid_argument("this renderer cannot change its planet; make a new one");
  user->change_planet(std::move(planet));
}

void require_same_grid(const PlanetFile& from, const PlanetFile& to) {
  if (from.radius_m() == to.radius_m() && from.meta().tile.k == to.meta().tile.k) return;
  throw std::invalid_argument(to.path() + ": a planet of another radius or tile shape than " + from.path() +
                              "; open it anew");
}

}  // namespace paging
