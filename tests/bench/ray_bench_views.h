// Makes the views of ray_bench.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "tests/bench/ray_bench_scenes.h"
#include "vpe/core/view.h"

namespace bench {

struct RayCase {
  std::string name;  // such as 2049/pano/2m, 2049/p10/r15/1km: pitch -10, roll 15
  vpe::core::View view;
};

// Returns the views of a scene in the order of their cameras, all sides times `scale`:
//   pano  6000x2000, rows even in tan(elevation), +-30 degrees, from 2 m, 1 km, 10 km and 300 km above ground
//   pNN   perspective, 1920x1080, 60 degrees across, pitch -0.5 (p05), -10, -30, -60, -90, roll 0, 15, 45,
//         from 1 km
//   wan   perspective, 500x400, pitch -30 degrees, from 1 km
// Cameras look north-north-east, oblique to the grid. Whole planets are seen from 300 km only, in all three
// kinds.
std::vector<RayCase> ray_cases(const RayScene& scene, double scale);

}  // namespace bench
