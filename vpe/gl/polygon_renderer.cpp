#include "vpe/gl/polygon_renderer.h"
#include "paging/planet/planet_look.h"
#include "paging/planet/planet_user.h"
#include "paging/surface/surface.h"
#include "paging/surface/tile_errors.h"
#include "vpe/core/appearance/sky.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <future>
#include <glm/geometric.hpp>
#include <optional>
#include <stdexcept>

#include "vpe/base/mutation.h"
#include "vpe/base/parallel.h"
#include "vpe/core/appearance/inspect.h"
#include "vpe/core/appearance/shading.h"
#include "vpe/core/below_ground.h"
#include "vpe/core/image/edge_filter.h"
#include "vpe/gl/certify.h"
#include "vpe/gl/shaders.h"
#include "vpe/gl/target.h"
#include "vpe/gl/tile_drawer.h"
#include "vpe/gl/tile_scene.h"

namespace vpe::gl {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// What OpenGL without a GPU keeps of a triangle, with its share of the images on their way out.
constexpr std::size_t kBytesPerTriangle = 600;

const glm::vec3 kLineColour(0.95F, 0.75F, 0.55F);
const glm::vec3 kBorderColour(0.1F, 1.0F, 0.2F);  // no ground is that green
// The shading stays visible below the tint.
glm::vec4 level_tint(int level) {
  constexpr float kShare = 0.6F;
  const base::Rgb c = core::level_colour(level).colour;
  return {static_cast<float>(c.r) / 255.0F, static_cast<float>(c.g) / 255.0F, static_cast<float>(c.b) / 255.0F,
          kShare};
}

// For the few tiles below the camera.
constexpr std::size_t kSurfaceBytes = std::size_t{4} << 20;

// Of the memory, for errors of blocks.
std::size_t errors_bytes(std::size_t memory_bytes) {
  return std::min(paging::TileErrors::kUsualBytes, memory_bytes / 64);
}

class PolygonRenderer : public core::Renderer, public paging::PlanetUser {
 public:
  PolygonRenderer(std::shared_ptr<Context> context, std::shared_ptr<const paging::PlanetFile> planet,
                  const RendererOptions& options)
      : context_(std::move(context)),
        planet_(std::move(planet)),
        surface_(planet_, kSurfaceBytes),
        errors_(std::make_shared<paging::TileErrors>(planet_, errors_bytes(options.memory_bytes))),
        pool_(options.threads),
        scene_(planet_, options),
        tiles_(planet_->radius_m()),
        handover_(options.handover),
        empty_array_(VertexArray::make()) {
    const bool halved = base::mutated(base::Guard::kReversedDepth);
    glClipControl(GL_LOWER_LEFT, halved ? GL_NEGATIVE_ONE_TO_ONE : GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_DITHER);  // colours may be IDs
    glDisable(GL_CULL_FACE);
    check_gl("set up");
  }

  core::DrawResult draw(const core::DrawRequest& request) override;
  void change_planet(std::shared_ptr<const paging::PlanetFile> planet) override;

 private:
  void go_over_to(std::shared_ptr<const paging::PlanetFile> planet);
  void draw_sky(const core::DrawRequest& request, const ClipProjection& clip);
  void set_material(const core::DrawRequest& request);
  void draw_pass(const core::DrawRequest& request, const ClipProjection& clip, Target& to, bool image);
  std::optional<double> draw_image(const core::DrawRequest& request, const ClipProjection& clip,
                                   core::DrawResult& result);
  void read_range(const core::DrawRequest& request, ClipProjection clip, core::Frame& frame);
  static float range_of(const core::View& view, const ClipProjection& clip, glm::ivec2 pixel, float depth);
  static void ranges_of(const core::View& view, const ClipProjection& clip, std::span<float> depths);
  bool may_hand_over(const core::DrawRequest& request) const;
  void hand_over(const Target& image, const core::DrawRequest& request, const ClipProjection& clip);
  Target& target(std::optional<Target>& slot, const glm::ivec2& size, int samples);
  std::optional<double> nodata_share(core::Mode mode, const Target& image) const;
  core::Certificate certify(const core::DrawRequest& request, const ClipProjection& clip,
                            const core::Frame& frame);
  double bound_in_image(const core::DrawRequest& request, const FrameOptics& optics, const core::Frame& frame);
  std::function<void()> measurement(const core::DrawRequest& request, const FrameOptics& optics,
                                    const core::Frame& frame) const;
  void state(const core::DrawRequest& request, core::Certificate& c) const;
  bool is_below_ground(const core::DrawRequest& request) const;

  std::shared_ptr<Context> context_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  paging::Surface surface_;                     // below the camera
  std::shared_ptr<paging::TileErrors> errors_;  // of this planet
  std::future<void> measuring_;                 // errors that a frame lacked
  bool settled_ = true;                         // the frame's tiles are
  bool lacks_errors_ = false;                   // the frame's bound is not as close as it will be
  base::ThreadPool pool_;
  TileScene scene_;
  TileDrawer tiles_;
  std::shared_ptr<const core::ColourScale> palette_;  // the one that tiles_ has; null: none
  Program sky_program_;                               // made for the first sky
  std::shared_ptr<TextureHandover> handover_;         // null: images are pixels
  std::optional<TextureFinish> finish_;               // made for the first image that is handed over
  Fence handed_over_;                                 // behind the image that was handed over last
  VertexArray empty_array_;
  std::optional<Target> colour_target_;
  std::optional<Target> range_target_;
  std::vector<TileDraw> draws_;
  std::vector<CertifiedTile> certified_;
  std::vector<float> depth_;
  bool has_rough_range_ = false;  // depth_ holds ranges of the image
  std::vector<base::Rgb> colours_;
  std::vector<std::uint32_t> tile_ids_;  // packed, of the range image's pixels (tile_id.h)
};

void PolygonRenderer::draw_sky(const core::DrawRequest& request, const ClipProjection& clip) {
  const glm::dvec3& camera = request.view.camera.position_m;
  const double r = glm::length(camera);
  const glm::mat3 to_body = glm::transpose(body_to_camera(request.view.camera.axes));
  const glm::vec3 up(camera / r);
  const glm::vec3 sun(request.sun);
  if (!sky_program_) {
    const ShaderSources shaders = sky_shaders();
    sky_program_ = make_program("sky", shaders.vertex.c_str(), shaders.fragment.c_str());
  }
  glUseProgram(sky_program_.name());
  glBindVertexArray(empty_array_.name());
  glUniformMatrix3fv(sky_uniform("to_body"), 1, GL_FALSE, &to_body[0][0]);
  glUniform4fv(sky_uniform("projection"), 1, &clip.scale_shift[0]);
  glUniform3fv(sky_uniform("up"), 1, &up[0]);
  glUniform2f(sky_uniform("altitude"), static_cast<float>(r - planet_->radius_m()),
              static_cast<float>(planet_->radius_m()));
  glUniform3fv(sky_uniform("sun"), 1, &sun[0]);
  const core::SkyAir& air = core::air_of(request.settings.atmosphere);
  glUniform4f(sky_uniform("air"), static_cast<float>(core::colour_depth(air, r - planet_->radius_m())),
              static_cast<float>(0.3 * air.zenith_depth), static_cast<float>(air.scale_height_m),
              static_cast<float>(air.lowest_m));
  const std::array colours{glm::vec3(air.zenith), glm::vec3(air.dust), glm::vec3(air.glow), glm::vec3(air.sun)};
  glUniform3fv(sky_uniform("zenith"), 1, &colours[0][0]);
  glUniform3fv(sky_uniform("dust"), 1, &colours[1][0]);
  glUniform3fv(sky_uniform("glow"), 1, &colours[2][0]);
  glUniform3fv(sky_uniform("disc"), 1, &colours[3][0]);
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

// `image` is the image that was drawn and read last.
std::optional<double> PolygonRenderer::nodata_share(core::Mode mode, const Target& image) const {
  if (mode == core::Mode::kWireframe || mode == core::Mode::kMarkers) {
    const auto has_nodata = [&](const SceneTile& t) { return planet_->has_nodata(t.tile->key); };
    const auto tiles = scene_.tiles();
    if (std::any_of(tiles.begin(), tiles.end(), has_nodata)) return std::nullopt;
    return 0.0;
  }
  const auto has_nodata_pixels = [](const TileDraw& t) { return t.texture != nullptr && t.texture->nodata; };
  return std::any_of(draws_.begin(), draws_.end(), has_nodata_pixels) ? 1.0 - image.mean_alpha() : 0.0;
}

core::Certificate PolygonRenderer::certify(const core::DrawRequest& request, const ClipProjection& clip,
                                           const core::Frame& frame) {
  certified_.clear();
  for (const SceneTile& t : scene_.tiles()) {
    certified_.push_back({t.tile, t.mesh->quantisation_m, t.mesh->longest_edge_m,
                          glm::length(t.mesh->centre_m - request.view.camera.position_m),
                          *std::max_element(t.skirt_m.begin(), t.skirt_m.end())});
  }
  const glm::ivec2 size = core::drawn_size(request.view);
  const FrameOptics optics{core::focal_px(request.view), clip.near_m, tiles_.snap_px(),
                           request.settings.exaggeration, tiles_.surface_snap_px(std::max(size.x, size.y))};
  core::Certificate c = gl::certify(certified_, planet_->tree(), planet_->meta().tile.intervals(), optics);
  if (request.want_range) {
    c.image_bound_px = std::min(bound_in_image(request, optics, frame), c.shift_bound_px);
  }
  state(request, c);
  return c;
}

// Frames that do not wait must not read tiles. What a settled one lacks is measured beside the frames that follow, of
// which the image is not settled either.
double PolygonRenderer::bound_in_image(const core::DrawRequest& request, const FrameOptics& optics,
                                       const core::Frame& frame) {
  const auto bound_px = [&](const BlockErrorsOf& errors) {
    return gl::bound_in_image(certified_, planet_->tree(), {tile_ids_, frame.range_m, kRangeError}, optics,
                              request.view, errors);
  };
  const double x = optics.exaggeration;
  if (request.paging.wait)
    return bound_px([&](const lod::SelectedTile& tile) { return errors_->find(tile, x); });
  const double known_px = bound_px([&](const lod::SelectedTile& tile) {
    const std::optional<paging::TileErrors::Pointer> found = errors_->find_measured(tile, x);
    lacks_errors_ |= !found;
    return found.value_or(nullptr);
  });
  const bool measures =
      measuring_.valid() && measuring_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
  if (lacks_errors_ && settled_ && !measures)
    measuring_ = std::async(std::launch::async, measurement(request, optics, frame));
  return known_px;
}

// Asks for all errors that the bound of an image needs. Holds copies of all that it uses.
std::function<void()> PolygonRenderer::measurement(const core::DrawRequest& request, const FrameOptics& optics,
                                                   const core::Frame& frame) const {
  std::vector<lod::SelectedTile> tiles;
  for (const CertifiedTile& t : certified_) tiles.push_back(*t.tile);
  return [tiles = std::move(tiles), certified = certified_, planet = planet_, ids = tile_ids_,
          ranges = frame.range_m, view = request.view, optics, errors = errors_]() mutable {
    for (std::size_t k = 0; k < tiles.size(); ++k) certified[k].tile = &tiles[k];
    gl::bound_in_image(certified, planet->tree(), {ids, ranges, kRangeError}, optics, view,
                       [&](const lod::SelectedTile& tile) { return errors->find(tile, optics.exaggeration); });
  };
}

// States what does not depend on the tiles.
void PolygonRenderer::state(const core::DrawRequest& request, core::Certificate& c) const {
  const paging::PlanetMeta& meta = planet_->meta();
  core::state_data(c,
                   {.tolerance_px = request.settings.lod_tolerance_px,
                    .resampling_max_m = meta.resampling.max_m,
                    .resampling_rms_m = meta.resampling.rms_m,
                    .illustration = meta.illustration},
                   meta.sources);
  c.exaggeration = request.settings.exaggeration;
  c.corner_stretch = core::corner_stretch(request.view);
}

// Frames that do not wait must not read tiles; their cameras are kept above the ground by whoever moves them.
// Where the ground cannot be read, what is drawn in its place is shown.
bool PolygonRenderer::is_below_ground(const core::DrawRequest& request) const {
  if (!request.paging.wait) return false;
  try {
    return surface_.is_below(request.view.camera.position_m, request.settings.exaggeration);
  } catch (const paging::PlanetError&) {
    return false;
  }
}

// Gives the programs of this image's tiles what they need, and nothing else.
void PolygonRenderer::set_material(const core::DrawRequest& request) {
  const core::Appearance& appearance = request.settings;
  const bool shows_palette = scene_.material().method == PaintMethod::kPalette;
  const std::shared_ptr<const core::ColourScale> wanted = shows_palette ? scene_.scale() : nullptr;
  if (wanted != palette_) {
    if (wanted) {
      PaletteTable table{wanted->low(), wanted->high(), {}};
      constexpr int kEntries = 4096;
      for (int n = 0; n < kEntries; ++n) {
        const glm::dvec3 c = (*wanted)(table.low + (table.high - table.low) * n / (kEntries - 1));
        const glm::ivec3 bytes(glm::clamp(glm::round(c), 0.0, 255.0));
        table.colours.push_back({static_cast<std::uint8_t>(bytes.r), static_cast<std::uint8_t>(bytes.g),
                                 static_cast<std::uint8_t>(bytes.b)});
      }
      tiles_.set_palette(&table);
    } else {
      tiles_.set_palette(nullptr);
    }
    palette_ = wanted;
  }
  tiles_.set_exaggeration(appearance.exaggeration);
  tiles_.set_air({glm::vec3(request.sun), static_cast<float>(appearance.haze_visibility_m),
                  glm::vec3(core::air_of(appearance.atmosphere).haze / 255.0)});
  std::optional<SunLight> light;
  if (const std::optional<VertexLight>& of_vertices = scene_.material().light) {
    light = SunLight{glm::vec3(of_vertices->sun), static_cast<float>(of_vertices->ambient),
                     static_cast<float>(of_vertices->diffuse)};
  }
  tiles_.set_light(light);
  if (appearance.background != core::Background::kSky) sky_program_ = {};
}

void PolygonRenderer::draw_pass(const core::DrawRequest& request, const ClipProjection& clip, Target& to,
                                bool image) {
  const bool wireframe = request.settings.mode == core::Mode::kWireframe;
  const bool markers = request.settings.mode == core::Mode::kMarkers;
  const bool white = image && request.settings.background == core::Background::kWhite;
  const float paper = white ? 1.0F : 0.0F;
  to.bind();
  glClearColor(paper, paper, paper, 1.0F);
  glClearDepth(0.0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDepthFunc(GL_GREATER);
  draws_.clear();
  // What shows at a distance is at least this part of it before the camera, and a triangle's corners are within
  // its longest edge of that.
  const double corner_secant = std::sqrt(core::corner_stretch(request.view));
  const PaintMethod method = scene_.material().method;
  const glm::vec3 plain = wireframe || markers ? kLineColour : glm::vec3(request.settings.plain_ground / 255.0);
  for (const SceneTile& t : scene_.tiles()) {
    TileDraw& draw = draws_.emplace_back();
    draw.mesh = t.mesh;
    draw.key = t.tile->key;
    draw.skirt_m = t.skirt_m;
    draw.surface = t.surface;
    const double reach_m = clip.near_m + 2.0 * t.mesh->longest_edge_m;
    draw.by_triangle = request.want_range || t.tile->min_distance_m < reach_m * corner_secant;
    if (!image) continue;
    draw.texture = t.texture;
    draw.flat = method == PaintMethod::kColour;
    draw.palette = method == PaintMethod::kPalette;
    draw.colour = plain;
    if (image && request.settings.inspect == core::Inspect::kLevels)
      draws_.back().tint = level_tint(t.tile->key.level);
  }
  if (image && (wireframe || markers)) {
    // Nearer ground hides dots and lines, and no sky shows through. The ground that they lie on must not hide
    // them: it is pushed back by the change of its depth from an edge or a vertex to the last pixel that shows
    // it.
    const float reach_px = markers ? 0.5F * static_cast<float>(request.settings.marker_px) + 0.5F : 1.0F;
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-2.0F * reach_px, 0.0F);  // times the larger of the slopes to the right and up
    tiles_.draw_tile_ids(request.view, clip, draws_);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    if (markers) {
      tiles_.draw_vertices(request.view, clip, draws_, static_cast<float>(request.settings.marker_px));
    } else {
      tiles_.draw_edges(request.view, clip, draws_);
    }
  } else if (image) {
    tiles_.draw(request.view, clip, draws_);
  } else {
    tiles_.draw_tile_ids(request.view, clip, draws_);
  }
  if (image && request.settings.background == core::Background::kSky) draw_sky(request, clip);
  if (image && request.settings.inspect == core::Inspect::kBorders) {
    glDepthFunc(GL_GREATER);
    tiles_.draw_borders(request.view, clip, draws_, kBorderColour);
  }
}

// Depth is interpolated with an absolute error of some 2^-24 near the near plane, so a first pass finds the
// nearest surface and a second one puts the near plane just before it.
void PolygonRenderer::read_range(const core::DrawRequest& request, ClipProjection clip, core::Frame& frame) {
  const glm::ivec2 size = core::drawn_size(request.view);
  Target& to = target(range_target_, size, 1);
  for (int pass = 0; pass < 2; ++pass) {
    draw_pass(request, clip, to, false);
    to.read_depth(frame.range_m);
    const float nearest = *std::max_element(frame.range_m.begin(), frame.range_m.end());
    if (pass == 0 && nearest > 0.0F) clip.near_m = std::max(clip.near_m, 0.5F * clip.near_m / nearest);
  }
  to.read_colour(colours_);
  tile_ids_.resize(colours_.size());
  std::transform(colours_.begin(), colours_.end(), tile_ids_.begin(),
                 [](const base::Rgb& c) { return id_of_colour(c.r, c.g, c.b); });
  ranges_of(request.view, clip, frame.range_m);
}

// Returns the range of a pixel of the drawn part by its value of the depth buffer.
float PolygonRenderer::range_of(const core::View& view, const ClipProjection& clip, glm::ivec2 pixel,
                                float depth) {
  if (depth <= 0.0F) return core::kSkyRange;
  const glm::dvec2 centre = 0.5 * glm::dvec2(view.width, view.height) + view.principal_offset_px -
                            glm::dvec2(view.part.x, view.part.y);
  const glm::dvec2 p = (glm::dvec2(pixel) + 0.5 - centre) / core::focal_px(view);
  return static_cast<float>(clip.near_m / static_cast<double>(depth) * std::sqrt(1.0 + p.x * p.x + p.y * p.y));
}

// Replaces values of the depth buffer by ranges.
void PolygonRenderer::ranges_of(const core::View& view, const ClipProjection& clip, std::span<float> depths) {
  const glm::ivec2 size = core::drawn_size(view);
  const double f = core::focal_px(view);
  const double cx = 0.5 * view.width + view.principal_offset_px.x - view.part.x;
  const double cy = 0.5 * view.height + view.principal_offset_px.y - view.part.y;
  for (int y = 0; y < size.y; ++y) {
    float* row = &depths[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x)];
    const double b = (y + 0.5 - cy) / f;
    for (int x = 0; x < size.x; ++x) {
      const double a = (x + 0.5 - cx) / f;
      row[x] = row[x] > 0.0F ? static_cast<float>(clip.near_m / row[x] * std::sqrt(1.0 + a * a + b * b))
                             : core::kSkyRange;
    }
  }
}

// Draws the image's colours. Returns the share of nodata in it.
std::optional<double> PolygonRenderer::draw_image(const core::DrawRequest& request, const ClipProjection& clip,
                                                  core::DrawResult& result) {
  const core::SettingsValues& settings = request.settings;
  const glm::ivec2 size = core::drawn_size(request.view);
  auto start = Clock::now();
  Target& image = target(colour_target_, size, settings.samples);
  draw_pass(request, clip, image, true);
  glFinish();
  check_gl("draw");
  result.stats.draw_ms = ms_since(start);
  scene_.record_draw_time(result.stats.draw_ms);

  start = Clock::now();
  if (may_hand_over(request)) {
    hand_over(image, request, clip);
    result.stats.read_ms = ms_since(start);
    return 0.0;
  }
  image.read_colour(result.frame.colour);
  const std::optional<double> nodata = nodata_share(settings.mode, image);
  const bool lines = settings.mode == core::Mode::kWireframe || settings.mode == core::Mode::kMarkers;
  const bool smooth = settings.samples == 1 && settings.smooth_edges && !lines;
  const bool ranges = settings.samples == 1 && request.want_rough_range && !request.want_range && !lines;
  if (smooth || ranges) image.read_depth(depth_);
  result.stats.read_ms = ms_since(start);
  start = Clock::now();
  if (smooth) core::smooth_edges(result.frame.colour, depth_, size.x, size.y, pool_);
  core::apply_gamma(result.frame.colour, settings.gamma);
  if (ranges) ranges_of(request.view, clip, depth_);
  has_rough_range_ = ranges;
  result.stats.draw_ms += ms_since(start);
  return nodata;
}

// Returns true if nothing of the image's pixels is needed here. Lines are rare, and the share of nodata is counted on the CPU.
bool PolygonRenderer::may_hand_over(const core::DrawRequest& request) const {
  const core::Mode mode = request.settings.mode;
  return handover_ && handover_->texture != 0 && !request.want_range && mode != core::Mode::kWireframe &&
         mode != core::Mode::kMarkers && std::ranges::none_of(draws_, [](const TileDraw& t) {
           return t.texture != nullptr && t.texture->nodata;
         });
}

// Leaves the image that was drawn in the window's texture.
void PolygonRenderer::hand_over(const Target& image, const core::DrawRequest& request,
                                const ClipProjection& clip) {
  const core::SettingsValues& settings = request.settings;
  const bool one_sample = settings.samples == 1;
  const glm::ivec2 cells = one_sample && request.want_rough_range ? handover_->cells : glm::ivec2(0);
  if (handover_->unused != nullptr) glWaitSync(static_cast<GLsync>(handover_->unused), 0, GL_TIMEOUT_IGNORED);
  if (!finish_) finish_.emplace();
  std::vector<float> depths =
      finish_->draw(image, handover_->texture, {one_sample && settings.smooth_edges, settings.gamma, cells});
  const glm::ivec2 size(image.width(), image.height());
  for (std::size_t n = 0; n < depths.size(); ++n) {
    const glm::ivec2 corner(static_cast<int>(n) % (cells.x + 1), static_cast<int>(n) / (cells.x + 1));
    const glm::ivec2 pixel = glm::min(size * corner / cells, size - 1);
    depths[n] = range_of(request.view, clip, pixel, depths[n]);
  }
  handover_->range_m = std::move(depths);
  handover_->bytes = finish_->bytes();
  handed_over_ = Fence::make();
  handover_->drawn = handed_over_.sync();
  handover_->is_drawn = true;
  check_gl("hand over the image");
}

void PolygonRenderer::change_planet(std::shared_ptr<const paging::PlanetFile> planet) {
  go_over_to(paging::keep_layers(std::move(planet), planet_));
}

void PolygonRenderer::go_over_to(std::shared_ptr<const paging::PlanetFile> planet) {
  if (planet == planet_) return;
  paging::require_same_grid(*planet_, *planet);
  draws_.clear();
  scene_.change_planet(planet);
  surface_.change_planet(planet);
  errors_ = std::make_shared<paging::TileErrors>(planet, *errors_);
  planet_ = std::move(planet);
}

core::DrawResult PolygonRenderer::draw(const core::DrawRequest& asked) {
  core::DrawRequest request = asked;
  go_over_to(paging::with_layers_of(planet_, request.settings.image_layers));
  paging::fit_to_planet(request.settings, planet_->meta());
  if (const std::string trouble = core::check(request.view); !trouble.empty())
    throw std::runtime_error(trouble);
  if (request.view.projection != core::Projection::kPerspective) {
    throw std::runtime_error("the polygon backend draws perspective views only");
  }
  core::DrawResult result;
  planet_->tree().require_drawable(request.settings.exaggeration);
  if (is_below_ground(request)) {
    state(request, result.certificate);
    core::draw_below_ground(request, result);
    return result;
  }
  scene_.prepare(request);
  scene_.report(result);

  const glm::ivec2 size = core::drawn_size(request.view);
  const ClipProjection clip = clip_projection(request.view, scene_.near_plane_m(request.view));
  result.frame.width = size.x;
  result.frame.height = size.y;
  set_material(request);
  std::optional<double> nodata;
  has_rough_range_ = false;
  if (request.want_colour) nodata = draw_image(request, clip, result);
  const auto start = Clock::now();
  if (request.want_range) read_range(request, clip, result.frame);
  result.stats.read_ms += ms_since(start);

  // The programs of images are kept while ranges are drawn between them.
  if (request.want_colour) tiles_.drop_unused();
  settled_ = result.settled;
  lacks_errors_ = false;
  result.certificate = certify(request, clip, result.frame);
  result.stats.bytes_resident += static_cast<std::int64_t>(surface_.bytes_resident() + errors_->bytes());
  if (lacks_errors_) result.settled = false;
  if (has_rough_range_) result.frame.range_m.swap(depth_);
  result.certificate.nodata_share = nodata;
  result.certificate.tiles_missing = result.stats.tiles_missing;
  result.certificate.tiles_substituted = result.stats.tiles_substituted;
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
