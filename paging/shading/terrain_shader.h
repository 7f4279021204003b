// Colours of a tile's surface, made on the CPU: light from the tile's posts or triangles, colour from
// elevation, slope, aspect or image (vpe/core/appearance/shading.h has the definition). Pure functions over shared caches;
// no OpenGL.
//
// With Gouraud shading light is computed from posts as fine as the image needs, not from the mesh that
// happens to be drawn, so that shading does not change when the mesh does. It is baked into one texture a tile,
// because a single bilinear lookup is what software OpenGL affords (docs/rendering.md). With flat shading every
// drawn triangle has one colour.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lod/mesh/mesh.h"
#include "paging/planet/planet_file.h"
#include "paging/surface/surface.h"
#include "vpe/base/lru_cache.h"
#include "vpe/core/appearance/palette.h"

namespace paging {

// Where colours come from.
enum class ColourSource {
  kPlain,  // vpe::core::kPlainGround
  kElevation,
  kSlope,
  kAspect,
  kImage,
  kImageAtPosts,
};

constexpr bool shows_image(ColourSource s) {
  return s == ColourSource::kImage || s == ColourSource::kImageAtPosts;
}

struct ShadingParams {
  ColourSource colour_source = ColourSource::kElevation;
  ColourSource hue = ColourSource::kPlain;  // of an image: not plain = colourised by this
  bool lit = true;
  bool shadows = false;
  bool flat = false;        // for triangles, not for grids
  glm::dvec3 sun{1, 0, 0};  // unit, body-fixed, towards the sun
  double ambient = 0.05;
  double diffuse = 1.235;
  double exaggeration = 1;
  std::shared_ptr<const vpe::core::ColourScale> scale;  // where elevation, slope or aspect is shown
  // Two scales are one when they are one object.
  bool operator==(const ShadingParams&) const = default;
};

// What an appearance asks of ground. scale: of the appearance; null where it shows none.
ShadingParams shading_params(const vpe::core::Appearance& appearance, const glm::dvec3& sun, bool has_image,
                             std::shared_ptr<const vpe::core::ColourScale> scale);
bool needs_scale(const vpe::core::Appearance& appearance, bool has_image);

// Normals and heights at the posts of one stored tile, row 0 at the south.
struct NormalTile {
  // 16 bytes, so that one load takes all of a post.
  struct Post {
    glm::vec3 normal;  // unit, body-fixed
    float height_m;
  };
  lod::TileKey key;
  int side = 0;
  std::vector<Post> posts;
  std::vector<std::uint8_t> sees_sun;  // 1 or 0; empty without shadows
  std::vector<bool> nodata;            // empty when every post has data
  std::size_t bytes() const;
};

// Texels on the (intervals + 1)^2 lines of a tile, row 0 at the south; even in the chart's u and v. Or, with
// intervals 0, one for each triangle of a mesh. With one channel it is light, 255 for `brightest`; with four
// colour, and alpha 0 where the nearest post has no data (a triangle: any of its three), else 255.
struct ShadedTile {
  int intervals = 0;
  int channels = 4;
  bool nodata = false;  // some alpha is 0; never with one channel
  double brightest = 1;
  std::vector<std::uint8_t> texels;
  std::size_t bytes() const { return texels.capacity(); }
};

// What parts of a painter's budget may hold; together at most 1.
struct ShaderBudgetShares {
  double surface = 0.15;  // S, for shadows and flat shading
  double heights = 0.35;  // to make normals from: a tile's neighbours are needed too
  double normals = 0.35;
  double images = 0.15;
};

// Any thread may call any member. Keeps within the budget, but for the newest tile of each kind.
class TerrainShader {
 public:
  TerrainShader(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes,
                const ShaderBudgetShares& shares = {});

  // Number of texture intervals over a tile beyond which the data has nothing more to show.
  int useful_intervals(const lod::TileKey& key, ColourSource colour_source) const;

  // intervals: 2^k times a power of two (>= 1).
  ShadedTile shade(const lod::TileKey& key, int intervals, const ShadingParams& params) const;

  // One colour for each triangle of a tile's mesh: of its normal, the mean height of its corners, and of the
  // image below its middle. height_m: of the mesh's vertices, above the sphere.
  ShadedTile shade_facets(const lod::TileKey& key, const lod::TileMesh& mesh, std::span<const double> height_m,
                          const ShadingParams& params) const;

  // What colour_at() looked at last; one a thread, and for one painter alone.
  class Cursor {
    friend class TerrainShader;
    std::shared_ptr<const NormalTile> ground;
    lod::TileKey ground_key;
    std::shared_ptr<const ImageTile> image;
    lod::TileKey image_key;
  };

  // Colour, 0 to 255 and not yet cut to that, of the ground in a direction: the same definition without texels.
  // Posts and images are about footprint_m apart, or as fine as they are; facets are those of S. Nothing where
  // the nearest post has no data.
  std::optional<glm::dvec3> colour_at(const glm::dvec3& direction, double footprint_m,
                                      const ShadingParams& params, Cursor& cursor) const;

  // What colours are made from: posts of a tile that the planet has, texels of one that image_key() returned.
  std::shared_ptr<const NormalTile> normals(const lod::TileKey& key, const ShadingParams& params) const;
  std::shared_ptr<const ImageTile> image(const lod::TileKey& key) const;

  std::size_t bytes_resident() const;

 private:
  // What a colour is made of.
  struct Ground {
    double height_m = 0;
    glm::dvec3 normal{0, 0, 1};
    glm::dvec3 up{0, 0, 1};
    double sun = 1;  // share of the sun that is seen
    glm::dvec3 image{0, 0, 0};
  };
  struct ImageBlock {
    std::shared_ptr<const ImageTile> tile;
    lod::TileKey key;
  };
  struct NormalKey {
    lod::TileKey key;
    double exaggeration;
    glm::dvec3 sun;  // for shadows, else 0
    bool operator==(const NormalKey&) const = default;
  };
  struct NormalKeyHash {
    std::size_t operator()(const NormalKey& k) const {
      return lod::TileKeyHash()(k.key) ^ std::hash<double>()(k.exaggeration + k.sun.x + 3 * k.sun.y);
    }
  };

  lod::TileKey deepest(const lod::TileKey& key) const;
  int levels_below(const lod::TileKey& key, int limit) const;
  std::shared_ptr<const TileHeights> heights(const lod::TileKey& key) const;
  NormalTile make_normals(const lod::TileKey& key, const ShadingParams& params) const;
  ImageBlock image_block(const lod::TileKey& block, const ShadingParams& params) const;
  glm::dvec3 shown(ColourSource what, const Ground& at, const ShadingParams& params) const;
  glm::dvec3 colour(const Ground& at, const ShadingParams& params) const;
  glm::dvec3 image_at(const glm::dvec3& direction, double footprint_m, Cursor& cursor) const;
  std::vector<double> heights_across(const lod::TileKey& key, lod::Edge edge,
                                     std::vector<glm::dvec3>& points) const;
  void shade_block(const lod::TileKey& block, int x0, int y0, int side, const ShadingParams& params,
                   ShadedTile& out) const;
  bool sees_sun(const glm::dvec3& place_m, double spacing_m, const ShadingParams& params) const;

  std::shared_ptr<const PlanetFile> planet_;
  Surface surface_;  // casts shadows
  mutable vpe::base::LruCache<lod::TileKey, TileHeights, lod::TileKeyHash> heights_;
  mutable vpe::base::LruCache<NormalKey, NormalTile, NormalKeyHash> normals_;
  mutable vpe::base::LruCache<lod::TileKey, ImageTile, lod::TileKeyHash> images_;
};

}  // namespace paging
