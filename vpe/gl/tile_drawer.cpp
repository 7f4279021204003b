#include "vpe/gl/tile_drawer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

#include "vpe/core/appearance/shading.h"
#include "vpe/gl/shaders.h"

namespace vpe::gl {

namespace {

// Lines and dots on the ground are nearer than it by this part of their distance, so that it does not hide
// them.
constexpr float kNearer = 1.002F;

Program make_part(TilePart part, const TileFeatures& features) {
  const ShaderSources shaders = tile_shaders(part, features);
  const char* const names[] = {"tile", "ribbon", "skirt"};
  return make_program(names[static_cast<std::size_t>(part)], shaders.vertex.c_str(), shaders.fragment.c_str(),
                      shaders.geometry.empty() ? nullptr : shaders.geometry.c_str());
}

}  // namespace

TileFeatures TileDrawer::features_of(const TileDraw& tile, TilePart part) const {
  TileFeatures features;
  features.by_triangle = part == TilePart::kSurface && tile.by_triangle;
  features.thin = features.by_triangle && first_with_id_ != nullptr;
  if (first_with_id_ != nullptr) return features;
  features.facets = tile.texture != nullptr && tile.texture->intervals == 0;
  features.texture = tile.texture != nullptr && !features.facets;
  features.palette = tile.texture == nullptr && tile.palette;
  features.nodata = tile.texture != nullptr && tile.texture->nodata && tile.mesh->charts;
  features.nodata_image = features.nodata && tile.texture->nodata_image;
  features.haze = air_.visibility_m > 0.0F;
  features.placed = features.texture && !tile.mesh->charts;
  features.light = light_.has_value() && tile.mesh->normals;
  return features;
}

const Program& TileDrawer::program(TilePart part, const TileFeatures& features) {
  const std::pair key(part, features);
  auto at = programs_.find(key);
  if (at == programs_.end()) at = programs_.emplace(key, UsedProgram{make_part(part, features)}).first;
  at->second.used = true;
  return at->second.program;
}

void TileDrawer::drop_unused() {
  std::erase_if(programs_, [](const auto& entry) { return !entry.second.used; });
  for (auto& [key, program] : programs_) program.used = false;
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
  glVertexArrayAttribFormat(array, 2, 2, GL_SHORT, GL_TRUE, 0);
  glVertexArrayAttribBinding(array, 1, 1);
  glVertexArrayAttribBinding(array, 2, 2);
  GLint bits = 0;
  glGetIntegerv(GL_SUBPIXEL_BITS, &bits);
  check_gl("set up drawing of tiles");
  step_px_ = std::exp2(-bits);
}

void TileDrawer::use(const Program& program, const TileFeatures& features, TilePart part,
                     const core::View& view, const ClipProjection& projection) {
  const glm::mat3 rotation = body_to_camera(view.camera.axes);
  const glm::ivec2 size = core::drawn_size(view);
  glUseProgram(program.name());
  glUniformMatrix3fv(tile_uniform("rotation"), 1, GL_FALSE, &rotation[0][0]);
  glUniform4fv(tile_uniform("projection"), 1, &projection.scale_shift[0]);
  glUniform1f(tile_uniform("near"), projection.near_m);
  if (part == TilePart::kSurface) {
    const auto per_px = static_cast<float>(0.5 / step_px_);
    glUniform2f(tile_uniform("steps"), per_px * static_cast<float>(size.x),
                per_px * static_cast<float>(size.y));
  } else {
    glUniform3f(tile_uniform("ribbon"), 0.5F * static_cast<float>(size.x), 0.5F * static_cast<float>(size.y),
                static_cast<float>(kRibbonSteps * step_px_));
  }
  if (features.light != reads_normals_) {
    reads_normals_ = features.light;
    (reads_normals_ ? glEnableVertexArrayAttrib : glDisableVertexArrayAttrib)(array_.name(), 2);
  }
  if (features.light) {
    glUniform3fv(tile_uniform("light_sun"), 1, &light_->sun[0]);
    glUniform2f(tile_uniform("light_terms"), light_->ambient, light_->diffuse);
  }
  if (features.palette) {
    glUniform2fv(tile_uniform("palette_terms"), 1, &palette_terms_[0]);
    glBindTextureUnit(1, palette_.name());
  }
  if (features.haze) {
    const auto extinction = static_cast<float>(core::kKoschmieder / air_.visibility_m);
    glUniform4f(tile_uniform("haze"), air_.haze.x, air_.haze.y, air_.haze.z, extinction);
    const double r = glm::length(view.camera.position_m);
    const glm::vec3 up = rotation * glm::vec3(view.camera.position_m / r);
    glUniform3fv(tile_uniform("up"), 1, &up[0]);
    const glm::vec3 sun = rotation * air_.sun;
    glUniform3fv(tile_uniform("sun"), 1, &sun[0]);
    glUniform4f(tile_uniform("air"), static_cast<float>(radius_m_), static_cast<float>(r - radius_m_),
                static_cast<float>(core::kAirTop_m), static_cast<float>(1.0 / core::kAirScale_m));
  }
}

void TileDrawer::use(const TileDraw& tile, const TileFeatures& features, TilePart part, const core::View& view,
                     float near_m) {
  const GpuMesh& mesh = *tile.mesh;
  const glm::vec3 to_camera(mesh.centre_m - view.camera.position_m);
  const glm::vec3 centre(mesh.centre_m);
  glUniform3fv(tile_uniform("to_camera"), 1, &to_camera[0]);
  glUniform3fv(tile_uniform("centre"), 1, &centre[0]);
  glUniform1f(tile_uniform("skirt"), 0.0F);
  glUniform1f(tile_uniform("snap_from"), near_m + static_cast<float>(mesh.longest_edge_m));
  glUniform1i(tile_uniform("first_foot"), static_cast<GLint>(mesh.first_foot));
  glm::vec4 tint = tile.tint;
  if (first_with_id_ != nullptr) {
    const auto tint_of = [&](TilePart of) {
      const auto rgb = id_colour(pack({static_cast<std::size_t>(&tile - first_with_id_), of}));
      return glm::vec4(glm::vec3(rgb[0], rgb[1], rgb[2]) / 255.0F, 1.0F);
    };
    tint = tint_of(part);
    if (features.thin) {
      const glm::vec4 thin = tint_of(TilePart::kRibbon);
      glUniform4fv(tile_uniform("thin_tint"), 1, &thin[0]);
    }
  }
  glUniform4fv(tile_uniform("tint"), 1, &tint[0]);
  if (features.texture || features.nodata) {
    const glm::vec3 out(mars::face_axes(tile.key.face).out);
    glUniform3fv(tile_uniform("face_out"), 1, &out[0]);
    // Facets are not interpolated.
    const int intervals = features.texture ? tile.texture->intervals : 0;
    const auto texels = static_cast<float>(intervals + 1);
    glUniform2f(tile_uniform("texel"), features.texture ? static_cast<float>(intervals) / texels : 1.0F,
                features.texture ? 0.5F / texels : 0.0F);
    if (features.placed) {
      const mars::FaceAxes& axes = mars::face_axes(tile.key.face);
      const glm::vec3 right(axes.right), up(axes.up);
      const mars::ChartRect rect = lod::chart_rect(tile.key);
      glUniform3fv(tile_uniform("face_right"), 1, &right[0]);
      glUniform3fv(tile_uniform("face_up"), 1, &up[0]);
      glUniform4f(tile_uniform("face_rect"), static_cast<float>(rect.u0), static_cast<float>(rect.v0),
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
  if (!features.facets && !features.palette) {
    const bool alone = tile.flat || tile.texture == nullptr;
    const float factor = alone                                     ? 1.0F
                         : features.texture && tile.texture->light ? static_cast<float>(tile.texture->brightest)
                                                                   : 0.0F;
    const glm::vec3 base = factor > 0.0F ? tile.colour * factor : glm::vec3(1.0F);
    glUniform4f(tile_uniform("flat_colour"), base.x, base.y, base.z, alone ? 1.0F : 0.0F);
  }
  if (features.palette || features.haze) {
    const double outer2 = glm::dot(mesh.centre_m, mesh.centre_m) - radius_m_ * radius_m_;
    glUniform3f(tile_uniform("height_terms"), static_cast<float>(outer2), static_cast<float>(radius_m_),
                static_cast<float>(1.0 / exaggeration_));
  }
  if (features.nodata) {
    const mars::ChartRect rect = lod::chart_rect(tile.key);
    const double corner = rect.u0 + rect.v0;
    // Finer stripes would show the rounding of the phase and of texture coordinates, which is in proportion to
    // the tile.
    const int finest = std::min(tile.key.level + 14, 22);
    glUniform3f(tile_uniform("tile_sides"), static_cast<float>(rect.u1 - rect.u0),
                static_cast<float>(rect.v1 - rect.v0), static_cast<float>(finest));
    glUniform1ui(tile_uniform("tile_phase"), static_cast<GLuint>((corner - std::floor(corner)) * 0x1p32));
  }
  if (features.light) glVertexArrayVertexBuffer(array_.name(), 2, mesh.normals.name(), 0, sizeof(VertexNormal));
  glVertexArrayVertexBuffer(array_.name(), 0, mesh.positions.name(), 0, sizeof(VertexPosition));
  glVertexArrayElementBuffer(array_.name(), mesh.indices.name());
}

void TileDrawer::keep_up(std::size_t triangles) {
  ahead_ += triangles;
  if (ahead_ < kTrianglesAhead) return;
  ahead_ = 0;
  Fence next = Fence::make();
  sent_.wait();
  sent_ = std::move(next);
}

void TileDrawer::draw_indices(const GpuMesh& mesh, GLenum what, std::uint32_t begin, std::uint32_t end) {
  const std::size_t index_size = mesh.short_indices ? 2 : 4;
  glDrawElements(what, static_cast<GLsizei>(end - begin),
                 mesh.short_indices ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(index_size * begin));
  keep_up((end - begin) / 3);
}

void TileDrawer::draw_surface(const TileDraw& tile, bool facets) {
  const GpuMesh& mesh = *tile.mesh;
  if (facets) {  // each call counts its triangles from 0
    for (const IndexRange& range : tile.surface) {
      glUniform1i(tile_uniform("first_facet"), static_cast<GLint>(range.begin / 3));
      draw_indices(mesh, GL_TRIANGLES, range.begin, range.end);
    }
    return;
  }
  const std::size_t index_size = mesh.short_indices ? 2 : 4;
  counts_.clear();
  begins_.clear();
  for (const IndexRange& range : tile.surface) {
    counts_.push_back(static_cast<GLsizei>(range.end - range.begin));
    begins_.push_back(reinterpret_cast<const void*>(index_size * range.begin));
  }
  glMultiDrawElements(GL_TRIANGLES, counts_.data(), mesh.short_indices ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT,
                      begins_.data(), static_cast<GLsizei>(counts_.size()));
  keep_up(static_cast<std::size_t>(std::reduce(counts_.begin(), counts_.end())) / 3);
}

void TileDrawer::draw_part(const TileDraw& tile, const TileFeatures& features, TilePart part,
                           const core::View& view, float near_m) {
  const GpuMesh& mesh = *tile.mesh;
  const auto first_facet = [&](std::uint32_t border_line) {
    if (features.facets)
      glUniform1i(tile_uniform("first_facet"), static_cast<GLint>(mesh.ranges.surface / 3 + border_line));
  };
  switch (part) {
    case TilePart::kSurface:
      if (tile.surface.empty()) return;
      use(tile, features, part, view, near_m);
      draw_surface(tile, features.facets);
      return;
    case TilePart::kRibbon:
      use(tile, features, part, view, near_m);
      first_facet(0);
      draw_indices(mesh, GL_LINES, mesh.ranges.skirts[4], mesh.ranges.border_end);
      return;
    case TilePart::kSkirt:
      bool used = false;
      for (std::size_t e = 0; e < tile.skirt_m.size(); ++e) {
        if (tile.skirt_m[e] <= 0.0F) continue;
        if (!used) use(tile, features, part, view, near_m);
        used = true;
        glUniform1f(tile_uniform("skirt"), tile.skirt_m[e]);
        first_facet((mesh.ranges.skirts[e] - mesh.ranges.skirts[0]) / 4);
        draw_indices(mesh, GL_LINES_ADJACENCY, mesh.ranges.skirts[e], mesh.ranges.skirts[e + 1]);
      }
      return;
  }
}

void TileDrawer::draw(const core::View& view, const ClipProjection& projection,
                      std::span<const TileDraw> tiles) {
  glBindVertexArray(array_.name());
  for (const TilePart part : {TilePart::kSurface, TilePart::kRibbon, TilePart::kSkirt}) {
    std::map<TileFeatures, std::vector<const TileDraw*>> by_features;
    for (const TileDraw& tile : tiles) by_features[features_of(tile, part)].push_back(&tile);
    for (const auto& [features, painted] : by_features) {
      use(program(part, features), features, part, view, projection);
      for (const TileDraw* tile : painted) draw_part(*tile, features, part, view, projection.near_m);
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
    TileFeatures features = features_of(tile, TilePart::kSurface);
    features.by_triangle = false;
    use(program(TilePart::kSurface, features), features, TilePart::kSurface, view, nearer);
    use(tile, features, TilePart::kSurface, view, nearer.near_m);
    draw_one(tile);
  }
}

void TileDrawer::draw_vertices(const core::View& view, const ClipProjection& projection,
                               std::span<const TileDraw> tiles, float size_px) {
  glPointSize(size_px);
  draw_before_ground(view, projection, tiles, [](const TileDraw& tile) {
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(tile.mesh->first_foot));
  });
  glPointSize(1.0F);
}

void TileDrawer::draw_edges(const core::View& view, const ClipProjection& projection,
                            std::span<const TileDraw> tiles) {
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  draw_before_ground(view, projection, tiles, [this](const TileDraw& tile) { draw_surface(tile, false); });
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void TileDrawer::draw_tile_ids(const core::View& view, const ClipProjection& projection,
                               std::span<const TileDraw> tiles) {
  first_with_id_ = tiles.data();
  draw(view, projection, tiles);
  first_with_id_ = nullptr;
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
  const TileFeatures features;
  use(program(TilePart::kRibbon, features), features, TilePart::kRibbon, view, nearer);
  glUniform3f(tile_uniform("ribbon"), 0.5F * static_cast<float>(size.x), 0.5F * static_cast<float>(size.y),
              kHalfWidth_px);
  for (TileDraw tile : tiles) {
    tile.texture = nullptr;
    tile.palette = false;
    tile.tint = glm::vec4(colour, 1.0F);
    draw_part(tile, features, TilePart::kRibbon, view, nearer.near_m);
  }
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
}

}  // namespace vpe::gl
