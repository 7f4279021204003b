#include "vpe/gl/tile_drawer.h"

#include <algorithm>
#include <cmath>

#include "vpe/gl/shaders.h"

namespace vpe::gl {

TileDrawer::Programs TileDrawer::make_programs(const char* label, const char* fragment,
                                               const char* skirt_fragment) {
  const std::string name(label);
  return {make_program(name + "tile", kTileVertexShader, fragment),
          make_program(name + "ribbon", kTileVertexShader, fragment, kRibbonGeometryShader),
          make_program(name + "skirt", kTileVertexShader, skirt_fragment, kSkirtGeometryShader)};
}

TileDrawer::TileDrawer()
    : programs_(make_programs("", kTileFragmentShader, kSkirtFragmentShader)), array_(VertexArray::make()) {
  const GLuint array = array_.name();
  glEnableVertexArrayAttrib(array, 0);
  glEnableVertexArrayAttrib(array, 1);
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, offsetof(TileVertex, position_m));
  glVertexArrayAttribFormat(array, 1, 2, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(TileVertex, s));
  glVertexArrayAttribBinding(array, 0, 0);
  glVertexArrayAttribBinding(array, 1, 0);
  GLint bits = 0;
  glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
  check_gl("set up drawing of tiles");
  step_px_ = std::exp2(-bits);
}

void TileDrawer::use(const Program& program, TilePart part, const core::View& view, const Lens& lens) {
  const glm::mat3 rotation = body_to_eye(view.eye.axes);
  const glm::ivec2 size = core::drawn_size(view);
  glUseProgram(program.name());
  glUniformMatrix3fv(kRotation, 1, GL_FALSE, &rotation[0][0]);
  glUniform4fv(kLens, 1, &lens.scale_shift[0]);
  glUniform1f(kNear, lens.near_m);
  if (part == TilePart::kSurface) {
    const auto per_px = static_cast<float>(0.5 / step_px_);
    glUniform2f(kSteps, per_px * static_cast<float>(size.x), per_px * static_cast<float>(size.y));
  } else {
    glUniform3f(kRibbon, 0.5F * static_cast<float>(size.x), 0.5F * static_cast<float>(size.y),
                static_cast<float>(kRibbonSteps * step_px_));
  }
}

void TileDrawer::use(const TileDraw& tile, TilePart part, const core::View& view, float near_m) {
  const GpuMesh& mesh = *tile.mesh;
  const glm::vec3 to_eye(mesh.centre_m - view.eye.eye_m);
  const glm::vec3 centre(mesh.centre_m);
  const glm::vec3 out(mars::face_axes(tile.key.face).out);
  glUniform3fv(kToEye, 1, &to_eye[0]);
  glUniform3fv(kCentre, 1, &centre[0]);
  glUniform3fv(kFaceOut, 1, &out[0]);
  glUniform1f(kSkirt, 0.0F);
  glUniform1f(kSnapFrom, near_m + static_cast<float>(mesh.longest_edge_m));
  glUniform1i(kFirstFoot, static_cast<GLint>(mesh.first_foot));
  if (tile.texture != nullptr) {
    const auto texels = static_cast<float>(tile.texture->intervals + 1);
    glUniform2f(kTexel, static_cast<float>(tile.texture->intervals) / texels, 0.5F / texels);
    glBindTextureUnit(0, tile.texture->texture.name());
  }
  if (tile.texture != nullptr && !tile.flat) {
    glUniform4f(kFlatColour, 0, 0, 0, 0);
  } else {
    glUniform4f(kFlatColour, 0.95F, 0.75F, 0.55F, 1);
  }
  glm::vec4 colour = tile.tint;
  if (numbered_from_ != nullptr) {
    const auto rgb = number_colour(pack({static_cast<std::size_t>(&tile - numbered_from_), part}));
    for (int k = 0; k < 3; ++k) colour[k] = static_cast<float>(rgb[static_cast<std::size_t>(k)]) / 255.0F;
    colour.a = 1.0F;
  }
  glUniform4fv(kTint, 1, &colour[0]);
  if (has_gaps(tile)) {
    const mars::ChartRect rect = lod::chart_rect(tile.key);
    const double corner = rect.u0 + rect.v0;
    // Finer, stripes would show the rounding of texture coordinates, which is in proportion to the tile; and of
    // the phase.
    const int finest = std::min(tile.key.level + 14, 22);
    glUniform3f(kTileSides, static_cast<float>(rect.u1 - rect.u0), static_cast<float>(rect.v1 - rect.v0),
                static_cast<float>(finest));
    glUniform1ui(kTilePhase, static_cast<GLuint>((corner - std::floor(corner)) * 0x1p32));
  }
  glVertexArrayVertexBuffer(array_.name(), 0, mesh.vertices.name(), 0, sizeof(TileVertex));
  glVertexArrayElementBuffer(array_.name(), mesh.indices.name());
}

void TileDrawer::draw_indices(const GpuMesh& mesh, GLenum what, std::uint32_t begin, std::uint32_t end) {
  const std::size_t index_size = mesh.short_indices ? 2 : 4;
  glDrawElements(what, static_cast<GLsizei>(end - begin),
                 mesh.short_indices ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(index_size * begin));
}

void TileDrawer::draw_part(const TileDraw& tile, TilePart part, const core::View& view, float near_m) {
  const GpuMesh& mesh = *tile.mesh;
  switch (part) {
    case TilePart::kSurface:
      use(tile, part, view, near_m);
      draw_indices(mesh, GL_TRIANGLES, 0, mesh.ranges.surface);
      return;
    case TilePart::kRibbon:
      use(tile, part, view, near_m);
      draw_indices(mesh, GL_LINES, mesh.ranges.skirts[4], mesh.ranges.border_end);
      return;
    case TilePart::kSkirt:
      bool used = false;
      for (std::size_t e = 0; e < tile.skirt_m.size(); ++e) {
        if (tile.skirt_m[e] <= 0.0F) continue;
        if (!used) use(tile, part, view, near_m);
        used = true;
        glUniform1f(kSkirt, tile.skirt_m[e]);
        draw_indices(mesh, GL_LINES_ADJACENCY, mesh.ranges.skirts[e], mesh.ranges.skirts[e + 1]);
      }
      return;
  }
}

void TileDrawer::draw(const core::View& view, const Lens& lens, std::span<const TileDraw> tiles, Gaps gaps) {
  const bool any_gaps = std::any_of(tiles.begin(), tiles.end(), has_gaps);
  if (any_gaps && !gap_programs_) {
    gap_programs_ =
        make_programs("gap ", with_gaps(kTileFragmentShader).c_str(), with_gaps(kSkirtFragmentShader).c_str());
  }
  glBindVertexArray(array_.name());
  const auto draw_with = [&](const Programs& programs, TilePart part, bool of_gaps) {
    use(part == TilePart::kSurface  ? programs.surface
        : part == TilePart::kRibbon ? programs.ribbon
                                    : programs.skirt,
        part, view, lens);
    for (const TileDraw& tile : tiles) {
      if (has_gaps(tile) == of_gaps) draw_part(tile, part, view, lens.near_m);
    }
  };
  for (const TilePart part : {TilePart::kSurface, TilePart::kRibbon, TilePart::kSkirt}) {
    if (part != TilePart::kSurface && gaps == Gaps::kLeave) return;
    draw_with(programs_, part, false);
    if (any_gaps) draw_with(*gap_programs_, part, true);
  }
}

void TileDrawer::draw_numbers(const core::View& view, const Lens& lens, std::span<const TileDraw> tiles) {
  numbered_from_ = tiles.data();
  draw(view, lens, tiles, Gaps::kClose);
  numbered_from_ = nullptr;
}

void TileDrawer::draw_borders(const core::View& view, const Lens& lens, std::span<const TileDraw> tiles,
                              const glm::vec3& colour) {
  constexpr float kHalfWidth_px = 0.75F;
  constexpr float kNearer = 1.002F;
  Lens nearer = lens;
  nearer.near_m *= kNearer;  // depth is the near plane's over the distance
  const glm::ivec2 size = core::drawn_size(view);
  glBindVertexArray(array_.name());
  glDepthMask(GL_FALSE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
  use(programs_.ribbon, TilePart::kRibbon, view, nearer);
  glUniform3f(kRibbon, 0.5F * static_cast<float>(size.x), 0.5F * static_cast<float>(size.y), kHalfWidth_px);
  for (TileDraw tile : tiles) {
    tile.texture = nullptr;
    tile.tint = glm::vec4(colour, 1.0F);
    draw_part(tile, TilePart::kRibbon, view, nearer.near_m);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
}

}  // namespace vpe::gl
