// Colours of a tile's surface, made on the CPU: light from the tile's posts, colour from elevation or image.
// Pure functions over shared caches; no OpenGL.
//
// Light is computed from posts as fine as the picture needs, not from the mesh that happens to be drawn, so
// that shading does not change when the mesh does. It is baked into one texture a tile, because a single
// bilinear lookup is what software OpenGL affords (docs/rendering.md).
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "paging/cache.h"
#include "paging/planet_file.h"

namespace vpe::gl {

enum class Surfacing { kPlain, kElevation, kImage };

struct ShadeParams {
  Surfacing surfacing = Surfacing::kElevation;
  bool lit = true;
  glm::dvec3 sun{1, 0, 0};  // unit, body-fixed, towards the sun
  double ambient = 0.25;
  double exaggeration = 1;
  bool operator==(const ShadeParams&) const = default;
};

// Normals and heights at the posts of one stored tile.
struct NormalTile {
  lod::TileKey key;
  int side = 0;
  std::vector<glm::vec3> normal;  // unit, body-fixed
  std::vector<float> height_m;
  std::vector<bool> missing;  // empty when every post has data
  std::size_t bytes() const;
};

// Texels on the (intervals + 1)^2 lines of a tile, row 0 at the south; even in the chart's u and v. Alpha is 0
// where the nearest post has no data, else 255.
struct ShadedTile {
  int intervals = 0;
  bool gaps = false;  // some alpha is 0
  std::vector<std::uint8_t> rgba;
  std::size_t bytes() const { return rgba.capacity(); }
};

// Any thread may call any member.
class Shader {
 public:
  Shader(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes);

  // Number of texture intervals over a tile beyond which the data has nothing more to show.
  int useful_intervals(const lod::TileKey& key, Surfacing surfacing) const;

  // intervals: 2^k times a power of two (>= 1).
  ShadedTile shade(const lod::TileKey& key, int intervals, const ShadeParams& params) const;

  std::size_t bytes_resident() const;

 private:
  struct NormalKey {
    lod::TileKey key;
    double exaggeration;
    bool operator==(const NormalKey&) const = default;
  };
  struct NormalKeyHash {
    std::size_t operator()(const NormalKey& k) const {
      return lod::TileKeyHash()(k.key) ^ std::hash<double>()(k.exaggeration);
    }
  };

  lod::TileKey deepest(const lod::TileKey& key) const;
  int levels_below(const lod::TileKey& key, int limit) const;
  std::shared_ptr<const paging::TileHeights> heights(const lod::TileKey& key) const;
  std::shared_ptr<const paging::ImageTile> image(const lod::TileKey& key) const;
  std::shared_ptr<const NormalTile> normals(const lod::TileKey& key, double exaggeration) const;
  NormalTile make_normals(const lod::TileKey& key, double exaggeration) const;
  std::vector<double> heights_across(const lod::TileKey& key, lod::Edge edge,
                                     std::vector<glm::dvec3>& points) const;
  void shade_block(const lod::TileKey& block, int x0, int y0, int side, const ShadeParams& params,
                   ShadedTile& out) const;

  std::shared_ptr<const paging::PlanetFile> planet_;
  mutable paging::LruCache<lod::TileKey, paging::TileHeights, lod::TileKeyHash> heights_;
  mutable paging::LruCache<NormalKey, NormalTile, NormalKeyHash> normals_;
  mutable paging::LruCache<lod::TileKey, paging::ImageTile, lod::TileKeyHash> images_;
};

// Colour of an elevation, metres above the sphere.
mars::Rgb elevation_colour(double height_m);

}  // namespace vpe::gl
