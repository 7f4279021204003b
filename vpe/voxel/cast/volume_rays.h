// Casts rays over the terrain volumes of a planet (Wan, Qu and Kaufman 1999, sections 3 and 4), one after the other.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): cast_volumes() (band_caster.h) casts images with it. Every ray goes over the
// height grids that a ColumnWalk casts. In the voxels of a grid (vpe/voxel/volume/grid_volume.h) it is a straight line, of which
// samples are taken at multiples of an interval. Near tiles end a ray where the density passes the surface; far ones in the first
// boundary cell. Where the paper starts a ray at the end of the one below, maxima of tiles and of blocks of cells lead it past the
// air here, so that no ground is missed on the way.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <unordered_map>
#include <vector>

#include "vpe/voxel/cast/column_walk.h"
#include "vpe/voxel/cast/volume_form.h"
#include "vpe/voxel/volume/grid_volume_store.h"

namespace vpe::voxel {

// Describes what the rays of an image found in a tile.
struct VolumeTile {
  // Bounds the distance along the vertical between what was cast and the reference surface.
  double deviation_m = 0;
  double nearest_m = std::numeric_limits<double>::infinity();  // range of a hit
};
using VolumeTiles = std::unordered_map<lod::TileTree::Index, VolumeTile>;

// Casts one ray after the other. For one thread.
class VolumeRays {
 public:
  // All of them must outlive this. The rule of `walk` must not be discrete.
  VolumeRays(const ColumnWalk& walk, const GridVolumeStore& store, ThreadLocalTiles& tiles,
             const VolumeForm& form);

  // Returns the range of the first sample in the ground on the unit `ray` from `camera_m`, moved to the surface before it where
  // densities are cast; infinite if there is none, 0 if the camera is in the ground. Throws paging::PlanetError for tiles that
  // cannot be read.
  double cast(const glm::dvec3& camera_m, const glm::dvec3& ray);

  // Returns the same for what is in bricks alone.
  double cast_bricks(const glm::dvec3& from_m, const glm::dvec3& ray);

  // Returns true if the density at a point, or its boundary cell in a far tile, is that of ground.
  bool is_ground(const glm::dvec3& place_m);

  // Returns the brick over or below a place; null if there is none.
  const GridVolume* brick_at(const glm::dvec3& place_m) const;

  // Returns the height above the sphere at which the vertical of a unit direction leaves the ground of the densities, without
  // bricks.
  double ground_height_m(const glm::dvec3& up);

  const VolumeTiles& seen() const { return seen_; }
  // Returns what rays found in bricks.
  const VolumeTile& seen_bricks() const { return seen_bricks_; }

 private:
  // A grid on a ray, or how far the ray is above all ground.
  struct Place {
    std::shared_ptr<const GridVolume> volume;  // null: air up to end_m
    lod::TileTree::Index tile = 0;
    double begin_m = 0;
    double end_m = 0;
    bool is_far = false;
  };
  // Finds what is on a ray at a range; until_m is a limit of end_m.
  Place find(const glm::dvec3& camera_m, const glm::dvec3& ray, double at_m, double until_m);
  const std::shared_ptr<const GridVolume>& volume(lod::TileTree::Index tile, int i, int j,
                                                  const HeightGridFrame& frame);
  // A brick on a ray.
  struct BrickOnRay {
    std::shared_ptr<const GridVolume> volume;
    double begin_m = 0;
    double end_m = 0;
  };
  void find_bricks(const glm::dvec3& camera_m, const glm::dvec3& ray);
  double cast_in(const Place& place, const glm::dvec3& camera_m, const glm::dvec3& ray, double from_m);
  // Returns a radius that no ground over a tile reaches.
  double top_m(lod::TileTree::Index tile);
  double make_top_m(lod::TileTree::Index tile) const;

  // A volume that was used last.
  struct Slot {
    lod::TileTree::Index tile = 0;
    int place = 0;
    std::shared_ptr<const GridVolume> volume;
  };

  const ColumnWalk& walk_;
  const GridVolumeStore& store_;
  ThreadLocalTiles& tiles_;
  const VolumeForm& form_;
  double voxels_beyond_;  // a tile's border that its surface depends on
  double highest_m_ = 0;
  std::array<Slot, 64> slots_;
  struct Top {
    lod::TileTree::Index tile = ~lod::TileTree::Index{0};
    double radius_m = 0;
  };
  std::array<Top, 256> tops_;
  std::vector<BrickOnRay> bricks_;  // on the ray, in its order
  VolumeTiles seen_;
  VolumeTile seen_bricks_;
};

}  // namespace vpe::voxel
