// Overlays of panoramas: gives vpe/overlay the planet, the files and the map that it needs.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"
#include "panorama/projection.h"
#include "vpe/app/panorama/panorama_request.h"
#include "vpe/base/parallel.h"
#include "vpe/core/appearance/gazetteer.h"
#include "vpe/overlay/panorama_overlay.h"
#include "vpe/overlay/sprites.h"

namespace vpe::app {

// Makes the path of the names file absolute, so that the recipe is valid in any folder, and stores the file's
// checksum in request.names_checksum. Throws UsageError for overlays that panoramas do not have, what
// core::read_gazetteer() throws, and std::runtime_error if the request has another checksum already: the names
// would differ from those of the sidecar's image.
void resolve_overlays(PanoramaRequest& request);

// Draws the overlays of one eye's image. Use it from one thread at a time. References are kept.
class PanoramaOverlays {
 public:
  // Reads the names file; defers all other work until it is needed. Holds at most `memory_bytes` of terrain,
  // and releases it once the labels are placed.
  PanoramaOverlays(const PanoramaRequest& request, const panorama::PanoramaMap& map,
                   std::shared_ptr<const paging::PlanetFile> planet, base::ThreadPool& pool,
                   std::size_t memory_bytes);

  // Places all overlays, once. Does nothing if no overlay is set. Throws what paging::Surface throws.
  void prepare();

  // Returns the names that stand in the image, whether or not there was room for them. Call prepare() first.
  const std::vector<overlay::PanoramaName>& names() const { return names_; }

  // Draws over a region of the image. The division into regions changes no pixel. Throws what
  // overlay::SpriteLayer and paging::Surface throw.
  void lay(const overlay::ImageRegion& region);

 private:
  overlay::SpriteLayer lay_out();

  const PanoramaRequest& request_;
  const panorama::PanoramaMap& map_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  base::ThreadPool& pool_;
  std::size_t memory_bytes_;
  std::vector<core::Place> places_;
  std::vector<overlay::PanoramaName> names_;
  std::optional<overlay::SpriteLayer> sprites_;
};

}  // namespace vpe::app
