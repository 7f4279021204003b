// Colours of a flat map: shaded terrain in the colours of elevation, or imagery.
#pragma once

#include <memory>
#include <span>

#include "paging/shading/terrain_shader.h"
#include "vpe/base/parallel.h"
#include "vpe/core/image/image.h"
#include "vpe/explore/measure/map_layers.h"
#include "vpe/explore/measure/map_view.h"

namespace vpe::explore {

enum class MapStyle { kElevation, kImagery };

// Paints maps of one planet. For one thread at a time.
class MapPainter {
 public:
  MapPainter(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes);

  // Paints a map with light from the north-west at 45 degrees everywhere, except on imagery that is known to hold its
  // own light. Areas beyond the poles are grey,
  // areas of nodata black. Over that are layers, see paint_map_layers(). Pixels do not depend on the pool. Throws paging::PlanetError.
  core::RgbImage paint(const MapView& map, MapStyle style, base::ThreadPool& pool,
                       std::span<const MapLayer> layers = {});

 private:
  std::shared_ptr<const paging::PlanetFile> planet_;
  paging::TerrainShader shader_;
  std::shared_ptr<const core::ColourScale> scale_;
};

}  // namespace vpe::explore
