// The synthetic detail of the embedded Mars below the resolution of any elevation data of Mars.
//
// The detail of a spacing less that of the data's own spacing is added: what has wavelengths of less than two posts of the
// data. Its amplitude and kind follow from the carried data. Its mean over the area of a post is not zero, as it is for the
// carried data, but small: at most 1/20 of the distance of the posts (RMS).
#pragma once

#include <memory>
#include <span>
#include <string>

#include "mars/sources/source.h"

namespace mars {

// Begins the name of the source of detail below another source, whose name follows.
inline constexpr const char* kDetailBelow = "embedded-detail below ";

// Sets detail_m[i] to what is added at unit directions at posts of a spacing to data of another spacing. 0 where the posts
// are not finer than the data.
void detail_below(std::span<const glm::dvec3> directions, double spacing_m, double data_spacing_m,
                  std::span<double> detail_m);

// Returns the data with detail down to posts of finest_m wherever there are data. Its infos are those of the data, then one
// of the detail, which decides where posts are fine enough to show it.
std::shared_ptr<const ElevationSource> with_detail(std::shared_ptr<const ElevationSource> data,
                                                   double finest_m);

}  // namespace mars
