#include "paging/planet/planet_file.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "paging/planet/check_meta.h"
#include "paging/planet/planet_connection.h"
#include "paging/planet/planet_overlay.h"
#include "paging/planet/planet_user.h"
#include "vpe/base/number.h"

namespace paging {

std::shared_ptr<const PlanetFile> PlanetFile::open(const std::string& path, BeforeRead before_read) {
  return std::shared_ptr<const PlanetFile>(new PlanetFile(path, std::move(before_read)));
}

PlanetFile::~PlanetFile() = default;

std::uint64_t PlanetFile::next_version() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

PlanetFile::PlanetFile(const std::string& path, BeforeRead before_read)
    : path_(path),
      before_read_(std::move(before_read)),
      version_(next_version()),
      connections_([this] { return std::make_unique<Connection>(*this); },
                   {.reset = [](Connection& connection) { connection.reset(); }}),
      ground_version_(version_) {
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

// Another planet of the same pages: it reads through the connections of this one.
PlanetFile::PlanetFile(const PlanetFile& base, std::shared_ptr<const PlanetFile> earlier)
    : path_(base.path_),
      before_read_(base.before_read_),
      meta_(base.meta_),
      meta_checksum_(base.meta_checksum_),
      tree_(base.tree_),
      image_keys_(base.image_keys_),
      mask_keys_(base.mask_keys_),
      nodata_keys_(base.nodata_keys_),
      version_(next_version()),
      file_(base.file_ ? base.file_ : base.shared_from_this()),
      overlay_(base.overlay_),
      connections_([this] { return std::make_unique<Connection>(*this); }),
      earlier_(std::move(earlier)),
      compared_version_(version_),
      layer_keys_(base.layer_keys_),
      shown_layers_(base.shown_layers_),
      composed_keys_(base.composed_keys_),
      ground_version_(version_),
      images_version_(base.images_version_) {}

std::shared_ptr<const PlanetFile> PlanetFile::compared_with(std::shared_ptr<const PlanetFile> earlier) const {
  require_comparable(*earlier, *this);
  return std::shared_ptr<const PlanetFile>(new PlanetFile(*this, std::move(earlier)));
}

void require_comparable(const PlanetFile& earlier, const PlanetFile& later) {
  const PlanetMeta& a = earlier.meta();
  const PlanetMeta& b = later.meta();
  const auto refuse = [&](const std::string& what, const std::string& of_a, const std::string& of_b) {
    throw PlanetError(earlier.path() + ": cannot be compared with " + later.path() + ": " + what + " is " +
                      of_a + ", and there " + of_b + "; build both planets alike");
  };
  const auto metres = [](double m) { return vpe::base::format_number(m) + " m"; };
  if (a.body != b.body) refuse("its body", a.body, b.body);
  if (a.radius_m != b.radius_m) refuse("its radius", metres(a.radius_m), metres(b.radius_m));
  if (a.shape != b.shape) refuse("its shape", a.shape, b.shape);
  if (!(a.datum == b.datum)) refuse("the datum of its heights", to_string(a.datum), to_string(b.datum));
}

Database PlanetFile::connect() const {
  if (is_patched()) {
    throw PlanetError(path_ +
                      ": is patched in memory, and so has no file of its own; connect to the planet under it");
  }
  Database db = open_planet_database(path_);
  Statement sum(db, "SELECT value FROM meta WHERE key = ?");
  if (!sum.bind(1, std::string_view(kMetaChecksumKey)).step() || sum.text(0) != meta_checksum_)
    throw replaced(path_);
  return db;
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
    tiles.push_back(tile_info(std::move(row)));
  }
  if (static_cast<std::int64_t>(tiles.size()) != meta_.tiles) {
    throw damage(std::to_string(tiles.size()) + " of " + std::to_string(meta_.tiles) +
                 " tiles are in the index");
  }
  try {
    tree_ = std::make_shared<const lod::TileTree>(std::move(tiles), meta_.tile, meta_.radius_m,
                                                  meta_.lowest_radius_m);
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
    mask_keys_.push_back(masks.integer(0));
  }
  set_nodata();
  read_layer_keys(db);
}

void PlanetFile::set_nodata() {
  std::sort(mask_keys_.begin(), mask_keys_.end());
  nodata_keys_ = mask_keys_;
  for (const std::int64_t row : mask_keys_) {
    for (lod::TileKey at = *lod::unpack(row); at.level > 0;)
      nodata_keys_.push_back(lod::pack(at = lod::parent(at)));
  }
  std::sort(nodata_keys_.begin(), nodata_keys_.end());
  nodata_keys_.erase(std::unique(nodata_keys_.begin(), nodata_keys_.end()), nodata_keys_.end());
}

bool PlanetFile::has_nodata(const lod::TileKey& key) const {
  return std::binary_search(nodata_keys_.begin(), nodata_keys_.end(), lod::pack(key));
}

std::optional<lod::TileKey> PlanetFile::image_key(const lod::TileKey& key) const {
  for (int level = std::min(key.level, meta_.finest_image_level); level >= 0; --level) {
    const lod::TileKey candidate = lod::ancestor(key, level);
    if (std::ranges::binary_search(shown_image_keys(), lod::pack(candidate))) return candidate;
  }
  return std::nullopt;
}

std::vector<lod::TileKey> PlanetFile::image_keys() const {
  std::vector<lod::TileKey> keys;
  for (const std::int64_t row : shown_image_keys()) {
    if (const auto key = lod::unpack(row)) keys.push_back(*key);
  }
  return keys;
}

}  // namespace paging
