// Draws resident tiles without a gap between them: their surfaces, then ribbons along their borders, then
// skirts where the borders of neighbours differ.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <numbers>
#include <optional>
#include <span>

#include "vpe/gl/lens.h"
#include "vpe/gl/residency.h"
#include "vpe/gl/tile_number.h"

namespace vpe::gl {

struct TileDraw {
  const GpuMesh* mesh = nullptr;
  const GpuTexture* texture = nullptr;
  bool flat = false;  // the flat colour; of the texture only its gaps are shown. Null texture: flat, no gaps
  lod::TileKey key;
  std::array<float, 4> skirt_m{};  // by lod::Edge; 0 = none
  glm::vec4 tint{0, 0, 0, 0};      // this colour takes the share alpha
};

// Two tiles store the same border relative to different centres, and rasterisers snap the two roundings of a
// vertex to a grid of 2^-subpixel_bits pixels: between equal borders a gap of a grid step may open, whatever
// hangs below. Ribbons cover it from every side; they are three steps wide to either side, so that a step for
// the gap and a step each for the ribbon's own corners are inside. Skirts stand upright and may be seen
// edge-on, when the same ribbons close what they leave.
class TileDrawer {
 public:
  enum class Gaps { kLeave, kClose };

  // Whether the tile is drawn by the programs that show gaps.
  static bool has_gaps(const TileDraw& tile) { return tile.texture != nullptr && tile.texture->gaps; }

  TileDrawer();
  // The target's framebuffer is bound, depth test and polygon mode are set.
  void draw(const core::View& view, const Lens& lens, std::span<const TileDraw> tiles, Gaps gaps);

  // Lines along the borders of tiles over what draw() drew with the same view, lens and tiles. Depth and alpha
  // stay as they are; a line is before the ground by a five-hundredth of its distance, so that its own tile
  // does not hide it.
  void draw_borders(const core::View& view, const Lens& lens, std::span<const TileDraw> tiles,
                    const glm::vec3& colour);

  // draw() without gaps in colours that number tiles and their parts (tile_number.h), on black.
  void draw_numbers(const core::View& view, const Lens& lens, std::span<const TileDraw> tiles);

  // What is drawn at a pixel's centre is a point of the meshes moved by at most this in the picture: by a
  // vertex's snap, or from a border to the corner of a ribbon and its snap.
  double snap_px() const { return (kRibbonSteps + 1) * std::numbers::sqrt2 * step_px_; }

 private:
  static constexpr int kRibbonSteps = 3;

  struct Programs {
    Program surface;
    Program ribbon;
    Program skirt;
  };

  static Programs make_programs(const char* label, const char* fragment, const char* skirt_fragment);
  void use(const Program& program, TilePart part, const core::View& view, const Lens& lens);
  void use(const TileDraw& tile, TilePart part, const core::View& view, float near_m);
  void draw_part(const TileDraw& tile, TilePart part, const core::View& view, float near_m);
  void draw_indices(const GpuMesh& mesh, GLenum what, std::uint32_t begin, std::uint32_t end);

  Programs programs_;
  std::optional<Programs> gap_programs_;  // made for the first tile that has gaps
  VertexArray array_;
  double step_px_ = 1.0 / 256;
  const TileDraw* numbered_from_ = nullptr;  // numbers are drawn in place of colours
};

}  // namespace vpe::gl
