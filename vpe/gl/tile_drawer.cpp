#include "vpe/gl/tile_drawer.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "vpe/core/appearance/shading.h"
#include "vpe/gl/shaders.h"

namespace vpe::gl {

namespace {

// Lines and dots on the ground are before it by this part of their distance, so that it does not hide them.
constexpr float kNearer = 1.002F;

Program make_part(TilePart part, const TilePaint& paint) {
  const TileShaders shaders = tile_shaders(part, paint);
  const char* const names[] = {"tile", "ribbon", "skirt"};
  return make_program(names[static_cast<std::size_t>(part)], shaders.vertex.c_str(), shaders.fragment.c_str(),
                      shaders.geometry.empty() ? nullptr : shaders.geometry.c_str());
}

}  // namespace

TilePaint TileDrawer::paint_of(const TileDraw& tile) const {
  TilePaint paint;
  if (numbered_from_ != nullptr) return paint;
  paint.facets = tile.texture != nullptr && tile.texture->intervals == 0;
  paint.texture = tile.texture != nullptr && !paint.facets;
  paint.palette = tile.texture == nullptr && tile.palette;
  paint.nodata = tile.texture != nullptr && tile.texture->nodata && tile.mesh->charts;
  paint.haze = air_.visibility_m > 0.0F;
  paint.placed = paint.texture && !tile.mesh->charts;
  return paint;
}

TileDrawer::Programs& TileDrawer::programs(const TilePaint& paint) {
  auto at = programs_.find(paint);
  if (at == programs_.end()) {
    at = programs_
             .emplace(paint, Programs{make_part(TilePart::kSurface, paint), make_part(TilePart::kRibbon, paint),
                                      make_part(TilePart::kSkirt, paint)})
             .first;
  }
  at->second.used = true;
  return at->second;
}

void TileDrawer::drop_unused() {
  std::erase_if(programs_, [](const auto& entry) { return !entry.second.used; });
  for (auto& [paint, programs] : programs_) programs.used = false;
}

void TileDrawer::set_palette(const PaletteTable* table) {
  if (table == nullptr) {
    palette_ = {};
    return;
  }
  const auto count = static_cast<GLsizei>(table->colours.size());
  palette_ = Texture2D::make();
  const GLuint name = palette_.name();
  glTextureStorage2D(name, 1, GL_RGB8, count, 1);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(name, 0, 0, 0, count, 1, GL_RGB, GL_UNSIGNED_BYTE, table->colours.data());
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  check_gl("upload a palette");
  const double per_m = (count - 1.0) / count / (table->high - table->low);
  palette_terms_ = {static_cast<float>(per_m), static_cast<float>(0.5 / count - per_m * table->low)};
}

TileDrawer::TileDrawer(double planet_radius_m) : radius_m_(planet_radius_m), array_(VertexArray::make()) {
  const GLuint array = array_.name();
  glEnableVertexArrayAttrib(array, 0);
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribFormat(array, 1, 2, GL_UNSIGNED_SHORT, GL_TRUE, 0);
  glVertexArrayAttribBinding(array, 0, 0);
  glVertexArrayAttribBinding(array, 1, 1);
  GLint bits = 0;
  glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
  check_gl("set up drawing of tiles");
  step_px_ = std::exp2(-bits);
}

void TileDrawer::use(const Program& program, const TilePaint& paint, TilePart part, const core::View& view,
                     const ClipProjection& projection) {
  const glm::mat3 rotation = body_to_camera(view.camera.axes);
  const glm::ivec2 size = core::drawn_size(view);
  glUseProgram(program.name());
  glUniformMatrix3fv(kRotation, 1, GL_FALSE, &rotation[0][0]);
  glUniform4fv(kLens, 1, &projection.scale_shift[0]);
  glUniform1f(kNear, projection.near_m);
  if (part == TilePart::kSurface) {
    const auto per_px = static_cast<float>(0.5 / step_px_);
    glUniform2f(kSteps, per_px * static_cast<float>(size.x), per_px * static_cast<float>(size.y));
  } else {
    glUniform3f(kRibbon, 0.5F * static_cast<float>(size.x), 0.5F * static_cast<float>(size.y),
                static_cast<float>(kRibbonSteps * step_px_));
  }
  if (paint.palette) {
    glUniform2fv(kPaletteTerms, 1, &palette_terms_[0]);
    glBindTextureUnit(1, palette_.name());
  }
  if (paint.haze) {
    const auto extinction = static_cast<float>(core::kKoschmieder / air_.visibility_m);
    const glm::vec3 dust(core::kDust / 255.0);
    glUniform4f(kHaze, dust.x, dust.y, dust.z, extinction);
    const double r = glm::length(view.camera.position_m);
    const glm::vec3 up = rotation * glm::vec3(view.camera.position_m / r);
    glUniform3fv(kUp, 1, &up[0]);
    const glm::vec3 sun = rotation * air_.sun;
    glUniform3fv(kSun, 1, &sun[0]);
    glUniform4f(kAir, static_cast<float>(radius_m_), static_cast<float>(r - radius_m_),
                static_cast<float>(core::kAirTop_m), static_cast<float>(1.0 / core::kAirScale_m));
  }
}

void TileDrawer::use(const TileDraw& tile, const TilePaint& paint, TilePart part, const core::View& view,
                     float near_m) {
  const GpuMesh& mesh = *tile.mesh;
  const glm::vec3 to_camera(mesh.centre_m - view.camera.position_m);
  const glm::vec3 centre(mesh.centre_m);
  glUniform3fv(kToEye, 1, &to_camera[0]);
  glUniform3fv(kCentre, 1, &centre[0]);
  glUniform1f(kSkirt, 0.0F);
  glUniform1f(kSnapFrom, near_m + static_cast<float>(mesh.longest_edge_m));
  glUniform1i(kFirstFoot, static_cast<GLint>(mesh.first_foot));
  glm::vec4 tint = tile.tint;
  if (numbered_from_ != nullptr) {
    const auto rgb = number_colour(pack({static_cast<std::size_t>(&tile - numbered_from_), part}));
    for (int k = 0; k < 3; ++k) tint[k] = static_cast<float>(rgb[static_cast<std::size_t>(k)]) / 255.0F;
    tint.a = 1.0F;
  }
  glUniform4fv(kTint, 1, &tint[0]);
  if (paint.texture || paint.nodata) {
    const glm::vec3 out(mars::face_axes(tile.key.face).out);
    glUniform3fv(kFaceOut, 1, &out[0]);
    // Facets have no texels to be between.
    const int intervals = paint.texture ? tile.texture->intervals : 0;
    const auto texels = static_cast<float>(intervals + 1);
    glUniform2f(kTexel, paint.texture ? static_cast<float>(intervals) / texels : 1.0F,
                paint.texture ? 0.5F / texels : 0.0F);
    if (paint.placed) {
      const mars::FaceAxes& axes = mars::face_axes(tile.key.face);
      const glm::vec3 right(axes.right), up(axes.up);
      const mars::ChartRect rect = lod::chart_rect(tile.key);
      glUniform3fv(kFaceRight, 1, &right[0]);
      glUniform3fv(kFaceUp, 1, &up[0]);
      glUniform4f(kFaceRect, static_cast<float>(rect.u0), static_cast<float>(rect.v0),
                  static_cast<float>(1.0 / (rect.u1 - rect.u0)), static_cast<float>(1.0 / (rect.v1 - rect.v0)));
      glDisableVertexArrayAttrib(array_.name(), 1);
    } else {
      glVertexArrayVertexBuffer(array_.name(), 1, mesh.charts.name(), 0, sizeof(VertexChart));
      glEnableVertexArrayAttrib(array_.name(), 1);
    }
  } else {
    glDisableVertexArrayAttrib(array_.name(), 1);
  }
  if (tile.texture != nullptr) glBindTextureUnit(0, tile.texture->texture.name());
  if (!paint.facets && !paint.palette) {
    const bool alone = tile.flat || tile.texture == nullptr;
    const float factor = alone                                  ? 1.0F
                         : paint.texture && tile.texture->light ? static_cast<float>(tile.texture->brightest)
                                                                : 0.0F;
    const glm::vec3 base = factor > 0.0F ? tile.colour * factor : glm::vec3(1.0F);
    glUniform4f(kFlatColour, base.x, base.y, base.z, alone ? 1.0F : 0.0F);
  }
  if (paint.palette || paint.haze) {
    const double outer2 = glm::dot(mesh.centre_m, mesh.centre_m) - radius_m_ * radius_m_;
    glUniform3f(kHeightTerms, static_cast<float>(outer2), static_cast<float>(radius_m_),
                static_cast<float>(1.0 / exaggeration_));
  }
  if (paint.nodata) {
    const mars::ChartRect rect = lod::chart_rect(tile.key);
    const double corner = rect.u0 + rect.v0;
    // Finer, stripes would show the rounding of texture coordinates, which is in proportion to the tile; and of
    // the phase.
    const int finest = std::min(tile.key.level + 14, 22);
    glUniform3f(kTileSides, static_cast<float>(rect.u1 - rect.u0), static_cast<float>(rect.v1 - rect.v0),
                static_cast<float>(finest));
    glUniform1ui(kTilePhase, static_cast<GLuint>((corner - std::floor(corner)) * 0x1p32));
  }
  glVertexArrayVertexBuffer(array_.name(), 0, mesh.positions.name(), 0, sizeof(VertexPosition));
  glVertexArrayElementBuffer(array_.name(), mesh.indices.name());
}

void TileDrawer::draw_indices(const GpuMesh& mesh, GLenum what, std::uint32_t begin, std::uint32_t end) {
  const std::size_t index_size = mesh.short_indices ? 2 : 4;
  glDrawElements(what, static_cast<GLsizei>(end - begin),
                 mesh.short_indices ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(index_size * begin));
}

void TileDrawer::draw_part(const TileDraw& tile, const TilePaint& paint, TilePart part, const core::View& view,
                           float near_m) {
  const GpuMesh& mesh = *tile.mesh;
  const auto first_facet = [&](std::uint32_t border_line) {
    if (paint.facets) glUniform1i(kFirstFacet, static_cast<GLint>(mesh.ranges.surface / 3 + border_line));
  };
  switch (part) {
    case TilePart::kSurface:
      use(tile, paint, part, view, near_m);
      draw_indices(mesh, GL_TRIANGLES, 0, mesh.ranges.surface);
      return;
    case TilePart::kRibbon:
      use(tile, paint, part, view, near_m);
      first_facet(0);
      draw_indices(mesh, GL_LINES, mesh.ranges.skirts[4], mesh.ranges.border_end);
      return;
    case TilePart::kSkirt:
      bool used = false;
      for (std::size_t e = 0; e < tile.skirt_m.size(); ++e) {
        if (tile.skirt_m[e] <= 0.0F) continue;
        if (!used) use(tile, paint, part, view, near_m);
        used = true;
        glUniform1f(kSkirt, tile.skirt_m[e]);
        first_facet((mesh.ranges.skirts[e] - mesh.ranges.skirts[0]) / 4);
        draw_indices(mesh, GL_LINES_ADJACENCY, mesh.ranges.skirts[e], mesh.ranges.skirts[e + 1]);
      }
      return;
  }
}

void TileDrawer::draw(const core::View& view, const ClipProjection& projection,
                      std::span<const TileDraw> tiles) {
  glBindVertexArray(array_.name());
  std::map<TilePaint, std::vector<const TileDraw*>> by_paint;
  for (const TileDraw& tile : tiles) by_paint[paint_of(tile)].push_back(&tile);
  for (const TilePart part : {TilePart::kSurface, TilePart::kRibbon, TilePart::kSkirt}) {
    for (const auto& [paint, painted] : by_paint) {
      const Programs& made = programs(paint);
      use(part == TilePart::kSurface  ? made.surface
          : part == TilePart::kRibbon ? made.ribbon
                                      : made.skirt,
          paint, part, view, projection);
      for (const TileDraw* tile : painted) draw_part(*tile, paint, part, view, projection.near_m);
    }
  }
}

template <typename DrawOne>
void TileDrawer::draw_before_ground(const core::View& view, const ClipProjection& projection,
                                    std::span<const TileDraw> tiles, const DrawOne& draw_one) {
  ClipProjection nearer = projection;
  nearer.near_m *= kNearer;
  glBindVertexArray(array_.name());
  for (const TileDraw& tile : tiles) {
    const TilePaint paint = paint_of(tile);
    use(programs(paint).surface, paint, TilePart::kSurface, view, nearer);
    use(tile, paint, TilePart::kSurface, view, nearer.near_m);
    draw_one(*tile.mesh);
  }
}

void TileDrawer::draw_vertices(const core::View& view, const ClipProjection& projection,
                               std::span<const TileDraw> tiles, float size_px) {
  glPointSize(size_px);
  draw_before_ground(view, projection, tiles, [](const GpuMesh& mesh) {
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(mesh.first_foot));
  });
  glPointSize(1.0F);
}

void TileDrawer::draw_edges(const core::View& view, const ClipProjection& projection,
                            std::span<const TileDraw> tiles) {
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  draw_before_ground(view, projection, tiles,
                     [this](const GpuMesh& mesh) { draw_indices(mesh, GL_TRIANGLES, 0, mesh.ranges.surface); });
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void TileDrawer::draw_tile_ids(const core::View& view, const ClipProjection& projection,
                               std::span<const TileDraw> tiles) {
  numbered_from_ = tiles.data();
  draw(view, projection, tiles);
  numbered_from_ = nullptr;
}

void TileDrawer::draw_borders(const core::View& view, const ClipProjection& projection,
                              std::span<const TileDraw> tiles, const glm::vec3& colour) {
  constexpr float kHalfWidth_px = 0.75F;
  ClipProjection nearer = projection;
  nearer.near_m *= kNearer;  // depth is the near plane's over the distance
  const glm::ivec2 size = core::drawn_size(view);
  glBindVertexArray(array_.name());
  glDepthMask(GL_FALSE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
  const TilePaint paint;
  use(programs(paint).ribbon, paint, TilePart::kRibbon, view, nearer);
  glUniform3f(kRibbon, 0.5F * static_cast<float>(size.x), 0.5F * static_cast<float>(size.y), kHalfWidth_px);
  for (TileDraw tile : tiles) {
    tile.texture = nullptr;
    tile.palette = false;
    tile.tint = glm::vec4(colour, 1.0F);
    draw_part(tile, paint, TilePart::kRibbon, view, nearer.near_m);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
}

}  // namespace vpe::gl
