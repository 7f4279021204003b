#include "vpe/gl/polygon_renderer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <optional>
#include <stdexcept>

#include "lod/select.h"
#include "vpe/core/parallel.h"
#include "vpe/gl/residency.h"
#include "vpe/gl/shaders.h"
#include "vpe/gl/target.h"

namespace vpe::gl {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Share of the memory budget for each holder; the rest is for the tile index and work in progress.
constexpr double kShaderShare = 0.12;
constexpr double kMeshShare = 0.14;
constexpr double kTextureShare = 0.28;

// What float arithmetic in the vertex stage adds, as a part of the distance: a few roundings of 2^-24.
constexpr double kTransformError = 4e-7;

// Rasterisers snap vertices to 1/256 pixel, and depth is taken at pixel centres up to that far outside a triangle.
constexpr double kRasterSnap_px = 4.0 / 256;

// Depth of skirts, as a part of distance and tile side, that covers what rounding to float opens between equal borders.
constexpr double kSeamError = 1e-6;

constexpr int kSmallestTexture = 128;
constexpr int kLargestTexture = 1024;

struct Lens {
  float near_m;
  glm::vec4 scale_shift;
};

Lens make_lens(const core::View& view, double near_m) {
  const double f = core::focal_px(view);
  const glm::ivec2 size = core::drawn_size(view);
  const double x = 0.5 * view.width + view.principal_offset_px.x - view.part.x;
  const double y = 0.5 * view.height + view.principal_offset_px.y - view.part.y;
  return {static_cast<float>(near_m),
          glm::vec4(2.0 * f / size.x, 2.0 * f / size.y, 1.0 - 2.0 * x / size.x, 2.0 * y / size.y - 1.0)};
}

glm::mat3 body_to_eye(const mars::Axes& axes) {
  const glm::dvec3 back = -axes.forward;
  return glm::mat3(glm::vec3(axes.right.x, axes.up.x, back.x), glm::vec3(axes.right.y, axes.up.y, back.y),
                   glm::vec3(axes.right.z, axes.up.z, back.z));
}

class PolygonRenderer : public core::Renderer {
 public:
  PolygonRenderer(std::shared_ptr<Context> context, std::shared_ptr<const paging::PlanetFile> planet,
                  const RendererOptions& options)
      : context_(std::move(context)),
        planet_(std::move(planet)),
        memory_(options.memory_bytes),
        pool_(options.threads),
        shader_(planet_, share(kShaderShare)),
        tile_program_(make_program("tile", kTileVertexShader, kTileFragmentShader)),
        edge_program_(make_program("edge", kFullScreenVertexShader, kEdgeFragmentShader)),
        sky_program_(make_program("sky", kSkyVertexShader, kSkyFragmentShader)),
        tile_array_(VertexArray::make()),
        empty_array_(VertexArray::make()) {
    const GLuint array = tile_array_.name();
    glEnableVertexArrayAttrib(array, 0);
    glEnableVertexArrayAttrib(array, 1);
    glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, offsetof(TileVertex, position_m));
    glVertexArrayAttribFormat(array, 1, 2, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(TileVertex, s));
    glVertexArrayAttribBinding(array, 0, 0);
    glVertexArrayAttribBinding(array, 1, 0);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glPolygonOffset(-1.0F / 32, 0.0F);  // farther, with reversed depth; rasterisers snap to 1/256 pixel
    check_gl("set up");
  }

  core::DrawResult draw(const core::DrawRequest& request) override;

 private:
  struct Drawn {
    MeshKey mesh;
    TextureKey texture;
    double min_distance_m = 0;
    float skirt_m = 0;
  };

  std::size_t share(double part) const { return static_cast<std::size_t>(part * static_cast<double>(memory_)); }
  ShadeParams shade_params(const core::DrawRequest& request) const;
  void select(const core::DrawRequest& request, const ShadeParams& shading);
  void fit_textures(double focal, Surfacing surfacing);
  void make_resident(const ShadeParams& shading, bool textured);
  TileGeometry geometry(const MeshKey& key, double exaggeration) const;
  double near_plane_m(const core::View& view, double exaggeration) const;
  void draw_tiles(const core::View& view, const Lens& lens, bool textured, bool with_skirts);
  void draw_sky(const core::DrawRequest& request, const Lens& lens);
  void draw_pass(const core::DrawRequest& request, const Lens& lens, Target& to, bool picture);
  void read_range(const core::DrawRequest& request, Lens lens, core::Frame& frame);
  Target& target(std::optional<Target>& slot, const glm::ivec2& size, int samples);
  core::Certificate certify(const core::DrawRequest& request, const Lens& lens) const;

  std::shared_ptr<Context> context_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  std::size_t memory_;
  core::ThreadPool pool_;
  Shader shader_;
  Program tile_program_;
  Program edge_program_;
  Program sky_program_;
  VertexArray tile_array_;
  VertexArray empty_array_;
  std::optional<Target> colour_target_;
  std::optional<Target> range_target_;
  Resident<MeshKey, GpuMesh> meshes_;
  Resident<TextureKey, GpuTexture> textures_;
  ShadeParams resident_shading_;
  std::uint64_t frame_ = 0;

  lod::SelectScratch scratch_;
  lod::Selection selection_;
  std::vector<std::array<float, 4>> skirts_;
  std::vector<Drawn> drawn_;
};

ShadeParams PolygonRenderer::shade_params(const core::DrawRequest& request) const {
  const core::SettingsValues& s = request.settings;
  ShadeParams params;
  params.sun = request.sun;
  params.ambient = s.sun_ambient;
  params.exaggeration = s.exaggeration;
  const bool has_image = planet_->meta().finest_image_level >= 0;
  if (s.mode == core::Mode::kTextured && has_image) {
    params.surfacing = Surfacing::kImage;
  } else if (s.mode == core::Mode::kLit || s.colour == core::Colour::kNone) {
    params.surfacing = Surfacing::kPlain;
  }
  return params;
}

void PolygonRenderer::select(const core::DrawRequest& request, const ShadeParams& shading) {
  lod::SelectOptions options;
  options.tolerance_px = request.settings.lod_tolerance_px;
  options.exaggeration = request.settings.exaggeration;
  options.max_triangles = request.settings.lod_triangles;
  lod::select(options, planet_->tree(), lod::select_view(request.view), scratch_, selection_);
  lod::skirt_depths(selection_, planet_->tree(), skirts_);
  drawn_.clear();
  for (std::size_t n = 0; n < selection_.tiles.size(); ++n) {
    const lod::SelectedTile& tile = selection_.tiles[n];
    const std::array<float, 4>& depths = skirts_[n];
    const double side = lod::nominal_side_m(tile.key.level, planet_->radius_m());
    drawn_.push_back({{tile.key, tile.variant},
                      {tile.key, 0},
                      tile.min_distance_m,
                      // Exact borders are still rounded to float on either side of them.
                      *std::max_element(depths.begin(), depths.end()) +
                          static_cast<float>(kSeamError * (tile.min_distance_m + 2.0 * side))});
  }
  fit_textures(core::focal_px(request.view), shading.surfacing);
}

// One texel a pixel at the tile's nearest point, unless the data or the memory has less.
void PolygonRenderer::fit_textures(double focal, Surfacing surfacing) {
  for (Drawn& d : drawn_) {
    const double side = lod::nominal_side_m(d.texture.tile.level, planet_->radius_m());
    const double wanted = 0.75 * side * focal / std::max(d.min_distance_m, 1e-3 * side);
    int intervals = kSmallestTexture;
    const int most = std::min(kLargestTexture, shader_.useful_intervals(d.texture.tile, surfacing));
    while (intervals < wanted && intervals < most) intervals *= 2;
    d.texture.intervals = intervals;
  }
  for (int cap = kLargestTexture; cap > kSmallestTexture; cap /= 2) {
    std::size_t bytes = 0;
    for (const Drawn& d : drawn_) {
      const auto side = static_cast<std::size_t>(d.texture.intervals) + 1;
      bytes += 4 * side * side;
    }
    if (bytes <= share(kTextureShare)) return;
    for (Drawn& d : drawn_) d.texture.intervals = std::min(d.texture.intervals, cap / 2);
  }
}

TileGeometry PolygonRenderer::geometry(const MeshKey& key, double exaggeration) const {
  const lod::TileInfo* info = planet_->tree().find(key.tile);
  const bool full = !info->has_children && key.variant + 1 == static_cast<int>(info->variants.size());
  if (full) {
    const paging::TileHeights heights = planet_->heights(key.tile);
    return make_geometry(key.tile, lod::mesh_full(heights.posts.intervals), heights.posts.height_m, exaggeration,
                         planet_->radius_m());
  }
  const paging::PackedMesh packed = planet_->mesh(key.tile, key.variant);
  std::vector<double> heights(packed.height_q.size());
  std::transform(packed.height_q.begin(), packed.height_q.end(), heights.begin(),
                 [q = planet_->meta().quantum_m](std::int32_t n) { return n * q; });
  return make_geometry(key.tile, packed.mesh, heights, exaggeration, planet_->radius_m());
}

void PolygonRenderer::make_resident(const ShadeParams& shading, bool textured) {
  if (!(shading == resident_shading_)) {
    textures_.clear();
    if (shading.exaggeration != resident_shading_.exaggeration) meshes_.clear();
    resident_shading_ = shading;
  }
  struct Missing {
    const Drawn* tile;
    bool mesh;
    bool texture;
    TileGeometry geometry;
    ShadedTile shaded;
  };
  std::vector<Missing> missing;
  for (const Drawn& d : drawn_) {
    const bool mesh = meshes_.find(d.mesh, frame_) == nullptr;
    const bool texture = textured && textures_.find(d.texture, frame_) == nullptr;
    if (mesh || texture) missing.push_back({&d, mesh, texture, {}, {}});
  }
  meshes_.trim(share(kMeshShare), frame_);
  textures_.trim(share(kTextureShare), frame_);
  constexpr std::size_t kBatch = 16;  // bounds what is made ready but not yet uploaded
  for (std::size_t begin = 0; begin < missing.size(); begin += kBatch) {
    const std::size_t count = std::min(kBatch, missing.size() - begin);
    pool_.run(count, [&](std::size_t n) {
      Missing& m = missing[begin + n];
      if (m.mesh) m.geometry = geometry(m.tile->mesh, shading.exaggeration);
      if (m.texture) m.shaded = shader_.shade(m.tile->texture.tile, m.tile->texture.intervals, shading);
    });
    for (std::size_t n = 0; n < count; ++n) {
      Missing& m = missing[begin + n];
      if (m.mesh) meshes_.insert(m.tile->mesh, upload(m.geometry), frame_);
      if (m.texture) textures_.insert(m.tile->texture, upload(m.shaded), frame_);
      m.geometry = {};
      m.shaded = {};
    }
  }
  meshes_.trim(share(kMeshShare), frame_);
  textures_.trim(share(kTextureShare), frame_);
}

// Depth interpolation loses precision on triangles that reach from the near plane to far away, so the near
// plane is as far out as the ground allows: some fiftieth of the eye's height is only passed by slopes over 88 degrees.
double PolygonRenderer::near_plane_m(const core::View& view, double exaggeration) const {
  const glm::dvec3& eye = view.eye.eye_m;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Drawn& d : drawn_) nearest = std::min(nearest, d.min_distance_m);
  // In the picture's corners depth is less than distance.
  const double f = core::focal_px(view);
  const double x = 0.5 * view.width + std::abs(view.principal_offset_px.x);
  const double y = 0.5 * view.height + std::abs(view.principal_offset_px.y);
  const double cosine = f / std::sqrt(f * f + x * x + y * y);
  if (std::isfinite(nearest) && nearest > 1000.0) return 0.5 * cosine * nearest;
  lod::TileKey key = lod::tile_at(mars::chart_point(eye), 0);
  for (const lod::TileInfo* info = planet_->tree().find(key); info->has_children; info = planet_->tree().find(key)) {
    key = lod::tile_at(mars::chart_point(eye), key.level + 1);
  }
  const paging::TileHeights heights = planet_->heights(key);
  const mars::ChartPoint at = mars::chart_point(eye);
  const double ground = lod::surface_height(heights.posts, lod::grid_lines(key, heights.posts.intervals), at.u, at.v,
                                            planet_->radius_m());
  const double above = glm::length(eye) - planet_->radius_m() - exaggeration * ground;
  return std::clamp(0.03 * cosine * std::abs(above) / std::max(1.0, exaggeration), 0.003, 1000.0);
}

void PolygonRenderer::draw_tiles(const core::View& view, const Lens& lens, bool textured, bool with_skirts) {
  const glm::mat3 rotation = body_to_eye(view.eye.axes);
  glUseProgram(tile_program_.name());
  glBindVertexArray(tile_array_.name());
  glUniformMatrix3fv(kRotation, 1, GL_FALSE, &rotation[0][0]);
  glUniform4fv(kLens, 1, &lens.scale_shift[0]);
  glUniform1f(kNear, lens.near_m);
  if (textured) {
    glUniform4f(kFlatColour, 0, 0, 0, 0);
  } else {
    glUniform4f(kFlatColour, 0.95F, 0.75F, 0.55F, 1);
  }
  for (const Drawn& d : drawn_) {
    const GpuMesh& mesh = *meshes_.find(d.mesh, frame_);
    const glm::vec3 to_eye(mesh.centre_m - view.eye.eye_m);
    const glm::vec3 centre(mesh.centre_m);
    const glm::vec3 out(mars::face_axes(d.mesh.tile.face).out);
    glUniform3fv(kToEye, 1, &to_eye[0]);
    glUniform3fv(kCentre, 1, &centre[0]);
    glUniform3fv(kFaceOut, 1, &out[0]);
    glUniform1f(kSkirt, d.skirt_m);
    glUniform1i(kFirstFoot, static_cast<GLint>(mesh.first_foot));
    if (textured) {
      const GpuTexture& texture = *textures_.find(d.texture, frame_);
      const auto texels = static_cast<float>(texture.intervals + 1);
      glUniform2f(kTexel, static_cast<float>(texture.intervals) / texels, 0.5F / texels);
      glBindTextureUnit(0, texture.texture.name());
    }
    glVertexArrayVertexBuffer(tile_array_.name(), 0, mesh.vertices.name(), 0, sizeof(TileVertex));
    glVertexArrayElementBuffer(tile_array_.name(), mesh.indices.name());
    const GLenum type = mesh.short_indices ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
    const std::size_t index_size = mesh.short_indices ? 2 : 4;
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.surface_indices), type, nullptr);
    if (!with_skirts) continue;
    // A skirt seen edge-on covers stray pixels where its depth, extrapolated by a fraction of a pixel, can lie
    // anywhere. Pushed back by its own slope it never stands before the ground it hangs from.
    glEnable(GL_POLYGON_OFFSET_FILL);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.index_count - mesh.surface_indices), type,
                   reinterpret_cast<const void*>(index_size * mesh.surface_indices));
    glDisable(GL_POLYGON_OFFSET_FILL);
  }
}

void PolygonRenderer::draw_sky(const core::DrawRequest& request, const Lens& lens) {
  const glm::dvec3& eye = request.view.eye.eye_m;
  const double r = glm::length(eye);
  const glm::mat3 to_body = glm::transpose(body_to_eye(request.view.eye.axes));
  const glm::vec3 up(eye / r);
  const glm::vec3 sun(request.sun);
  glUseProgram(sky_program_.name());
  glBindVertexArray(empty_array_.name());
  glUniformMatrix3fv(kSkyRotation, 1, GL_FALSE, &to_body[0][0]);
  glUniform4fv(kSkyLens, 1, &lens.scale_shift[0]);
  glUniform3fv(kSkyUp, 1, &up[0]);
  glUniform2f(kSkyAltitude, static_cast<float>(r - planet_->radius_m()), static_cast<float>(planet_->radius_m()));
  glUniform3fv(kSkySun, 1, &sun[0]);
  glDepthFunc(GL_EQUAL);
  glDepthMask(GL_FALSE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
}

Target& PolygonRenderer::target(std::optional<Target>& slot, const glm::ivec2& size, int samples) {
  if (!slot || slot->width() != size.x || slot->height() != size.y || slot->samples() != samples) {
    slot.reset();
    slot.emplace(size.x, size.y, samples);
  }
  return *slot;
}

core::Certificate PolygonRenderer::certify(const core::DrawRequest& request, const Lens& lens) const {
  const double focal = core::focal_px(request.view);
  core::Certificate c;
  c.tolerance_px = request.settings.lod_tolerance_px;
  c.exaggeration = request.settings.exaggeration;
  c.tiles_drawn = static_cast<int>(drawn_.size());
  double area = 0;
  double limited = 0;
  for (const lod::SelectedTile& tile : selection_.tiles) {
    const lod::TileInfo* info = planet_->tree().find(tile.key);
    const GpuMesh& mesh = *const_cast<Resident<MeshKey, GpuMesh>&>(meshes_).find({tile.key, tile.variant}, frame_);
    // Float storage, and the vertex stage's arithmetic over the whole distance.
    // Nothing is drawn before the near plane.
    const double distance = std::max(tile.min_distance_m, double{lens.near_m});
    const double quantisation_px = mesh.quantisation_m * focal / distance + kTransformError * focal + kRasterSnap_px;
    c.tile_error_m = std::max(c.tile_error_m, tile.error_m);
    c.tile_error_px = std::max(c.tile_error_px, tile.error_px);
    c.quantisation_m = std::max(c.quantisation_m, mesh.quantisation_m);
    c.quantisation_px = std::max(c.quantisation_px, quantisation_px);
    c.shift_bound_px = std::max(c.shift_bound_px, tile.error_px + quantisation_px);
    const double side = lod::nominal_side_m(tile.key.level, planet_->radius_m());
    const double pixels = std::min(side * focal / std::max(tile.min_distance_m, 0.5 * side), 4096.0);
    area += pixels * pixels;
    const double spacing = side / planet_->meta().tile.intervals();
    if (!info->has_children && spacing * focal > tile.min_distance_m) limited += pixels * pixels;
  }
  c.share_at_data_limit = area > 0 ? limited / area : 0.0;
  const paging::PlanetMeta& meta = planet_->meta();
  c.resampling_max_m = meta.resampling.max_m;
  c.resampling_rms_m = meta.resampling.rms_m;
  for (const mars::SourceInfo& s : meta.sources) {
    if (s.accuracy_m) c.source_accuracy_m = std::max(c.source_accuracy_m.value_or(0.0), *s.accuracy_m);
  }
  c.illustration = meta.illustration;
  return c;
}

void PolygonRenderer::draw_pass(const core::DrawRequest& request, const Lens& lens, Target& to, bool picture) {
  const bool wireframe = request.settings.mode == core::Mode::kWireframe;
  const bool textured = !wireframe && request.settings.mode != core::Mode::kUnlit;
  const float paper = request.settings.background == core::Background::kWhite ? 1.0F : 0.0F;
  to.bind();
  glClearColor(paper, paper, paper, 1.0F);
  glClearDepth(0.0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDepthFunc(GL_GREATER);
  if (wireframe && picture) glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  draw_tiles(request.view, lens, picture && textured, !(picture && wireframe));
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  if (picture && request.settings.background == core::Background::kSky) draw_sky(request, lens);
}

// Depth is interpolated with an absolute error of some 2^-24 near the near plane, so a first pass finds the
// nearest surface and a second one puts the near plane just before it.
void PolygonRenderer::read_range(const core::DrawRequest& request, Lens lens, core::Frame& frame) {
  const glm::ivec2 size = core::drawn_size(request.view);
  Target& to = target(range_target_, size, 1);
  for (int pass = 0; pass < 2; ++pass) {
    draw_pass(request, lens, to, false);
    to.read_depth(frame.range_m);
    const float nearest = *std::max_element(frame.range_m.begin(), frame.range_m.end());
    if (pass == 0 && nearest > 0.0F) lens.near_m = std::max(lens.near_m, 0.5F * lens.near_m / nearest);
  }
  const core::View& view = request.view;
  const double f = core::focal_px(view);
  const double cx = 0.5 * view.width + view.principal_offset_px.x - view.part.x;
  const double cy = 0.5 * view.height + view.principal_offset_px.y - view.part.y;
  for (int y = 0; y < size.y; ++y) {
    float* row = &frame.range_m[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x)];
    const double b = (y + 0.5 - cy) / f;
    for (int x = 0; x < size.x; ++x) {
      const double a = (x + 0.5 - cx) / f;
      row[x] = row[x] > 0.0F ? static_cast<float>(lens.near_m / row[x] * std::sqrt(1.0 + a * a + b * b)) : core::kSkyRange;
    }
  }
}

core::DrawResult PolygonRenderer::draw(const core::DrawRequest& request) {
  if (const std::string trouble = core::check(request.view); !trouble.empty()) throw std::runtime_error(trouble);
  if (request.view.projection != core::Projection::kPerspective) {
    throw std::runtime_error("the polygon backend draws perspective views only");
  }
  ++frame_;
  core::DrawResult result;
  const core::SettingsValues& settings = request.settings;
  const ShadeParams shading = shade_params(request);
  auto start = Clock::now();
  select(request, shading);
  result.stats.select_ms = ms_since(start);
  start = Clock::now();
  make_resident(shading, settings.mode != core::Mode::kWireframe && settings.mode != core::Mode::kUnlit);
  result.stats.load_ms = ms_since(start);

  start = Clock::now();
  const glm::ivec2 size = core::drawn_size(request.view);
  const Lens lens = make_lens(request.view, near_plane_m(request.view, settings.exaggeration));
  Target& picture = target(colour_target_, size, settings.samples);
  draw_pass(request, lens, picture, true);
  if (settings.samples == 1 && settings.smooth_edges && settings.mode != core::Mode::kWireframe) {
    picture.filter(edge_program_, empty_array_);
  }
  glFinish();
  check_gl("draw");
  result.stats.draw_ms = ms_since(start);

  start = Clock::now();
  result.frame.width = size.x;
  result.frame.height = size.y;
  picture.read_colour(result.frame.colour);
  if (request.want_range) read_range(request, lens, result.frame);
  result.stats.read_ms = ms_since(start);

  core::FrameStats& stats = result.stats;
  stats.tiles_visited = selection_.visited;
  stats.tiles_culled_frustum = selection_.culled_frustum;
  stats.tiles_culled_horizon = selection_.culled_horizon;
  stats.tiles_drawn = static_cast<int>(drawn_.size());
  for (const Drawn& d : drawn_) {
    const GpuMesh& mesh = *meshes_.find(d.mesh, frame_);
    stats.triangles += mesh.surface_indices / 3;
    stats.skirt_triangles += (mesh.index_count - mesh.surface_indices) / 3;
    const auto level = static_cast<std::size_t>(d.mesh.tile.level);
    if (stats.tiles_by_level.size() <= level) stats.tiles_by_level.resize(level + 1);
    ++stats.tiles_by_level[level];
  }
  stats.bytes_resident = static_cast<std::int64_t>(meshes_.bytes() + textures_.bytes() + shader_.bytes_resident());
  result.certificate = certify(request, lens);
  return result;
}

}  // namespace

std::unique_ptr<core::Renderer> make_polygon_renderer(std::shared_ptr<Context> context,
                                                      std::shared_ptr<const paging::PlanetFile> planet,
                                                      const RendererOptions& options) {
  return std::make_unique<PolygonRenderer>(std::move(context), std::move(planet), options);
}

}  // namespace vpe::gl
