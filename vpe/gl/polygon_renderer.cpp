#include "vpe/gl/polygon_renderer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <stdexcept>

#include "lod/options.h"
#include "vpe/core/edge_filter.h"
#include "vpe/core/parallel.h"
#include "vpe/gl/certify.h"
#include "vpe/gl/residency.h"
#include "vpe/gl/shaders.h"
#include "vpe/gl/target.h"
#include "vpe/gl/tile_drawer.h"

namespace vpe::gl {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Share of the memory budget for each holder; the rest is for the tile index and work in progress.
constexpr double kShaderShare = 0.14;
constexpr double kMeshShare = 0.17;
constexpr double kTextureShare = 0.34;

// What OpenGL without a GPU keeps of a frame of some 400 000 triangles, and the pictures on their way out.
constexpr std::size_t kDriverBytes = std::size_t{160} << 20;
// So a frame has at most as many triangles as --memory has this many bytes.
constexpr std::size_t kBytesPerTriangle = 600;

// Skirts reach farther down by this part of distance and tile side, for the rounding of their feet to float.
constexpr double kFootError = 1e-6;

constexpr int kSmallestTexture = 128;
constexpr int kLargestTexture = 1024;

class PolygonRenderer : public core::Renderer {
 public:
  PolygonRenderer(std::shared_ptr<Context> context, std::shared_ptr<const paging::PlanetFile> planet,
                  const RendererOptions& options)
      : context_(std::move(context)),
        planet_(std::move(planet)),
        most_triangles_(most_triangles(options.memory_bytes)),
        memory_(std::max(options.memory_bytes / 8,
                         options.memory_bytes - std::min(options.memory_bytes, kDriverBytes))),
        pool_(options.threads),
        shader_(planet_, share(kShaderShare)),
        sky_program_(make_program("sky", kSkyVertexShader, kSkyFragmentShader)),
        empty_array_(VertexArray::make()) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    check_gl("set up");
  }

  core::DrawResult draw(const core::DrawRequest& request) override;

 private:
  struct Drawn {
    MeshKey mesh;
    TextureKey texture;
    double min_distance_m = 0;
    std::array<float, 4> skirt_m{};
  };

  std::size_t share(double part) const { return static_cast<std::size_t>(part * static_cast<double>(memory_)); }
  ShadeParams shade_params(const core::DrawRequest& request) const;
  void select(const core::DrawRequest& request, const ShadeParams& shading);
  int origin(const lod::SelectedTile& tile, const core::View& view) const;
  void fit_textures(double focal, Surfacing surfacing);
  bool textured(const lod::TileKey& tile, core::Mode mode) const;
  void make_resident(const ShadeParams& shading, core::Mode mode);
  TileGeometry geometry(const MeshKey& key, double exaggeration) const;
  double near_plane_m(const core::View& view, double exaggeration) const;
  void draw_sky(const core::DrawRequest& request, const Lens& lens);
  void draw_pass(const core::DrawRequest& request, const Lens& lens, Target& to, bool picture);
  void read_range(const core::DrawRequest& request, Lens lens, core::Frame& frame);
  Target& target(std::optional<Target>& slot, const glm::ivec2& size, int samples);
  std::optional<double> share_without_data(core::Mode mode, const Target& picture) const;
  core::Certificate certify(const core::DrawRequest& request, const Lens& lens);

  std::shared_ptr<Context> context_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  std::int64_t most_triangles_;
  std::size_t memory_;
  core::ThreadPool pool_;
  Shader shader_;
  TileDrawer tiles_;
  Program sky_program_;
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
  std::vector<TileDraw> draws_;
  std::vector<CertifiedTile> certified_;
  std::vector<float> depth_;
};

ShadeParams PolygonRenderer::shade_params(const core::DrawRequest& request) const {
  const core::SettingsValues& s = request.settings;
  ShadeParams params;
  params.sun = request.sun;
  params.ambient = s.sun_ambient;
  params.exaggeration = s.exaggeration;
  const bool has_image = planet_->meta().finest_image_level >= 0;
  if (s.mode == core::Mode::kUnlit) {
    params.surfacing = Surfacing::kPlain;
    params.lit = false;
  } else if (s.mode == core::Mode::kTextured && has_image) {
    params.surfacing = Surfacing::kImage;
  } else if (s.mode == core::Mode::kLit || s.colour == core::Colour::kNone) {
    params.surfacing = Surfacing::kPlain;
  }
  return params;
}

void PolygonRenderer::select(const core::DrawRequest& request, const ShadeParams& shading) {
  const lod::SelectOptions options = lod::select_options(request, planet_->radius_m(), most_triangles_);
  lod::select(options, planet_->tree(), lod::select_view(request.view), scratch_, selection_);
  lod::skirt_depths(selection_, planet_->tree(), skirts_);
  drawn_.clear();
  for (std::size_t n = 0; n < selection_.tiles.size(); ++n) {
    const lod::SelectedTile& tile = selection_.tiles[n];
    const double side = lod::nominal_side_m(tile.key.level, planet_->radius_m());
    drawn_.push_back(
        {{tile.key, tile.variant, origin(tile, request.view)}, {tile.key, 0}, tile.min_distance_m, skirts_[n]});
    for (float& depth : drawn_.back().skirt_m) {
      if (depth > 0.0F) depth += static_cast<float>(kFootError * (tile.min_distance_m + 2.0 * side));
    }
  }
  fit_textures(core::focal_px(request.view), shading.surfacing);
}

// The tile's centre, unless rounding relative to that would show: then the post nearest to the eye.
int PolygonRenderer::origin(const lod::SelectedTile& tile, const core::View& view) const {
  constexpr double kShows_px = 0.01;
  const double side_m = lod::nominal_side_m(tile.key.level, planet_->radius_m());
  if (side_m * core::focal_px(view) < kShows_px * (1 << 24) * tile.min_distance_m) return kTileCentre;
  if (glm::dot(mars::face_axes(tile.key.face).out, view.eye.eye_m) <= 0.0) return kTileCentre;
  const int intervals = planet_->meta().tile.intervals();
  const lod::GridLines lines = lod::grid_lines(tile.key, intervals);
  const mars::ChartPoint eye = mars::chart_on(tile.key.face, view.eye.eye_m);
  const auto nearest = [](const std::vector<double>& line, double x) {
    const auto at = std::lower_bound(line.begin(), line.end(), x) - line.begin();
    return static_cast<int>(std::min(at, static_cast<std::ptrdiff_t>(line.size()) - 1));
  };
  return nearest(lines.v, eye.v) * (intervals + 1) + nearest(lines.u, eye.u);
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
    return make_geometry(key.tile, lod::mesh_full(heights.posts.intervals), heights.posts.height_m,
                         exaggeration, planet_->radius_m(), key.origin);
  }
  const paging::PackedMesh packed = planet_->mesh(key.tile, key.variant);
  std::vector<double> heights(packed.height_q.size());
  std::transform(packed.height_q.begin(), packed.height_q.end(), heights.begin(),
                 [q = planet_->meta().quantum_m](std::int32_t n) { return n * q; });
  return make_geometry(key.tile, packed.mesh, heights, exaggeration, planet_->radius_m(), key.origin);
}

// Unlit ground has one colour; its textures only say where there is no data.
bool PolygonRenderer::textured(const lod::TileKey& tile, core::Mode mode) const {
  if (mode == core::Mode::kWireframe) return false;
  return mode != core::Mode::kUnlit || planet_->has_missing(tile);
}

void PolygonRenderer::make_resident(const ShadeParams& shading, core::Mode mode) {
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
    const bool texture = textured(d.texture.tile, mode) && textures_.find(d.texture, frame_) == nullptr;
    if (mesh || texture) missing.push_back({&d, mesh, texture, {}, {}});
  }
  meshes_.trim(share(kMeshShare), frame_);
  textures_.trim(share(kTextureShare), frame_);
  // Bounds what is made ready but not yet uploaded: up to 4 MB a tile.
  const std::size_t batch = std::clamp<std::size_t>(memory_ >> 26, 2, 16);
  for (std::size_t begin = 0; begin < missing.size(); begin += batch) {
    const std::size_t count = std::min(batch, missing.size() - begin);
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
// plane is as far out as the ground allows: some fiftieth of the eye's height is only passed by slopes over 88
// degrees.
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
  for (const lod::TileInfo* info = planet_->tree().find(key); info->has_children;
       info = planet_->tree().find(key)) {
    key = lod::tile_at(mars::chart_point(eye), key.level + 1);
  }
  const paging::TileHeights heights = planet_->heights(key);
  const mars::ChartPoint at = mars::chart_point(eye);
  const double ground = lod::surface_height(heights.posts, lod::grid_lines(key, heights.posts.intervals), at.u,
                                            at.v, planet_->radius_m());
  const double above = glm::length(eye) - planet_->radius_m() - exaggeration * ground;
  return std::clamp(0.03 * cosine * std::abs(above) / std::max(1.0, exaggeration), 0.003, 1000.0);
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
  glUniform2f(kSkyAltitude, static_cast<float>(r - planet_->radius_m()),
              static_cast<float>(planet_->radius_m()));
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

// Of the picture that was drawn and read last.
std::optional<double> PolygonRenderer::share_without_data(core::Mode mode, const Target& picture) const {
  if (mode == core::Mode::kWireframe) {
    const auto has_missing = [&](const Drawn& d) { return planet_->has_missing(d.mesh.tile); };
    if (std::any_of(drawn_.begin(), drawn_.end(), has_missing)) return std::nullopt;
    return 0.0;
  }
  return std::any_of(draws_.begin(), draws_.end(), TileDrawer::has_gaps) ? 1.0 - picture.mean_alpha() : 0.0;
}

core::Certificate PolygonRenderer::certify(const core::DrawRequest& request, const Lens& lens) {
  certified_.clear();
  for (std::size_t n = 0; n < drawn_.size(); ++n) {
    const lod::SelectedTile& tile = selection_.tiles[n];
    const GpuMesh& mesh = *meshes_.find(drawn_[n].mesh, frame_);
    certified_.push_back(
        {&tile, mesh.quantisation_m, mesh.longest_edge_m, glm::length(mesh.centre_m - request.view.eye.eye_m)});
  }
  core::Certificate c =
      gl::certify(certified_, planet_->tree(), planet_->meta().tile.intervals(),
                  {core::focal_px(request.view), lens.near_m, tiles_.snap_px(), request.settings.exaggeration});
  c.tolerance_px = request.settings.lod_tolerance_px;
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
  const float paper = request.settings.background == core::Background::kWhite ? 1.0F : 0.0F;
  to.bind();
  glClearColor(paper, paper, paper, 1.0F);
  glClearDepth(0.0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDepthFunc(GL_GREATER);
  if (wireframe && picture) glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  draws_.clear();
  for (const Drawn& d : drawn_) {
    const bool textured = picture && this->textured(d.texture.tile, request.settings.mode);
    draws_.push_back({meshes_.find(d.mesh, frame_), textured ? textures_.find(d.texture, frame_) : nullptr,
                      request.settings.mode == core::Mode::kUnlit, d.mesh.tile, d.skirt_m});
  }
  tiles_.draw(request.view, lens, draws_,
              picture && wireframe ? TileDrawer::Gaps::kLeave : TileDrawer::Gaps::kClose);
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
      row[x] = row[x] > 0.0F ? static_cast<float>(lens.near_m / row[x] * std::sqrt(1.0 + a * a + b * b))
                             : core::kSkyRange;
    }
  }
}

core::DrawResult PolygonRenderer::draw(const core::DrawRequest& request) {
  if (const std::string trouble = core::check(request.view); !trouble.empty())
    throw std::runtime_error(trouble);
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
  make_resident(shading, settings.mode);
  result.stats.load_ms = ms_since(start);

  start = Clock::now();
  const glm::ivec2 size = core::drawn_size(request.view);
  const Lens lens = make_lens(request.view, near_plane_m(request.view, settings.exaggeration));
  Target& picture = target(colour_target_, size, settings.samples);
  draw_pass(request, lens, picture, true);
  glFinish();
  check_gl("draw");
  result.stats.draw_ms = ms_since(start);

  start = Clock::now();
  result.frame.width = size.x;
  result.frame.height = size.y;
  picture.read_colour(result.frame.colour);
  const std::optional<double> without_data = share_without_data(settings.mode, picture);
  const bool smooth = settings.samples == 1 && settings.smooth_edges && settings.mode != core::Mode::kWireframe;
  if (smooth) picture.read_depth(depth_);
  result.stats.read_ms = ms_since(start);
  start = Clock::now();
  if (smooth) core::smooth_edges(result.frame.colour, depth_, size.x, size.y, pool_);
  result.stats.draw_ms += ms_since(start);
  start = Clock::now();
  if (request.want_range) read_range(request, lens, result.frame);
  result.stats.read_ms += ms_since(start);

  core::FrameStats& stats = result.stats;
  stats.tiles_visited = selection_.visited;
  stats.tiles_culled_frustum = selection_.culled_frustum;
  stats.tiles_culled_horizon = selection_.culled_horizon;
  stats.tiles_drawn = static_cast<int>(drawn_.size());
  for (const Drawn& d : drawn_) {
    const GpuMesh& mesh = *meshes_.find(d.mesh, frame_);
    stats.triangles += mesh.ranges.surface / 3;
    for (std::size_t e = 0; e < 4; ++e) {
      if (d.skirt_m[e] > 0.0F) stats.skirt_triangles += (mesh.ranges.skirts[e + 1] - mesh.ranges.skirts[e]) / 2;
    }
    const auto level = static_cast<std::size_t>(d.mesh.tile.level);
    if (stats.tiles_by_level.size() <= level) stats.tiles_by_level.resize(level + 1);
    ++stats.tiles_by_level[level];
  }
  stats.bytes_resident =
      static_cast<std::int64_t>(meshes_.bytes() + textures_.bytes() + shader_.bytes_resident());
  result.certificate = certify(request, lens);
  result.certificate.share_without_data = without_data;
  return result;
}

}  // namespace

std::int64_t most_triangles(std::size_t memory_bytes) {
  return static_cast<std::int64_t>(memory_bytes / kBytesPerTriangle);
}

std::unique_ptr<core::Renderer> make_polygon_renderer(std::shared_ptr<Context> context,
                                                      std::shared_ptr<const paging::PlanetFile> planet,
                                                      const RendererOptions& options) {
  return std::make_unique<PolygonRenderer>(std::move(context), std::move(planet), options);
}

}  // namespace vpe::gl
