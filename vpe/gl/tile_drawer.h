// Draws resident tiles without a gap between them: their surfaces, then ribbons along their borders, then
// skirts where the borders of neighbours differ.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <numbers>
#include <span>
#include <vector>

#include "vpe/gl/projection.h"
#include "vpe/gl/residency.h"
#include "vpe/gl/shaders.h"
#include "vpe/gl/tile_id.h"

namespace vpe::gl {

struct TileDraw {
  const GpuMesh* mesh = nullptr;
  const GpuTexture* texture = nullptr;
  // Null texture: the palette's colours, or one. Of a texture only its gaps are shown when `flat`.
  bool flat = false;
  bool palette = false;
  glm::vec3 colour{1, 1, 1};  // the one colour, and of light
  lod::TileKey key;
  std::array<float, 4> skirt_m{};  // by lod::Edge; 0 = none
  glm::vec4 tint{0, 0, 0, 0};      // this colour takes the share alpha
};

// What all tiles of an image share.
struct Air {
  glm::vec3 sun{1, 0, 0};  // body-fixed
  float visibility_m = 0;  // 0: clear
};
struct PaletteTable {
  double low = 0;
  double high = 1;
  std::vector<base::Rgb> colours;  // from low to high, even
};

// Two tiles store the same border relative to different centres, and rasterisers snap the two roundings of a
// vertex to a grid of 2^-subpixel_bits pixels: between equal borders a gap of a grid step may open, whatever
// hangs below. Ribbons cover it from every side; they are three steps wide to either side, so that a step for
// the gap and a step each for the ribbon's own corners are inside. Skirts stand upright and may be seen
// edge-on, when the same ribbons close what they leave.
class TileDrawer {
 public:
  explicit TileDrawer(double planet_radius_m);

  // For the draws that follow. The table may be dropped when it returns; null: no tile shows a palette.
  void set_palette(const PaletteTable* table);
  void set_air(const Air& air) { air_ = air; }
  void set_exaggeration(double exaggeration) { exaggeration_ = exaggeration; }

  // Lets go of programs that have not drawn since the last call.
  void drop_unused();

  // The target's framebuffer is bound, depth test and polygon mode are set.
  void draw(const core::View& view, const ClipProjection& projection, std::span<const TileDraw> tiles);

  // Edges of triangles that the surfaces, drawn before, do not hide.
  void draw_edges(const core::View& view, const ClipProjection& projection, std::span<const TileDraw> tiles);

  // A square dot at each vertex, likewise.
  void draw_vertices(const core::View& view, const ClipProjection& projection, std::span<const TileDraw> tiles,
                     float size_px);

  // Lines along the borders of tiles over what draw() drew with the same view, lens and tiles. Depth and alpha
  // stay as they are; a line is before the ground by a five-hundredth of its distance, so that its own tile
  // does not hide it.
  void draw_borders(const core::View& view, const ClipProjection& projection, std::span<const TileDraw> tiles,
                    const glm::vec3& colour);

  // draw() in colours that number tiles and their parts (tile_id.h), on black.
  void draw_tile_ids(const core::View& view, const ClipProjection& projection, std::span<const TileDraw> tiles);

  // What is drawn at a pixel's centre is a point of the meshes moved by at most this in the image: by a
  // vertex's snap, or from a border to the corner of a ribbon and its snap.
  double snap_px() const { return (kRibbonSteps + 1) * std::numbers::sqrt2 * step_px_; }

 private:
  static constexpr int kRibbonSteps = 3;

  struct Programs {
    Program surface;
    Program ribbon;
    Program skirt;
    bool used = true;
  };

  TilePaint paint_of(const TileDraw& tile) const;
  Programs& programs(const TilePaint& paint);
  void use(const Program& program, const TilePaint& paint, TilePart part, const core::View& view,
           const ClipProjection& projection);
  void use(const TileDraw& tile, const TilePaint& paint, TilePart part, const core::View& view, float near_m);
  void draw_part(const TileDraw& tile, const TilePaint& paint, TilePart part, const core::View& view,
                 float near_m);
  template <typename DrawOne>
  void draw_before_ground(const core::View& view, const ClipProjection& projection,
                          std::span<const TileDraw> tiles, const DrawOne& draw_one);
  void draw_indices(const GpuMesh& mesh, GLenum what, std::uint32_t begin, std::uint32_t end);

  double radius_m_;
  double exaggeration_ = 1;
  std::map<TilePaint, Programs> programs_;
  Air air_;
  Texture2D palette_;
  glm::vec2 palette_terms_{0, 0};
  VertexArray array_;
  double step_px_ = 1.0 / 256;
  const TileDraw* numbered_from_ = nullptr;  // numbers are drawn in place of colours
};

}  // namespace vpe::gl
