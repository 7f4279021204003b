#include "vpe/gl/tile_drawer.h"

#include <cmath>

#include "vpe/gl/shaders.h"

namespace vpe::gl {

TileDrawer::TileDrawer()
    : surface_program_(make_program("tile", kTileVertexShader, kTileFragmentShader)),
      ribbon_program_(make_program("ribbon", kTileVertexShader, kTileFragmentShader, kRibbonGeometryShader)),
      skirt_program_(make_program("skirt", kTileVertexShader, kSkirtFragmentShader, kSkirtGeometryShader)),
      array_(VertexArray::make()) {
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

void TileDrawer::use(const Program& program, const core::View& view, const Lens& lens) {
  const glm::mat3 rotation = body_to_eye(view.eye.axes);
  const glm::ivec2 size = core::drawn_size(view);
  glUseProgram(program.name());
  glUniformMatrix3fv(kRotation, 1, GL_FALSE, &rotation[0][0]);
  glUniform4fv(kLens, 1, &lens.scale_shift[0]);
  glUniform1f(kNear, lens.near_m);
  if (&program == &surface_program_) {
    const auto per_px = static_cast<float>(0.5 / step_px_);
    glUniform2f(kSteps, per_px * static_cast<float>(size.x), per_px * static_cast<float>(size.y));
  } else {
    glUniform3f(kRibbon, 0.5F * static_cast<float>(size.x), 0.5F * static_cast<float>(size.y),
                static_cast<float>(kRibbonSteps * step_px_));
  }
}

void TileDrawer::use(const TileDraw& tile, const core::View& view) {
  const GpuMesh& mesh = *tile.mesh;
  const glm::vec3 to_eye(mesh.centre_m - view.eye.eye_m);
  const glm::vec3 centre(mesh.centre_m);
  const glm::vec3 out(mars::face_axes(tile.face).out);
  glUniform3fv(kToEye, 1, &to_eye[0]);
  glUniform3fv(kCentre, 1, &centre[0]);
  glUniform3fv(kFaceOut, 1, &out[0]);
  glUniform1f(kSkirt, 0.0F);
  glUniform1i(kFirstFoot, static_cast<GLint>(mesh.first_foot));
  if (tile.texture != nullptr) {
    const auto texels = static_cast<float>(tile.texture->intervals + 1);
    glUniform2f(kTexel, static_cast<float>(tile.texture->intervals) / texels, 0.5F / texels);
    glUniform4f(kFlatColour, 0, 0, 0, 0);
    glBindTextureUnit(0, tile.texture->texture.name());
  } else {
    glUniform4f(kFlatColour, 0.95F, 0.75F, 0.55F, 1);
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

void TileDrawer::draw(const core::View& view, const Lens& lens, std::span<const TileDraw> tiles, Gaps gaps) {
  glBindVertexArray(array_.name());
  use(surface_program_, view, lens);
  for (const TileDraw& tile : tiles) {
    use(tile, view);
    draw_indices(*tile.mesh, GL_TRIANGLES, 0, tile.mesh->ranges.surface);
  }
  if (gaps == Gaps::kLeave) return;
  use(ribbon_program_, view, lens);
  use(ribbon_program_, view, lens);
  for (const TileDraw& tile : tiles) {
    use(tile, view);
    draw_indices(*tile.mesh, GL_LINES, tile.mesh->ranges.skirts[4], tile.mesh->ranges.border_end);
  }
  use(skirt_program_, view, lens);
  for (const TileDraw& tile : tiles) {
    bool used = false;
    for (std::size_t e = 0; e < tile.skirt_m.size(); ++e) {
      if (tile.skirt_m[e] <= 0.0F) continue;
      if (!used) use(tile, view);
      used = true;
      glUniform1f(kSkirt, tile.skirt_m[e]);
      draw_indices(*tile.mesh, GL_LINES_ADJACENCY, tile.mesh->ranges.skirts[e],
                   tile.mesh->ranges.skirts[e + 1]);
    }
  }
}

}  // namespace vpe::gl
