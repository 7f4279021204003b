// The picture of a fit: the photograph with the skyline found in it and that of the planet.
#pragma once

#include "panorama/match/skyline_match.h"
#include "vpe/core/image/image.h"

namespace panorama {

// Colours that readers with any colour vision can tell apart (Okabe and Ito 2008).
inline constexpr vpe::base::Rgb kFoundColour{0, 158, 255};     // the skyline of the photograph
inline constexpr vpe::base::Rgb kComputedColour{255, 140, 0};  // the skyline of the planet

// Draws both skylines into a copy of the photograph: the planet's as a line at the pose, the photograph's as dots over
// it. Dots are a pixel wide, and one more for each 1000 pixels of the width; the line is three times as wide. Without a pose of the match (MatchFailure::kFewColumns,
// kLittleRelief) only the dots are drawn. Pure; any thread.
vpe::core::RgbImage draw_fit(const vpe::core::RgbImage& photo, const PhotoShape& shape, const SkyLine& line,
                             const SkylineMatch& match, const SkylineProfile& profile);

}  // namespace panorama
