// Colours of the terrain, made on the CPU: light from a tile's posts or triangles, colour from elevation,
// slope, aspect or image (defined in vpe/core/appearance/shading.h). Pure functions over shared caches; no
// OpenGL.
//
// With Gouraud shading, light is computed from posts as fine as the image needs, not from the mesh that is
// drawn, so that shading does not change with the mesh. It is baked into one texture for each tile, because
// software OpenGL affords a single bilinear lookup only (docs/design/rendering.md). With flat shading every
// drawn triangle has one colour. With light of vertices whoever draws the mesh lights it: it takes colours without light
// from here, and the normals of its vertices.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lod/mesh/mesh.h"
#include "paging/planet/image_stretch.h"
#include "paging/planet/planet_file.h"
#include "paging/surface/surface.h"
#include "vpe/base/lru_cache.h"
#include "vpe/core/appearance/palette.h"

namespace paging {

// Selects where colours come from.
enum class ColourSource {
  kPlain,  // ShadingParams::plain
  kElevation,
  kSlope,
  kAspect,
  kImage,
  kImageAtPosts,  // the image sampled at posts and interpolated between them
  kDifference,    // height above the ground of PlanetFile::earlier()
};

constexpr bool shows_image(ColourSource s) {
  return s == ColourSource::kImage || s == ColourSource::kImageAtPosts;
}

struct ShadingParams;
struct TexelBlock;
// Returns whether colours show heights above the ground of PlanetFile::earlier().
bool shows_difference(const ShadingParams& params);

// Describes how terrain is coloured and lit.
struct ShadingParams {
  ColourSource colour_source = ColourSource::kElevation;
  ColourSource hue = ColourSource::kPlain;  // not plain: an image is colourised by this
  ImageStretch stretch;                     // of the image
  bool lit = true;
  bool shadows = false;
  bool flat = false;        // for triangles, not for grids
  glm::dvec3 sun{1, 0, 0};  // unit, body-fixed, towards the sun
  double ambient = 0.05;    // light without sun
  double diffuse = 1.235;   // light of a sun in the zenith
  double exaggeration = 1;
  glm::dvec3 plain = vpe::core::kPlainGround;           // of kPlain
  std::shared_ptr<const vpe::core::ColourScale> scale;  // where elevation, slope, aspect or difference is shown
  // Two scales are equal when they are one object.
  bool operator==(const ShadingParams&) const = default;
};

// Converts an appearance to shading parameters. `scale` is the colour scale of the appearance; null where it
// shows none. With Shading::kVertex they are those of posts, but flat where colours are slope or aspect: whoever draws light
// of vertices takes `lit` and what follows from it out of them.
ShadingParams shading_params(const vpe::core::Appearance& appearance, const glm::dvec3& sun, bool has_image,
                             std::shared_ptr<const vpe::core::ColourScale> scale);
// Returns whether an appearance shows a colour scale.
bool needs_scale(const vpe::core::Appearance& appearance, bool has_image);

// Holds normals and heights at the posts of one stored tile, row 0 at the south. Where shows_difference(), heights are
// those above the ground of the other planet in the post's direction, and posts that have no data there are nodata too.
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

// Holds texels on the (intervals + 1)^2 crossings of a tile's grid, row 0 at the south, even in the chart's u
// and v; or, with intervals 0, one texel for each triangle of a mesh. One channel is light, 255 for
// `brightest`. Four channels are colour and alpha; alpha is 0 where the nearest post (of a triangle: any of
// its three) has no data, else 255.
struct ShadedTile {
  int intervals = 0;
  int channels = 4;
  bool nodata = false;  // some alpha is 0; never with one channel
  double brightest = 1;
  std::vector<std::uint8_t> texels = {};
  bool nodata_image = false;  // where alpha is 0 the colour is the image's, without light and hue
  std::size_t bytes() const { return texels.capacity(); }
};

// Divides the budget of a TerrainShader; together at most 1, without `textures`. A larger share saves reading or computing its
// tiles again, at the expense of the others.
struct ShaderBudgetShares {
  double surface = 0.15;  // tiles of the reference surface, for shadows and flat shading
  double heights = 0.35;  // inputs of normals: a tile's neighbours are needed too
  double normals = 0.35;
  double images = 0.15;
  // Beside the others: textures over tiles that a patch has changed, of which the next patch changes a part.
  double textures = 0;
};

// Returns the version of a page of a tile that is made with a shading: PlanetFile::version(), and where shadows are
// cast that of the ground that may cast them.
std::uint64_t shading_version(const PlanetFile& planet, const lod::TileKey& key, MadeOf made_of,
                              const ShadingParams& params);

// Colours the terrain of a planet file. Any thread may call any const member. Keeps within the budget, except for
// the newest tile of each kind.
//
// Typical usage:
//   const TerrainShader shader(planet, 256 << 20);
//   const ShadingParams params = shading_params(appearance, sun, has_image, scale);
//   const ShadedTile texture = shader.shade(key, shader.useful_intervals(key, params.colour_source), params);
class TerrainShader {
 public:
  TerrainShader(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes,
                const ShaderBudgetShares& shares = {});

  // Goes over to another version of the planet, as PlanetUser::change_planet(), within a new budget. No other member
  // may run meanwhile, and cursors end.
  void change_planet(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes);

  // Returns the number of texture intervals over a tile beyond which the data has no more detail.
  int useful_intervals(const lod::TileKey& key, ColourSource colour_source) const;

  // Colours the grid of a tile. `intervals` must be 2^k times a power of two: texels are posts of tiles below, or where it is
  // less than 2^k, down to least_intervals(), of a tile above (texel_block.h). Where a patch has changed a part of what a kept
  // texture shows, makes that part alone; the texels are the same. Throws PlanetError.
  ShadedTile shade(const lod::TileKey& key, int intervals, const ShadingParams& params) const;

  // Computes one colour for each triangle of a tile's mesh, from its normal, the mean height of its corners,
  // and the image at its middle. `height_m` are the heights of the mesh's vertices above the sphere. Throws
  // PlanetError.
  ShadedTile shade_facets(const lod::TileKey& key, const lod::TileMesh& mesh, std::span<const double> height_m,
                          const ShadingParams& params) const;

  // Computes the normal of each vertex of a tile's mesh, body-fixed and unit: inside the tile the mean of the normals of the
  // triangles around it, weighted by their areas. On the tile's border it is that of the tile's posts, linear between
  // two of them, so that it is the same in the tile of the same level across the border, whatever both draw; at the
  // cube's corners, where three tiles meet, it is not. Where params.lit and params.shadows, a vertex that the ground hides
  // from the sun gets -params.sun. Heights as for shade_facets(); of the params, exaggeration counts besides. Throws
  // PlanetError.
  std::vector<glm::vec3> vertex_normals(const lod::TileKey& key, const lod::TileMesh& mesh,
                                        std::span<const double> height_m, const ShadingParams& params) const;

  // Keeps the tiles that colour_at() used last. Use one for each thread and each shader.
  class Cursor {
    friend class TerrainShader;
    std::shared_ptr<const NormalTile> ground_;
    lod::TileKey ground_key_;
    std::shared_ptr<const ImageTile> image_;
    lod::TileKey image_key_;
    ImageStretch image_stretch_;
  };

  // Computes the colour, 0 to 255 and not clamped, of the terrain in a direction: the same definition without
  // texels. Posts and texels are about footprint_m apart, or as fine as they exist; facets are those of the
  // reference surface. Returns nullopt where the nearest post has no data. Throws PlanetError.
  std::optional<glm::dvec3> colour_at(const glm::dvec3& direction, double footprint_m,
                                      const ShadingParams& params, Cursor& cursor) const;

  // Computes the image's colour in a direction, 0 to 255, as nodata ground shows it: without light and hue,
  // which would be those of elevations that nobody has measured. Returns nullopt if `params` show no image.
  // Throws PlanetError.
  std::optional<glm::dvec3> nodata_image_at(const glm::dvec3& direction, double footprint_m,
                                            const ShadingParams& params, Cursor& cursor) const;

  // Returns whether the sun is seen from a place on the ground whose posts are spacing_m apart: nothing of the reference
  // surface lies between. Throws PlanetError.
  bool sees_sun(const glm::dvec3& place_m, double spacing_m, const ShadingParams& params) const;

  // Return the inputs of colours: posts of a tile that the planet has, texels of one that image_key()
  // returned, stretched. Throw PlanetError.
  std::shared_ptr<const NormalTile> normals(const lod::TileKey& key, const ShadingParams& params) const;
  std::shared_ptr<const ImageTile> image(const lod::TileKey& key, const ImageStretch& stretch) const;
  // Return the same if they are held, else null. Read nothing.
  std::shared_ptr<const NormalTile> held_normals(const lod::TileKey& key, const ShadingParams& params) const;
  std::shared_ptr<const ImageTile> held_image(const lod::TileKey& key, const ImageStretch& stretch) const;

  std::size_t bytes_resident() const;

 private:
  // Holds the inputs of one colour.
  struct Ground {
    double height_m = 0;
    glm::dvec3 normal{0, 0, 1};
    glm::dvec3 up{0, 0, 1};
    double sun = 1;  // visible fraction of the sun
    glm::dvec3 image{0, 0, 0};
  };
  struct ImageBlock {
    std::shared_ptr<const ImageTile> tile;
    lod::TileKey key;
  };
  struct NormalKey {
    TileVersion tile;
    double exaggeration;
    glm::dvec3 sun;              // for shadows, else 0
    std::uint64_t compared = 0;  // PlanetFile::compared_version() for differences, else 0
    bool operator==(const NormalKey&) const = default;
  };
  NormalKey normal_key(const lod::TileKey& key, const ShadingParams& params) const;
  struct NormalKeyHash {
    std::size_t operator()(const NormalKey& k) const {
      return TileVersionHash()(k.tile) ^ std::hash<double>()(k.exaggeration + k.sun.x + 3 * k.sun.y);
    }
  };

  struct ImageKey {
    TileVersion tile;
    ImageStretch stretch;
    bool operator==(const ImageKey&) const = default;
  };
  ImageKey key_of(const lod::TileKey& key, const ImageStretch& stretch) const;
  struct ImageKeyHash {
    std::size_t operator()(const ImageKey& k) const {
      return TileVersionHash()(k.tile) ^
             std::hash<double>()(k.stretch.low + 3 * k.stretch.high + 7 * k.stretch.gamma);
    }
  };

  // Says what the texels of a block are made of.
  struct BlockSource {
    TileVersion ground;
    TileVersion image;  // default: none
    bool operator==(const BlockSource&) const = default;
  };
  // Holds a texture of a patched tile, to be made again in part.
  struct KeptTexture {
    ShadedTile tile;
    std::vector<BlockSource> sources;  // by block, row by row
    std::vector<bool> nodata;          // by block: some alpha is 0
    std::size_t bytes() const;
  };
  struct TextureKey {
    lod::TileKey tile;
    int intervals;
    ShadingParams params;
    bool operator==(const TextureKey&) const = default;
  };
  struct TextureKeyHash {
    std::size_t operator()(const TextureKey& k) const {
      return lod::TileKeyHash()(k.tile) * 31 + static_cast<std::size_t>(k.intervals);
    }
  };
  BlockSource block_source(const lod::TileKey& block, const ShadingParams& params) const;
  // Colours those blocks of a texture that `is_wanted` names, in raw texels on post lines. Puts their flags into `nodata`.
  void shade_blocks(const lod::TileKey& key, const std::vector<bool>& is_wanted, const ShadingParams& params,
                    ShadedTile& out, std::vector<bool>& nodata) const;
  // Makes again the blocks of a texture whose sources differ from those of the kept one. `out` has its channels and no
  // texels. Fills in `out` and `nodata`.
  void shade_changed(const lod::TileKey& key, const ShadingParams& params, const KeptTexture& kept,
                     const std::vector<BlockSource>& sources, ShadedTile& out, std::vector<bool>& nodata) const;

  // Colours a texture of at most as many intervals as posts; `out` has its channels and intervals.
  void shade_coarse(const lod::TileKey& key, const ShadingParams& params, ShadedTile& out) const;

  // Returns the deepest stored tile at or above `key`.
  lod::TileKey deepest(const lod::TileKey& key) const;
  int levels_below(const lod::TileKey& key, int limit) const;
  std::shared_ptr<const TileHeights> heights(const lod::TileKey& key) const;
  NormalTile make_normals(const lod::TileKey& key, const ShadingParams& params) const;
  // Puts differences in place of heights.
  void subtract_earlier(NormalTile& tile) const;
  // Returns the image tile over a block, or none when no image is shown.
  ImageBlock image_block(const lod::TileKey& block, const ShadingParams& params) const;
  glm::dvec3 source_colour(ColourSource source, const Ground& at, const ShadingParams& params) const;
  glm::dvec3 colour(const Ground& at, const ShadingParams& params) const;
  glm::dvec3 image_at(const glm::dvec3& direction, double footprint_m, const ImageStretch& stretch,
                      Cursor& cursor) const;
  // Returns the heights of the row of posts just across an edge, in this tile's order along it, and their
  // positions.
  std::vector<double> heights_across(const lod::TileKey& key, lod::Edge edge,
                                     std::vector<glm::dvec3>& points) const;
  // Colours a block, whose first texel is (x0, y0) of a texture of `side` texels a side.
  void shade_block(const TexelBlock& block, int x0, int y0, int side, const ShadingParams& params,
                   ShadedTile& out) const;

  std::shared_ptr<const PlanetFile> planet_;
  ShaderBudgetShares shares_;
  Surface surface_;                         // casts shadows
  std::shared_ptr<const Surface> earlier_;  // of planet_->earlier(); null: none
  mutable vpe::base::LruCache<TileVersion, TileHeights, TileVersionHash> heights_;
  mutable vpe::base::LruCache<NormalKey, NormalTile, NormalKeyHash> normals_;
  mutable vpe::base::LruCache<ImageKey, ImageTile, ImageKeyHash> images_;
  mutable vpe::base::LruCache<TextureKey, KeptTexture, TextureKeyHash> textures_;
};

}  // namespace paging
