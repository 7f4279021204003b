// Planets for the benchmark of rays: a square patch of fine fractal ground with craters on a coarse planet.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"

namespace bench {

// A patch is one tile's place, covered by finest tiles `levels_below` it.
struct PatchSpec {
  std::string name;  // posts a side
  lod::TileKey patch;
  int levels_below = 0;
  double relief_cells = 0;  // highest less lowest, in post spacings
};

// 513^2 and 2049^2 posts 20 m apart, 8193^2 posts 5 m apart; relief 64, 160 and 336 cells.
const std::vector<PatchSpec>& patch_specs();

struct RayScene {
  std::string name;
  std::shared_ptr<const paging::PlanetFile> planet;
  glm::dvec3 middle{1, 0, 0};  // direction over which eyes stand
};

// Opens the scene's planet file in `folder`, or builds it there (says so on stderr). Beside the patch, posts
// get coarser from level to level down to some 5 km. The same bits on every machine. Throws what build_planet()
// does.
RayScene patch_scene(const PatchSpec& spec, const std::filesystem::path& folder, int threads);

// Any planet file, eyes over its Valles Marineris.
RayScene planet_scene(const std::string& name, const std::string& file);

}  // namespace bench
