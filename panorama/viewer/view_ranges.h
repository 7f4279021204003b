// The distances that a view of a panorama shows, from its auxiliary layer "range".
#pragma once

#include <optional>
#include <vector>

#include "panorama/image/raster_plane.h"
#include "panorama/metadata/open_panorama.h"
#include "vpe/core/view.h"

namespace panorama {

// Returns whether a panorama has the layer "range".
bool has_ranges(const PanoramaDescription& description);

// Opens the layer "range" of a panorama; nullopt if it has none. Throws vpe::base::FileError.
std::optional<PlaneReader> open_ranges(const PanoramaDescription& description, std::size_t budget_bytes);

// Returns for each pixel of a view, whose axes are in the panorama's frame, the value of the pixel of the panorama that is nearest
// to its direction: metres along the line of sight, vpe::core::kSkyRange where that is no positive number or the panorama shows
// nothing. Row by row from the top. Throws vpe::base::FileError.
std::vector<float> view_ranges(PlaneReader& ranges, const PanoramaMap& map, const vpe::core::View& view);

}  // namespace panorama
