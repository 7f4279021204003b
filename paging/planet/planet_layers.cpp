// Imagery composed of layers: PlanetFile::with_images(). planet_tiles.cpp reads their tiles.
#include <algorithm>
#include <utility>

#include "paging/planet/planet_connection.h"
#include "paging/planet/planet_look.h"
#include "paging/planet/planet_overlay.h"

namespace paging {

void PlanetFile::read_layer_keys(const Database& db) {
  const auto damage = [this](const std::string& what) {
    return PlanetError(path_ + ": damaged: " + what + "; build the planet file again");
  };
  if (meta_.image_layers.empty()) return;
  if (!has_table(db, "image_layer")) throw damage("the table of image layers is missing");
  auto all = std::make_shared<std::vector<std::vector<std::int64_t>>>(meta_.image_layers.size());
  Statement rows(db, "SELECT layer, key FROM image_layer ORDER BY layer, key");
  while (rows.step()) {
    const std::int64_t layer = rows.integer(0);
    if (layer < 0 || layer >= static_cast<std::int64_t>(all->size()))
      throw damage("a tile of an image layer that does not exist");
    if (!lod::unpack(rows.integer(1))) throw damage("a layer's tile that does not exist");
    (*all)[static_cast<std::size_t>(layer)].push_back(rows.integer(1));
  }
  for (std::size_t n = 0; n < all->size(); ++n) {
    const ImageLayer& layer = meta_.image_layers[n];
    int finest = -1;
    for (const std::int64_t row : (*all)[n]) finest = std::max(finest, lod::unpack(row)->level);
    if (static_cast<std::int64_t>((*all)[n].size()) != layer.tiles || finest != layer.finest_level)
      throw damage("tiles of the image layer '" + layer.name + "' are missing");
    if (finest > meta_.finest_image_level) throw damage("the image layer '" + layer.name + "' is too fine");
  }
  layer_keys_ = std::move(all);
}

std::shared_ptr<const PlanetFile> PlanetFile::with_images(
    std::vector<vpe::core::ImageLayerLook> layers, const std::shared_ptr<const PlanetFile>& former) const {
  if (const std::string problem = layers_problem(vpe::core::image_layers_text(layers), meta_); !problem.empty())
    throw PlanetError(path_ + ": " + problem);
  const PlanetFile& before = former ? *former : *this;
  if (layers == shown_layers_ && (&before == this || (before.shown_layers_ == layers && is_same_file(before) &&
                                                      before.images_version_ == images_version_)))
    return shared_from_this();
  return std::shared_ptr<const PlanetFile>(new PlanetFile(*this, std::move(layers), before));
}

// A number of an earlier choice never comes back: with patches between both, the larger number of image and ground would
// name two contents.
PlanetFile::PlanetFile(const PlanetFile& base, std::vector<vpe::core::ImageLayerLook> layers,
                       const PlanetFile& former)
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
      earlier_(base.earlier_),
      compared_version_(base.compared_version_),
      layer_keys_(base.layer_keys_),
      shown_layers_(std::move(layers)),
      ground_version_(base.ground_version_),
      images_version_(version_) {
  if (former.shown_layers_ == shown_layers_ && is_same_file(former)) {
    images_version_ = former.images_version_;
    if (former.composed_keys_) composed_keys_ = former.composed_keys_;
  }
  if (shown_layers_.empty() || composed_keys_) return;
  std::vector<std::int64_t> keys;
  for (int face = 0; face < mars::kFaces; ++face)
    keys.push_back(lod::pack({static_cast<mars::Face>(face), 0, 0, 0}));
  for (const vpe::core::ImageLayerLook& look : shown_layers_) {
    if (look.opacity == 0) continue;
    const auto layer = std::ranges::find(meta_.image_layers, look.name, &ImageLayer::name);
    const auto& own = (*layer_keys_)[static_cast<std::size_t>(layer - meta_.image_layers.begin())];
    keys.insert(keys.end(), own.begin(), own.end());
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  composed_keys_ = std::make_shared<const std::vector<std::int64_t>>(std::move(keys));
}

}  // namespace paging
