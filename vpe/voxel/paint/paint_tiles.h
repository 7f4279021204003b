// Finds the posts and texels that colour the ground at a place.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): under the painting kernel. Each painting thread holds a
// PaintTiles; locate() (paint_ground-inl.h) asks it for the square of chart under a pixel.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <unordered_set>

#include "paging/shading/terrain_shader.h"
#include "vpe/voxel/paint/made_tiles.h"
#include "vpe/voxel/paint/paint_sources.h"

namespace vpe::voxel {

// Describes what an appearance needs from the planet file.
struct PaintNeeds {
  bool posts = false;
  bool image = false;
  bool facets = false;        // in place of posts; the image is taken at their middles
  bool post_colours = false;  // the image at posts
};
PaintNeeds paint_needs(const paging::ShadingParams& shading);

// Maps a position in a square to a line of a grid, along one axis: line = first + share of the side * span.
struct WindowAxis {
  float first = 0;
  float span = 0;
};

// Describes a square of a face's chart.
struct ChartSquare {
  // Chart coordinates of a body-fixed point p: u = sign[0] p[axis[0]] / (sign[2] p[axis[2]]), and v with index
  // 1 in place of 0.
  mars::Face face = mars::Face::kPlusX;
  int axis[3] = {0, 0, 0};
  double sign[3] = {0, 0, 0};
  double u0 = 0, v0 = 0, per_u = 0, per_v = 0;  // (u - u0) per_u is the share of the side
};

// Holds the posts and texels of a square of a face's chart, between two knots of the warp, at one level of
// detail.
struct PaintTile : ChartSquare {
  int level = 0;                                     // as given to PaintTiles::find()
  std::shared_ptr<const paging::NormalTile> ground;  // null when not needed
  WindowAxis ground_x, ground_y;
  std::shared_ptr<const paging::ImageTile> image;  // null when not needed
  WindowAxis image_x, image_y;
  std::shared_ptr<const PostColours> colours;  // at the posts of `ground`; null when not needed
};

// Holds the facets of a square between two knots of the warp, or of a tile if that is smaller.
struct FacetSquare : ChartSquare {
  std::shared_ptr<const FacetTile> tile;
  // Position in the tile's grid, as WindowAxis: in double, as it says which facet it is.
  double first_x = 0, span_x = 0, first_y = 0, span_y = 0;
  // The tile's line at or before the square's west border: its number, chart coordinate and distance to the next. Within
  // the square lines are even, or there is none.
  struct Line {
    double number = 0, at = 0, width = 0;
  };
  Line west, south;
};

// Keeps the squares that one thread has used. Not synchronised.
class PaintTiles {
 public:
  // The others must outlive this. Smaller limits release squares more often, which then are looked up again.
  PaintTiles(const paging::PlanetFile& planet, const paging::TerrainShader& shader, PaintSources& sources,
             MadeTiles& made, const paging::ShadingParams& shading, std::size_t limit_bytes);

  // Returns the square that holds a point (of any length but 0) at a level of posts, 0 to max_level(); finer
  // levels show no more. The posts are those of the tile that TerrainShader::colour_at takes, or what `sources` has
  // in their place. The reference is
  // valid until trim() returns true. Throws paging::PlanetError.
  const PaintTile& find(const glm::dvec3& point, int level);

  // Returns in the same way the square of the finest facets at a point.
  const FacetSquare& find_facets(const glm::dvec3& point);

  // Releases all squares and returns true if more than limit_bytes of tiles are held.
  bool trim();

  int max_level() const { return max_level_; }

  paging::TerrainShader::Cursor cursor;  // for TerrainShader::nodata_image_at()

 private:
  PaintTile make(const lod::TileKey& square, int level) const;
  FacetSquare make_facets(const lod::TileKey& square, const lod::TileKey& stored) const;
  void hold(const void* tile, std::size_t bytes);

  const paging::PlanetFile& planet_;
  const paging::TerrainShader& shader_;
  PaintSources& sources_;
  MadeTiles& made_;
  const paging::ShadingParams& shading_;
  PaintNeeds needs_;
  int max_level_;
  int image_below_;  // level of posts less the level of image tiles of equal spacing
  std::size_t limit_;
  std::size_t held_bytes_ = 0;
  std::unordered_set<const void*> held_;
  std::unordered_map<std::int64_t, PaintTile> squares_;          // by key of the square and level
  std::unordered_map<std::int64_t, FacetSquare> facet_squares_;  // by key of the square
};

}  // namespace vpe::voxel
