// Makes planets for ray_bench: a square patch of fine fractal ground with craters on a coarse planet.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"

namespace bench {

// Describes a patch: the area of one tile, covered by finest tiles `levels_below` it.
struct PatchSpec {
  std::string name;  // posts a side
  lod::TileKey patch;
  int levels_below = 0;
  double relief_cells = 0;  // highest less lowest, in post spacings
};

// Returns patches of 513^2 and 2049^2 posts 20 m apart and of 8193^2 posts 5 m apart, whose height range is 64,
// 160 and 336 post spacings.
const std::vector<PatchSpec>& patch_specs();

struct RayScene {
  std::string name;
  std::shared_ptr<const paging::PlanetFile> planet;
  glm::dvec3 middle{1, 0, 0};  // direction of the cameras
};

// Opens the scene's planet file in `folder`, or builds it there and reports this on stderr. Outside the patch,
// posts get coarser from level to level down to some 5 km. The file has the same bits on every machine. Throws
// what paging::build_planet() throws.
RayScene patch_scene(const PatchSpec& spec, const std::filesystem::path& folder, int threads);

// Opens any planet file, with cameras over Valles Marineris.
RayScene planet_scene(const std::string& name, const std::string& file);

}  // namespace bench
