// Which posts and texels colour the ground at a place: what one thread has at hand while it paints an image.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <unordered_set>

#include "paging/shading/terrain_shader.h"

namespace vpe::voxel {

// What a look takes from the planet.
struct PaintNeeds {
  bool posts = false;
  bool image = false;
};
PaintNeeds paint_needs(const paging::ShadingParams& shading);

// Places along one axis of a grid: first + share of the window's side * span, in grid lines.
struct WindowAxis {
  float first = 0;
  float span = 0;
};

// A square of a face's chart, between two knots of the warp, at one level of detail; and what is there.
struct PaintTile {
  // Chart coordinates of a body-fixed point p: u = sign[0] p[axis[0]] / (sign[2] p[axis[2]]), v likewise
  // with 1.
  mars::Face face = mars::Face::kPlusX;
  int axis[3] = {0, 0, 0};
  double sign[3] = {0, 0, 0};
  int level = 0;                                // of PaintTiles::find
  double u0 = 0, v0 = 0, per_u = 0, per_v = 0;  // share of the side: (u - u0) per_u

  std::shared_ptr<const paging::NormalTile> ground;  // null when not needed
  WindowAxis ground_x, ground_y;
  std::shared_ptr<const paging::ImageTile> image;  // null when not needed
  WindowAxis image_x, image_y;
};

// Used by one thread at a time.
class PaintTiles {
 public:
  PaintTiles(const paging::PlanetFile& planet, const paging::TerrainShader& painter,
             const paging::ShadingParams& shading, std::size_t limit_bytes);

  // The square that holds a point (of any length but 0) at a level of posts: of the tile that
  // TerrainShader::colour_at takes for it. Levels are 0 to max_level(); what is beyond shows no more. Valid
  // until trim() says that it let go. Throws PlanetError.
  const PaintTile& find(const glm::dvec3& point, int level);

  // Lets go of everything, and says so, when more than limit_bytes of tiles are held.
  bool trim();

  int max_level() const { return max_level_; }

  paging::TerrainShader::Cursor cursor;  // for TerrainShader::colour_at

 private:
  PaintTile make(const lod::TileKey& square, int level) const;
  void hold(const void* tile, std::size_t bytes);

  const paging::PlanetFile& planet_;
  const paging::TerrainShader& painter_;
  paging::ShadingParams shading_;
  PaintNeeds needs_;
  int max_level_;
  int image_below_;  // levels from posts to the image's tiles of equal spacing
  std::size_t limit_;
  std::size_t held_bytes_ = 0;
  std::unordered_set<const void*> held_;
  std::unordered_map<std::int64_t, PaintTile> squares_;  // by key of the square and level
};

}  // namespace vpe::voxel
