// Draws resident tiles without a gap between them: their surfaces, then ribbons along their borders, then
// skirts where the borders of neighbours differ.
#pragma once

#include <array>
#include <numbers>
#include <span>

#include "vpe/gl/lens.h"
#include "vpe/gl/residency.h"

namespace vpe::gl {

struct TileDraw {
  const GpuMesh* mesh = nullptr;
  const GpuTexture* texture = nullptr;  // null: the flat colour
  mars::Face face{};
  std::array<float, 4> skirt_m{};  // by lod::Edge; 0 = none
};

// Two tiles store the same border relative to different centres, and rasterisers snap the two roundings of a
// vertex to a grid of 2^-subpixel_bits pixels: between equal borders a gap of a grid step may open, whatever
// hangs below. Ribbons cover it from every side; they are three steps wide to either side, so that a step for
// the gap and a step each for the ribbon's own corners are inside. Skirts stand upright and may be seen
// edge-on, when the same ribbons close what they leave.
class TileDrawer {
 public:
  enum class Gaps { kLeave, kClose };

  TileDrawer();
  // The target's framebuffer is bound, depth test and polygon mode are set.
  void draw(const core::View& view, const Lens& lens, std::span<const TileDraw> tiles, Gaps gaps);

  // What is drawn at a pixel's centre is a point of the meshes moved by at most this in the picture: by a
  // vertex's snap, or from a border to the corner of a ribbon and its snap.
  double snap_px() const { return (kRibbonSteps + 1) * std::numbers::sqrt2 * step_px_; }

 private:
  static constexpr int kRibbonSteps = 3;

  void use(const Program& program, const core::View& view, const Lens& lens);
  void use(const TileDraw& tile, const core::View& view);
  void draw_indices(const GpuMesh& mesh, GLenum what, std::uint32_t begin, std::uint32_t end);

  Program surface_program_;
  Program ribbon_program_;
  Program skirt_program_;
  VertexArray array_;
  double step_px_ = 1.0 / 256;
};

}  // namespace vpe::gl
