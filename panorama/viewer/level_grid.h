// The pixels of an image's levels that a panorama shows, and which levels a footprint is drawn from.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "panorama/viewer/render_view.h"

namespace panorama {

// Describes the part of a level that a map shows. A place p of the map's image is at (p + origin) scale of the level.
struct LevelGrid {
  ImageLevel size;
  glm::dvec2 scale{1, 1};      // pixels of this level to one of the image
  glm::dvec2 origin_px{0, 0};  // of the map's image in the file's
  double reduction = 1;        // pixels of the image to one of this level, the larger of both sides
  std::int64_t turn = 0;       // columns of a full circle; 0 when the image is none
  std::int64_t left = 0;       // the part that the map describes, both ends included
  std::int64_t right = 0;
  std::int64_t top = 0;
  std::int64_t bottom = 0;

  // Returns the column that is drawn for x: beyond an end the other end of a full circle, else the end.
  std::int64_t wrapped(std::int64_t x) const;
};

// Returns the grids of all levels, from the image to the coarsest.
std::vector<LevelGrid> level_grids(const std::vector<ImageLevel>& levels, const PanoramaMap& map,
                                   const ImageOrigin& origin);

// Returns the coarsest level whose pixels are at most as wide as the footprint. It is mixed with the next one.
int level_of_footprint(std::span<const LevelGrid> grids, double footprint_px);

// Describes the area of the image that a pixel of a view covers.
struct Footprint {
  double thin_px = 1;     // width of each of its samples, at least 1
  double longest_px = 0;  // its longer side
  int samples = 1;        // along the longer side
};
// Limits the samples along the longer side.
inline constexpr double kMostSamples = 16;

// Returns the footprint of the parallelogram of `across` and `down`, in pixels of the image.
Footprint footprint_of(const glm::dvec2& across, const glm::dvec2& down);

}  // namespace panorama
