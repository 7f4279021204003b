// Overlays of panoramas: gives vpe/overlay the planet, the files and the map that it needs.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "objects/scene/scene.h"
#include "paging/planet/planet_file.h"
#include "paging/surface/surface.h"
#include "panorama/projection.h"
#include "panorama/stereo_eyes.h"
#include "vpe/app/panorama/panorama_request.h"
#include "vpe/base/parallel.h"
#include "vpe/core/appearance/gazetteer.h"
#include "vpe/overlay/features/area_pixels.h"
#include "vpe/overlay/features/panorama_lines.h"
#include "vpe/overlay/panorama_overlay.h"
#include "vpe/overlay/sprites.h"

namespace vpe::app {

// Makes the paths of the names file and of vector files absolute, so that the recipe is valid in any folder, and stores
// their checksums in the request. Throws UsageError for overlays that panoramas do not have, what
// core::read_gazetteer() throws, and std::runtime_error if the request has another checksum already: the overlays
// would differ from those of the sidecar's image.
void resolve_overlays(PanoramaRequest& request);

// Draws the overlays of a panorama. First come areas and lines of vector layers, in the image of each eye by its own place;
// then all others, which are the same for both eyes. Use it from one thread at a time. References are kept.
class PanoramaOverlays {
 public:
  // Reads the files of names and layers; defers all other work until it is needed. Holds at most `memory_bytes` of terrain,
  // and releases it once the labels are placed; of what is draped, a quarter of that.
  PanoramaOverlays(const PanoramaRequest& request, const panorama::PanoramaMap& map,
                   std::shared_ptr<const paging::PlanetFile> planet, base::ThreadPool& pool,
                   std::size_t memory_bytes);

  // Places all overlays, once. Does nothing if no overlay is set. Throws what paging::Surface throws.
  void prepare();

  // Returns the names that stand in the image, whether or not there was room for them. Call prepare() first.
  const std::vector<overlay::PanoramaName>& names() const { return names_; }

  // Returns whether fill() does anything. Then it needs ranges.
  bool has_areas() const;
  // Lays the areas of vector layers over pixels that a view draws, whose camera is the eye.
  void fill(const core::View& view, const overlay::PixelBlock& block);
  // Draws the lines and points of vector layers over a region of the image of an eye; nullopt: of the only one.
  void drape(std::optional<panorama::Eye> eye, const overlay::ImageRegion& region);
  // Returns the bytes that are held while the image is drawn.
  std::size_t held_bytes() const;

  // Draws over a region of the image. The division into regions changes no pixel. Throws what
  // overlay::SpriteLayer and paging::Surface throw.
  void lay(const overlay::ImageRegion& region);

 private:
  overlay::SpriteLayer lay_out();
  double unit() const;
  overlay::PanoramaLines& lines(std::optional<panorama::Eye> eye);
  void load_layers();
  void mark_areas(std::vector<overlay::LayerUse>& uses) const;
  void add_layers(overlay::PanoramaScene& scene);

  const PanoramaRequest& request_;
  const panorama::PanoramaMap& map_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  base::ThreadPool& pool_;
  std::size_t memory_bytes_;
  std::vector<core::Place> places_;
  std::vector<overlay::PanoramaName> names_;
  std::optional<overlay::SpriteLayer> sprites_;
  std::vector<overlay::SceneLayer> layers_;
  std::unique_ptr<paging::Surface> surface_;  // if there are layers
  std::shared_ptr<const objects::Scene> objects_;
  std::array<std::unique_ptr<overlay::PanoramaLines>, 3>
      lines_;  // of the left eye, the right one, and the middle
};

}  // namespace vpe::app
