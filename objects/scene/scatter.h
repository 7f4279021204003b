// Rocks scattered over a polygon.
//
// Rock n depends on the seed and on n alone, so that fewer rocks are the first ones of more. The result is the
// same on every machine but for rounding in functions such as sine (some 1e-15 of each number).
//
// Typical usage:
//   for (const Scattered& rock : scatter(entry, sizes_of(models), mars::kMarsRadius_m))
//     place_instance(rock.placing, 0.5 * rock.diameter_m, mars::kMarsRadius_m, ground);
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "objects/files/scene_file.h"

namespace objects {

// Describes the ball around a model, in metres of the model at scale 1.
struct RockModel {
  double diameter_m = 1;  // above 0
  glm::dvec3 centre_m{0, 0, 0};
};

struct Scattered {
  std::size_t model = 0;  // of SceneFile::models
  Placing placing;        // scale = diameter / the model's diameter; heights are above the ground
  double diameter_m = 0;
};

// Returns how many rocks an entry asks for: its polygon's area on the sphere times the number for a square
// metre. Throws std::runtime_error "FILE:LINE: what" if its corners are farther than 75 degrees from their
// middle, or enclose nothing.
double expected_rocks(const ScatterEntry& entry, double planet_radius_m);

// Returns the rocks of an entry, as many as expected, rounded up or down by chance; at most entry.most.
// `models` has one for each of SceneFile::models. They lie uniformly by area. Throws as expected_rocks(), and
// if entry.most is 0 and more than kMostInstances are expected.
std::vector<Scattered> scatter(const ScatterEntry& entry, std::span<const RockModel> models,
                               double planet_radius_m);

}  // namespace objects
