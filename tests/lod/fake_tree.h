// Synthetic planets: trees of tiles whose depth, heights and errors are functions of the key.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "lod/tree/tree.h"
#include "mars/geodesy/sphere.h"

namespace fake {

inline constexpr double kRadius_m = mars::kMarsRadius_m;

struct Planet {
  std::function<bool(const lod::TileKey&)> splits;  // has children?
  std::function<double(const lod::TileKey&)> height_m = [](const lod::TileKey&) { return 0.0; };  // middle
  double half_range_m = 0;  // of a finest tile's heights about its middle
  double error_ratio =
      512.0;                // a tile's error is its nominal side / this, sagitta that squared / (8 R) besides
  int finest_variants = 1;  // meshes of a finest tile besides the full grid, each of half the error,
  bool mixed_variants = false;  // one more for every second
};

inline lod::ErrorTerms terms(const Planet& planet, int level) {
  const double side = lod::nominal_side_m(level, kRadius_m);
  const double height_error = side / planet.error_ratio;
  const double sagitta = side * side / (8.0 * kRadius_m) / 64.0;
  return {height_error, sagitta, height_error + sagitta};
}

inline lod::TileInfo add(const Planet& planet, const lod::TileKey& key, std::vector<lod::TileInfo>& tiles) {
  lod::TileInfo info;
  info.key = key;
  info.has_children = planet.splits(key);
  if (info.has_children) {
    for (int c = 0; c < 4; ++c) {
      const lod::TileInfo below = add(planet, lod::child(key, c), tiles);
      info.min_height_m = c == 0 ? below.min_height_m : std::min(info.min_height_m, below.min_height_m);
      info.max_height_m = c == 0 ? below.max_height_m : std::max(info.max_height_m, below.max_height_m);
    }
    info.variants.push_back({terms(planet, key.level), 1000});
  } else {
    info.min_height_m = planet.height_m(key) - planet.half_range_m;
    info.max_height_m = planet.height_m(key) + planet.half_range_m;
    lod::ErrorTerms error = terms(planet, key.level);
    const int variants = planet.finest_variants + (planet.mixed_variants ? (key.i + key.j) & 1 : 0);
    for (int v = 0; v < variants; ++v) {
      info.variants.push_back({error, 1000U << v});
      error = {error.height_error_m / 2, error.sagitta_m / 2, error.total_m / 2};
    }
    info.variants.push_back({{}, 2 * 128 * 128});
  }
  tiles.push_back(info);
  return info;
}

inline std::vector<lod::TileInfo> tiles(const Planet& planet) {
  std::vector<lod::TileInfo> all;
  for (int face = 0; face < mars::kFaces; ++face) add(planet, {static_cast<mars::Face>(face), 0, 0, 0}, all);
  return all;
}

inline lod::TileTree tree(const Planet& planet) { return lod::TileTree(tiles(planet), {7}, kRadius_m); }

// Returns a smooth ball with all tiles of the levels 0..depth.
inline Planet uniform(int depth) {
  return {[depth](const lod::TileKey& key) { return key.level < depth; }};
}

// Returns a mountainous planet that is deeper around a pole, a cube corner, the antimeridian and the middle of
// +X.
inline Planet rough(int base, int deep) {
  Planet planet;
  planet.splits = [base, deep](const lod::TileKey& key) {
    if (key.level < base) return true;
    if (key.level >= deep) return false;
    const mars::Cap cap = lod::bounding_cap(key);
    for (const glm::dvec3 place :
         {glm::dvec3(0, 0, 1), glm::dvec3(1, 1, -1), glm::dvec3(-1, 0, 0.3), glm::dvec3(1, 0, 0)}) {
      if (mars::angle_between_rad(cap.centre, place) < 1.5 * cap.radius_rad) return true;
    }
    return false;
  };
  planet.height_m = [](const lod::TileKey& key) {
    const glm::dvec3 d = lod::bounding_cap(key).centre;
    return 7000.0 * std::sin(5 * d.x + 2) * std::cos(7 * d.y) + 1000.0 * std::sin(40 * d.z);
  };
  planet.half_range_m = 300.0;
  planet.finest_variants = 2;
  planet.mixed_variants = true;
  return planet;
}

}  // namespace fake
