// Drawing of resident tiles without cracks between them.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <map>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "vpe/gl/projection.h"
#include "vpe/gl/residency.h"
#include "vpe/gl/shaders.h"
#include "vpe/gl/tile_id.h"

namespace vpe::gl {

// Describes how a tile is drawn.
struct TileDraw {
  const GpuMesh* mesh = nullptr;
  std::span<const IndexRange> surface;  // the triangles of the surface that are drawn
  const GpuTexture* texture = nullptr;  // null: the palette's colours, or one colour
  bool flat = false;                    // one colour; of a texture only the nodata ground is shown
  bool palette = false;                 // without a texture: the palette's colours
  glm::vec3 colour{1, 1, 1};            // the one colour, and the colour that light is multiplied with
  lod::TileKey key;
  std::array<float, 4> skirt_m{};  // by lod::Edge; 0 = none
  glm::vec4 tint{0, 0, 0, 0};      // this colour takes the share alpha
  // Puts corners of the surface on the rasteriser's grid triangle by triangle, and the depth of slivers on their
  // long edge: required where triangles that show may reach behind the near plane. On the CPU it adds a tenth to
  // a frame.
  bool by_triangle = false;
};

// Describes the air between the camera and all tiles of an image.
struct Air {
  glm::vec3 sun{1, 0, 0};  // towards the sun, body-fixed, unit
  float visibility_m = 0;  // 0: clear
  glm::vec3 haze{0};       // colour in full light, 0 to 1
};

// Describes the light of the vertices of meshes with normals: core::light(ambient, diffuse, cosine).
struct SunLight {
  glm::vec3 sun{1, 0, 0};  // towards the sun, body-fixed, unit
  float ambient = 0;
  float diffuse = 1;
};

// Holds the colours of heights from low to high, metres, evenly spaced.
struct PaletteTable {
  double low = 0;
  double high = 1;
  std::vector<base::Rgb> colours;
};

// Draws the surfaces of tiles, then ribbons along their borders, then skirts where the borders of neighbours
// differ.
//
// Two tiles store the same border relative to different centres, and rasterisers snap the two roundings of a
// vertex to a grid of 2^-subpixel_bits pixels: between equal borders a crack of a grid step may open, whatever
// hangs below. Ribbons cover it from every side. They are three steps wide to either side, so that a step for
// the crack and a step each for the ribbon's own corners are inside. Skirts stand upright and may be seen
// edge-on; then the same ribbons close the cracks that skirts leave.
//
// While tiles are drawn, at most 2 kTrianglesAhead triangles, and those of a tile more, wait for the rasteriser: on the CPU
// each takes some 200 bytes of the driver's memory, which nobody counts.
//
// Thread rule: the context's thread. Throws std::runtime_error when a program cannot be made.
//
// Typical usage, with the target's framebuffer bound, and depth test and polygon mode set:
//
//   drawer.set_palette(nullptr);
//   drawer.set_air({sun, 0});
//   drawer.set_light(std::nullopt);
//   drawer.set_exaggeration(1);
//   drawer.draw(view, projection, tiles);
//   drawer.drop_unused();
class TileDrawer {
 public:
  static constexpr std::size_t kTrianglesAhead = std::size_t{1} << 16;

  explicit TileDrawer(double planet_radius_m);

  // Sets the palette of the draws that follow. null: no tile shows a palette. The table is copied.
  void set_palette(const PaletteTable* table);
  void set_air(const Air& air) { air_ = air; }
  // Sets the light of the draws that follow: the colours of tiles whose meshes have normals are multiplied with that of their
  // vertices, interpolated over each triangle. None: colours are as they are.
  void set_light(const std::optional<SunLight>& light) { light_ = light; }
  void set_exaggeration(double exaggeration) { exaggeration_ = exaggeration; }

  // Drops programs that have not drawn since the last call.
  void drop_unused();

  // Draws tiles in their colours.
  void draw(const core::View& view, const ClipProjection& projection, std::span<const TileDraw> tiles);

  // Draws the edges of triangles that the surfaces, drawn before, do not hide.
  void draw_edges(const core::View& view, const ClipProjection& projection, std::span<const TileDraw> tiles);

  // Draws a square dot at each vertex that the surfaces, drawn before, do not hide.
  void draw_vertices(const core::View& view, const ClipProjection& projection, std::span<const TileDraw> tiles,
                     float size_px);

  // Draws lines along the borders of tiles over what draw() drew with the same view, projection and tiles.
  // Leaves depth and alpha as they are. A line is nearer than the ground by a five-hundredth of its distance,
  // so that its own tile does not hide it.
  void draw_borders(const core::View& view, const ClipProjection& projection, std::span<const TileDraw> tiles,
                    const glm::vec3& colour);

  // Draws tiles as draw() does, in the colours of the IDs of their parts (tile_id.h). The index of a tile in
  // `tiles` is its ID. The target must be black.
  void draw_tile_ids(const core::View& view, const ClipProjection& projection, std::span<const TileDraw> tiles);

  // Returns the distance, pixels, by which a drawn point may be moved in the image from its place on the
  // meshes: by the snap of a vertex, or from a border to the corner of a ribbon and its snap.
  double snap_px() const { return (kRibbonSteps + 1) * std::numbers::sqrt2 * step_px_; }

  // Returns the same for what draw_tile_ids() draws as TilePart::kSurface, by triangle, in an image of this longest side: a
  // corner's half step each way and a quarter of a step by which a rasteriser may be wrong about an edge are less
  // than a step; depth is rounded as if it came from four roundings of the place in the image.
  double surface_snap_px(int longest_side_px) const { return step_px_ + 0x1p-22 * longest_side_px; }

 private:
  static constexpr int kRibbonSteps = 3;

  struct UsedProgram {
    Program program;
    bool used = true;
  };

  TileFeatures features_of(const TileDraw& tile, TilePart part) const;
  const Program& program(TilePart part, const TileFeatures& features);
  void use(const Program& program, const TileFeatures& features, TilePart part, const core::View& view,
           const ClipProjection& projection);
  void use(const TileDraw& tile, const TileFeatures& features, TilePart part, const core::View& view,
           float near_m);
  void draw_part(const TileDraw& tile, const TileFeatures& features, TilePart part, const core::View& view,
                 float near_m);
  template <typename DrawOne>
  void draw_before_ground(const core::View& view, const ClipProjection& projection,
                          std::span<const TileDraw> tiles, const DrawOne& draw_one);
  void draw_indices(const GpuMesh& mesh, GLenum what, std::uint32_t begin, std::uint32_t end);
  void draw_surface(const TileDraw& tile, bool facets);
  // Counts triangles that were drawn, and waits for earlier ones where too many are ahead of the rasteriser.
  void keep_up(std::size_t triangles);

  double radius_m_;
  double exaggeration_ = 1;
  std::map<std::pair<TilePart, TileFeatures>, UsedProgram> programs_;
  Air air_;
  std::optional<SunLight> light_;
  Texture2D palette_;
  glm::vec2 palette_terms_{0, 0};
  VertexArray array_;
  bool reads_normals_ = false;   // array_ does
  std::vector<GLsizei> counts_;  // of a call that draws several ranges
  std::vector<const void*> begins_;
  std::size_t ahead_ = 0;  // triangles drawn since sent_
  Fence sent_;             // behind the last triangles that were sent
  double step_px_ = 1.0 / 256;
  const TileDraw* first_with_id_ = nullptr;  // not null: IDs are drawn, relative to this tile
};

}  // namespace vpe::gl
