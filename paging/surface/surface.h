// S at run time: the exact surface of a planet file, sampled and cast against.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/base/lru_cache.h"

namespace paging {

// A finest tile ready for sampling and casting.
struct SurfaceTile {
  TileHeights data;
  lod::GridLines lines;
  double min_height_m = 0;
  double max_height_m = 0;
  // Largest height in each block of 2^b x 2^b cells, b = 1, 2, ..., k: block_max[b - 1], row by row.
  std::vector<std::vector<float>> block_max;

  std::size_t bytes() const;
};

struct SurfacePoint {
  double height_m = 0;         // above the sphere
  double radius_m = 0;         // from the planet's centre
  glm::dvec3 normal{0, 0, 1};  // of the facet, outward, body-fixed
  lod::TileKey tile;           // the finest tile there
  bool nodata = false;         // the nearest post has no source data
};

// Any thread may call any member. Results do not depend on the cache's state.
class Surface {
 public:
  // Keeps at most about `budget_bytes` of decoded tiles.
  Surface(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes);

  const PlanetFile& planet() const { return *planet_; }
  double planet_radius_m() const { return planet_->radius_m(); }

  // S at a direction (any length but 0). Error by rounding <= 4e-9 m * radius / 3.4e6 m. Throws PlanetError.
  // With an exaggeration: height, radius and normal of S as it is drawn.
  SurfacePoint at(const glm::dvec3& direction, double exaggeration = 1.0) const;

  // Radius of S at many directions; neighbours in the batch should be neighbours on the ground.
  void radius(std::span<const glm::dvec3> directions, std::span<double> radius_m,
              double exaggeration = 1.0) const;

  // Distance along the unit `direction` from `camera_m` (metres from the planet's centre) to the first point of
  // S; infinity when there is none. Exact on the flat triangles of S up to rounding (about 1e-9 relative plus
  // what a grazing facet makes of it); watertight: neighbouring facets are tested against the same lines.
  // A camera below S gives 0. With an exaggeration: of S as it is drawn. `part`: of the ray, metres along it;
  // where it begins below S that is the answer.
  struct RayPart {
    double begin_m = 0;
    double end_m = std::numeric_limits<double>::infinity();
  };
  double cast(const glm::dvec3& camera_m, const glm::dvec3& direction, double exaggeration,
              const RayPart& part) const;
  double cast(const glm::dvec3& camera_m, const glm::dvec3& direction, double exaggeration = 1.0) const {
    return cast(camera_m, direction, exaggeration, RayPart());
  }

  // Of a finest tile, or a coarser one's own posts. Throws PlanetError. With an exaggeration: S's posts as it is
  // drawn (PlanetFile::heights).
  std::shared_ptr<const SurfaceTile> tile(const lod::TileKey& key, double exaggeration = 1.0) const;
  std::size_t bytes_resident() const { return cache_.bytes() + exaggerated_.bytes(); }

  // Chart coordinate of the line between a tile's halves; index: i for u, j for v.
  double middle_line(int level, std::int32_t index) const;

 private:
  std::shared_ptr<const PlanetFile> planet_;
  std::vector<std::vector<double>> middles_;  // chart lines through the middles of tiles, by level and index
  mutable vpe::base::LruCache<lod::TileKey, SurfaceTile, lod::TileKeyHash> cache_;

  // Only of tiles beside coarser ones: all others are the same at every exaggeration.
  struct Exaggerated {
    lod::TileKey key;
    double exaggeration;
    bool operator==(const Exaggerated&) const = default;
  };
  struct ExaggeratedHash {
    std::size_t operator()(const Exaggerated& e) const {
      return lod::TileKeyHash()(e.key) ^ std::hash<double>()(e.exaggeration);
    }
  };
  mutable vpe::base::LruCache<Exaggerated, SurfaceTile, ExaggeratedHash> exaggerated_;
};

// Makes a tile ready: grid lines, height range, block maxima. Pure.
SurfaceTile prepare_tile(TileHeights heights);

}  // namespace paging
