// Areas of features on the ground, as an image shows them.
#pragma once

#include "vpe/overlay/features/layer_use.h"
#include "vpe/overlay/ground_features.h"
#include "vpe/overlay/overlay.h"
#include "vpe/overlay/visible_terrain.h"

namespace vpe::overlay {

// Returns the longitudes and latitudes that an image shows, NaN for sky; of each pixel's middle.
struct ShownPlaces {
  std::vector<double> lon_deg;
  std::vector<double> lat_deg;
};
ShownPlaces shown_places(const VisibleTerrain& terrain);

// Returns an image of the fills of all areas, later ones over earlier ones, at an opacity. A pixel has the fill where the place
// on the ground at its middle is in the area; at the edges of areas on whole ground it has the share of four places in it.
// Areas outside of their style's range of scales are left out. Empty if the image shows none of them. Marks the styles of those
// that it shows in `use` unless it is null.
Layer fill_areas(const GroundFeatures& features, const VisibleTerrain& terrain, const ShownPlaces& places,
                 double opacity, LayerUse* use = nullptr);

}  // namespace vpe::overlay
