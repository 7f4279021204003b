// The reference surface at run time: the exact surface of a planet file, sampled and cast against.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/base/lru_cache.h"

namespace paging {

// Holds a tile ready for sampling and casting.
struct SurfaceTile {
  TileHeights data;  // of Surface::tile(): without `source`, for which there is Surface::sources()
  lod::GridLines lines;
  double min_height_m = 0;
  double max_height_m = 0;
  // block_max[b - 1] has the largest height in each block of 2^b x 2^b cells, row by row; b = 1, 2, ..., k.
  std::vector<std::vector<float>> block_max;

  std::size_t bytes() const;
};

struct SurfacePoint {
  double height_m = 0;         // above the sphere
  double radius_m = 0;         // from the planet's centre
  glm::dvec3 normal{0, 0, 1};  // of the facet, outward, body-fixed
  lod::TileKey tile;           // the finest tile there
  bool nodata = false;         // a post of the facet has no data (at a post: that post)
};

// Samples and casts against the surface of a planet file, which it reads tile by tile into a cache. Any thread
// may call any const member. Results do not depend on the cache's state.
//
// Typical usage:
//   const Surface surface(PlanetFile::open("mars.vpe"), 256 << 20);
//   const double height_m = surface.at(mars::direction({-74, -13})).height_m;
//   const double range_m = surface.cast(camera.position_m, camera.axes.forward);
class Surface {
 public:
  // Keeps at most about `budget_bytes` of decoded tiles. Smaller: tiles are read again more often.
  Surface(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes);

  // Goes over to another version of the planet, as PlanetUser::change_planet(). No other member may run meanwhile.
  void change_planet(std::shared_ptr<const PlanetFile> planet);

  const PlanetFile& planet() const { return *planet_; }
  const std::shared_ptr<const PlanetFile>& shared_planet() const { return planet_; }
  double planet_radius_m() const { return planet_->radius_m(); }

  // Returns the point of the surface in a direction (any length but 0). Rounding error <= 4e-9 m * radius /
  // 3.4e6 m. With an exaggeration: height, radius and normal as drawn. Throws PlanetError.
  SurfacePoint at(const glm::dvec3& direction, double exaggeration = 1.0) const;

  // Computes the radius of the surface in many directions. Fastest when neighbours in the list are neighbours
  // on the ground.
  void radius(std::span<const glm::dvec3> directions, std::span<double> radius_m,
              double exaggeration = 1.0) const;

  // Returns whether a place (metres from the planet's centre) lies below the surface, as cast() has it. Reads a
  // tile only if the place is not above all of it. Throws PlanetError.
  bool is_below(const glm::dvec3& place_m, double exaggeration = 1.0) const;

  // Restricts a ray to a segment, in metres along it.
  struct RaySegment {
    double begin_m = 0;
    double end_m = std::numeric_limits<double>::infinity();
  };
  // Returns the distance along the unit `direction` from `camera_m` (metres from the planet's centre) to the
  // first point of the surface, or infinity when there is none. Exact on the flat triangles of the surface up
  // to rounding (about 1e-9 relative, more on a grazing facet), and watertight: neighbouring facets are tested
  // against the same lines. Returns 0 for a camera below the surface, and segment.begin_m for a segment that
  // begins below it. With an exaggeration: of the surface as drawn. Throws PlanetError.
  double cast(const glm::dvec3& camera_m, const glm::dvec3& direction, double exaggeration,
              const RaySegment& segment) const;
  double cast(const glm::dvec3& camera_m, const glm::dvec3& direction, double exaggeration = 1.0) const {
    return cast(camera_m, direction, exaggeration, RaySegment());
  }

  // Provides a finest tile to cast_over(), or null if it is not to be had.
  using TileProvider = std::function<std::shared_ptr<const SurfaceTile>(const lod::TileKey&)>;
  // Casts as cast() does, over the tiles of a provider. Returns nullopt if the ray needs a tile that it does not
  // provide. Throws what the provider throws.
  std::optional<double> cast_over(const TileProvider& tiles, const glm::dvec3& camera_m,
                                  const glm::dvec3& direction, double exaggeration,
                                  const RaySegment& segment) const;

  // Returns the radius of the surface in a direction, as at() does. Where the finest tile cannot be read, the
  // posts of its nearest readable ancestor take its place. Throws PlanetError if not even the root can be read.
  double readable_radius_m(const glm::dvec3& direction, double exaggeration) const;

  // Returns a finest tile, or the own posts of a coarser one. With an exaggeration: its posts as drawn (see
  // PlanetFile::heights). Throws PlanetError.
  std::shared_ptr<const SurfaceTile> tile(const lod::TileKey& key, double exaggeration = 1.0) const;
  // Returns the same if it is held, else null. Reads nothing.
  std::shared_ptr<const SurfaceTile> held_tile(const lod::TileKey& key, double exaggeration = 1.0) const;
  // Returns the sources of a finest tile. Throws PlanetError.
  std::shared_ptr<const TileSources> sources(const lod::TileKey& key) const;
  std::size_t bytes_resident() const { return cache_.bytes() + exaggerated_.bytes() + sources_.bytes(); }

  // Returns the chart coordinate of the line between a tile's halves; `index` is i for u, j for v.
  double middle_line(int level, std::int32_t index) const;

 private:
  TileVersion version(const lod::TileKey& key) const { return {key, planet_->version(key)}; }
  std::shared_ptr<const SurfaceTile> exaggerated(const TileVersion& version,
                                                 std::shared_ptr<const SurfaceTile> tile,
                                                 double exaggeration) const;

  std::shared_ptr<const PlanetFile> planet_;
  std::vector<std::vector<double>> middles_;  // chart lines through the middles of tiles, by level and index
  mutable vpe::base::LruCache<TileVersion, SurfaceTile, TileVersionHash> cache_;

  mutable vpe::base::LruCache<TileVersion, TileSources, TileVersionHash> sources_;

  // Exaggerated tiles are kept only beside coarser ones: all others are the same at every exaggeration.
  struct Exaggerated {
    TileVersion tile;
    double exaggeration;
    bool operator==(const Exaggerated&) const = default;
  };
  struct ExaggeratedHash {
    std::size_t operator()(const Exaggerated& e) const {
      return TileVersionHash()(e.tile) ^ std::hash<double>()(e.exaggeration);
    }
  };
  mutable vpe::base::LruCache<Exaggerated, SurfaceTile, ExaggeratedHash> exaggerated_;
};

// Returns the index of the post of a tile that is nearest to a place in it, by its chart coordinates. It is one
// of the posts of the facet there. Pure.
std::size_t nearest_post(const SurfaceTile& tile, const mars::ChartPoint& point);

// Prepares a tile: computes grid lines, height range and block maxima. Pure.
SurfaceTile prepare_tile(TileHeights heights);

}  // namespace paging
