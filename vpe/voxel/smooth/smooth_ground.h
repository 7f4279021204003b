// The smooth ground of a planet: patches through the posts of its finest tiles (rays.mode=perturbation).
//
// Stage of the pipeline (vpe/voxel/smooth/smooth_caster.h): keeps smooth tiles, and bounds of all tiles of the tree that
// say where rays may meet them. The ground is that of Vyatkin and Dolgovesov 2002 (section 2): a sphere as base, and as shape
// of each face of the cube a tree of tiles with their least and largest heights.
//
// Typical usage:
//   const SmoothGround ground(surface, {}, 256 << 20);
//   const double range_m = ground.cast(camera_m, direction);
#pragma once

#include <atomic>
#include <cstddef>
#include <glm/vec3.hpp>
#include <memory>

#include "paging/surface/surface.h"
#include "vpe/base/lru_cache.h"
#include "vpe/voxel/smooth/smooth_form.h"
#include "vpe/voxel/smooth/smooth_tile.h"

namespace vpe::voxel {

// Describes a point of the smooth ground.
struct SmoothPoint {
  double height_m = 0;         // above the sphere, exaggerated
  glm::dvec3 normal{0, 0, 1};  // unit, outward, body-fixed
  double cell_m = 0;           // width of the cell there on the sphere, about
  double deviation_m = 0;      // bound of the distance from the reference surface over the tile
};

// Any thread may call any const member. Results do not depend on what is held.
class SmoothGround {
 public:
  using Index = lod::TileTree::Index;

  // Keeps at most about `budget_bytes` of tiles. Smaller: tiles are made again more often. `surface` provides their posts and
  // must outlive this.
  SmoothGround(const paging::Surface& surface, std::size_t budget_bytes);

  const lod::TileTree& tree() const { return surface_.planet().tree(); }
  double radius_m() const { return surface_.planet_radius_m(); }

  // Returns a finest tile. Reads it and the tiles beside it. Throws paging::PlanetError if one cannot be read.
  std::shared_ptr<const SmoothTile> tile(Index tile, core::RayPatch patch) const;

  // Returns the ground in a direction (any length but 0). Throws paging::PlanetError.
  SmoothPoint at(const glm::dvec3& direction, const SmoothForm& form) const;

  // Returns a bound of the ground's height above the sphere about a direction, exaggerated. Reads nothing.
  double highest_m(const glm::dvec3& direction, double exaggeration) const;

  // Returns the distance along the unit `direction` from `camera_m` (metres from the planet's centre) to the first point of
  // the ground between begin_m and end_m, or infinity. No patch is missed but by rounding: about 1e-9 m of height for a planet
  // of 3400 km. A ray that is below the ground of a cell where it enters it meets it there. Throws paging::PlanetError.
  double cast(const glm::dvec3& camera_m, const glm::dvec3& direction, const SmoothForm& form,
              double begin_m = 0, double end_m = std::numeric_limits<double>::infinity()) const;

  // Bounds the distance along the vertical between the patches of a tile and the reference surface, exaggerated.
  double deviation_m(const SmoothTile& tile, double exaggeration) const;

  // Holds a place that contains all of the patches over a tile of the tree, with those of the tiles below it.
  struct Ball {
    glm::dvec3 centre_m{0, 0, 0};
    double radius_m = 0;
    double highest_m = 0;  // above the sphere
    mars::ChartRect rect;  // of the tile
  };
  Ball ball(Index tile, double exaggeration) const;

  std::size_t bytes_resident() const { return cache_.bytes(); }

 private:
  // Bounds of a tile of the tree: made when they are first asked for.
  struct Bounds {
    glm::dvec3 direction{0, 0, 1};  // of the middle
    double chord = 0;               // from there to the corners, on the unit sphere
    double low_m = 0;
    double high_m = 0;
    mars::ChartRect rect;
  };
  struct Slot {
    std::atomic<int> state{0};  // 0: empty, 1: being filled, 2: filled
    Bounds bounds;
  };
  Index finest(const mars::ChartPoint& point) const;
  Bounds make_bounds(Index tile) const;
  Bounds bounds(Index tile) const;

  struct Key {
    paging::TileVersion tile;
    core::RayPatch patch;
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& key) const {
      return paging::TileVersionHash()(key.tile) * 2 + (key.patch == core::RayPatch::kBicubic ? 1 : 0);
    }
  };

  const paging::Surface& surface_;
  std::unique_ptr<Slot[]> slots_;
  mutable base::LruCache<Key, SmoothTile, KeyHash> cache_;
};

}  // namespace vpe::voxel
