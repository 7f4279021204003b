// Colours of an image at places between its pixels and levels. Private to panorama.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "panorama/viewer/level_grid.h"

namespace panorama {

// Filters an image. Keeps the tiles that it used last. For one thread.
class Sampler {
 public:
  Sampler(const TiledImage& image, const PanoramaMap& map, const ImageOrigin& origin);

  // Returns the mean over the parallelogram of `across` and `down` about `at`, all in pixels of the map's
  // image; each channel is 0 to 255.
  glm::vec3 mean(const glm::dvec2& at, const glm::dvec2& across, const glm::dvec2& down);

 private:
  struct Slot {
    int level = -1;
    std::int64_t column = 0;
    std::int64_t row = 0;
    std::shared_ptr<const Tile> tile;
  };

  const Tile& tile(int level, std::int64_t column, std::int64_t row);
  glm::vec3 pixel(int level, std::int64_t x, std::int64_t y);
  glm::vec3 between_pixels(int level, const glm::dvec2& at);
  glm::vec3 between_levels(double footprint_px, const glm::dvec2& at);

  const TiledImage& image_;
  std::vector<LevelGrid> levels_;
  std::array<Slot, 16> slots_;
};

}  // namespace panorama
