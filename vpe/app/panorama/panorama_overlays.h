// Overlays of panoramas: what vpe/overlay needs of a planet, of files and of the map.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"
#include "panorama/projection.h"
#include "vpe/app/panorama/panorama_recipe.h"
#include "vpe/base/parallel.h"
#include "vpe/core/appearance/gazetteer.h"
#include "vpe/overlay/sprites.h"

namespace vpe::app {

// Makes the path of the names absolute, so that the recipe holds anywhere, and notes what the file says in
// recipe.names_checksum. Throws UsageError for overlays that panoramas do not have, what core::read_gazetteer()
// throws, and std::runtime_error when the recipe has another checksum: those names are not what was drawn.
void settle_overlays(PanoramaRecipe& recipe);

// One image of one eye. One thread at a time. References are kept.
class PanoramaOverlays {
 public:
  // Reads the names; nothing else is done before it is needed. The ground is held in `memory_bytes` at most,
  // and let go of once everything has its place.
  PanoramaOverlays(const PanoramaRecipe& recipe, const panorama::PanoramaMap& map,
                   std::shared_ptr<const paging::PlanetFile> planet, base::ThreadPool& pool,
                   std::size_t memory_bytes);

  // Gives everything its place, once; nothing when no overlay is set. Throws what paging::Surface throws.
  void prepare();

  // Over a part of the image. Which parts it is cut into changes no pixel. Throws what overlay::Decals and
  // paging::Surface throw.
  void lay(const overlay::ImageRegion& part);

 private:
  overlay::SpriteLayer lay_out() const;

  const PanoramaRecipe& recipe_;
  const panorama::PanoramaMap& map_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  base::ThreadPool& pool_;
  std::size_t memory_bytes_;
  std::vector<core::Place> places_;
  std::optional<overlay::SpriteLayer> sprites_;
};

}  // namespace vpe::app
