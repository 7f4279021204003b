#include "vpe/app/scene/object_renderer.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "objects/draw/composer.h"
#include "objects/draw/seen_posters.h"
#include "paging/planet/planet_look.h"
#include "paging/planet/planet_user.h"
#include "paging/shading/ground_light.h"
#include "vpe/app/scene/scene_library.h"
#include "vpe/base/parallel.h"
#include "vpe/core/appearance/shading.h"
#include "vpe/voxel/ray_request.h"

namespace vpe::app {

namespace {

// Returns whether a dome seems to hide all of the ground, and no object is before it: directions at even distances are tried.
bool may_leave_ground_out(const std::vector<objects::PlacedPoster>& posters, const objects::Scene& scene,
                          const core::DrawRequest& request) {
  constexpr int kSteps = 16;
  const objects::SeenPosters seen(posters, request.view, 1);
  if (seen.size() != 1 || !seen.replaces_ground(0) || !seen.is_opaque(0)) return false;
  const core::SubRectangle part = core::drawn_part(request.view);
  double far_m = 0;
  for (int j = 0; j <= kSteps; ++j) {
    for (int i = 0; i <= kSteps; ++i) {
      const double x = part.x + 0.5 + static_cast<double>(part.width - 1) * i / kSteps;
      const double y = part.y + 0.5 + static_cast<double>(part.height - 1) * j / kSteps;
      const auto hit =
          seen.meet(0, core::pixel_ray(request.view, x, y), std::numeric_limits<double>::infinity());
      if (!hit) return false;
      far_m = std::max(far_m, hit->range_m);
    }
  }
  bool has_objects = false;
  scene.visit(
      [&](const objects::SceneBall& ball) {
        return glm::distance(ball.centre_m, request.view.camera.position_m) - ball.radius_m < 2 * far_m;
      },
      [&](std::uint32_t) { has_objects = true; });
  return !has_objects;
}

// What draws objects; made for the first request that has any.
class ObjectPass {
 public:
  ObjectPass(std::shared_ptr<const paging::PlanetFile> planet, const ObjectRendererOptions& options)
      : planet_(std::move(planet)),
        surface_(planet_, options.memory_bytes / 2),
        shader_(planet_, options.memory_bytes / 2),
        pool_(options.threads),
        library_(surface_),
        note_(options.note) {}

  PlacedScene scene(const core::DrawRequest& request) {
    PlacedScene placed = library_.scene(request.settings.scene, request.settings.exaggeration, request.time_s,
                                        request.tracks.get());
    for (const std::string& text : library_.take_notes()) {
      if (note_) note_(text);
    }
    return placed;
  }

  // Tells once for each scene that what is cut out of the ground is not drawn.
  void note_cuts(const PlacedScene& placed, const core::DrawRequest& request) {
    if (!note_ || !placed.parts || told_of_ == placed.parts || voxel::is_volume_mode(request.settings.ray_mode))
      return;
    told_of_ = placed.parts;
    const bool has_cuts = std::ranges::any_of(*placed.parts, [](const PlacedPart& part) {
      return part.role.kind == objects::GroundRole::Kind::kCut;
    });
    if (has_cuts)
      note_(request.settings.scene +
            ": what is cut out of the ground is drawn by rays, with rays.mode=volume or boundary");
  }

  // Returns the image without its ground where a dome hides all of it, and nullopt elsewhere.
  std::optional<core::DrawResult> draw_dome(const PlacedScene& placed, const core::DrawRequest& request) {
    if (!placed.posters || !may_leave_ground_out(*placed.posters, *placed.scene, request)) return std::nullopt;
    core::DrawResult result;
    core::Frame& frame = result.frame;
    const glm::ivec2 size = core::drawn_size(request.view);
    frame.width = size.x;
    frame.height = size.y;
    const std::size_t pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    frame.colour.assign(pixels, {});
    if (request.want_rough_range) frame.range_m.assign(pixels, core::kSkyRange);
    const paging::PlanetMeta& meta = planet_->meta();
    core::state_data(result.certificate,
                     {.tolerance_px = request.settings.lod_tolerance_px,
                      .resampling_max_m = meta.resampling.max_m,
                      .resampling_rms_m = meta.resampling.rms_m,
                      .illustration = meta.illustration},
                     meta.sources);
    result.certificate.exaggeration = request.settings.exaggeration;
    result.certificate.corner_stretch = core::corner_stretch(request.view);
    const std::int64_t covered =
        draw(*placed.scene, placed.posters.get(), request, false, {}, frame, result).covered;
    // Between the directions that were tried the panorama may have an end.
    if (covered < static_cast<std::int64_t>(pixels)) return std::nullopt;
    return result;
  }

  objects::ComposedObjects draw(const objects::Scene& scene, const std::vector<objects::PlacedPoster>* posters,
                                const core::DrawRequest& request, bool is_exact,
                                std::span<const std::uint8_t> only, core::Frame& frame,
                                core::DrawResult& result) {
    core::Certificate& certificate = result.certificate;
    core::DrawRequest for_planet = request;
    paging::fit_to_planet(for_planet.settings, planet_->meta());
    const paging::GroundLight light(shader_, surface_,
                                    paging::shading_params(for_planet.settings, request.sun,
                                                           planet_->meta().finest_image_level >= 0, nullptr));
    const objects::ComposedObjects drawn = objects::compose(
        scene, {for_planet, planet_->radius_m(), &light}, objects::level_rule(for_planet, is_exact), pool_,
        frame, only, posters == nullptr ? std::span<const objects::PlacedPoster>() : *posters);
    result.clear_of_objects_m = drawn.clear_m;
    result.shows_see_through = drawn.is_see_through;
    certificate.objects = {drawn.objects, drawn.geometric_error_m, drawn.screen_space_error_px};
    certificate.shift_bound_px = std::max(certificate.shift_bound_px, drawn.screen_space_error_px);
    if (certificate.image_bound_px)
      certificate.image_bound_px = std::max(*certificate.image_bound_px, drawn.screen_space_error_px);
    if (certificate.middle_bound_px)
      certificate.middle_bound_px = std::max(*certificate.middle_bound_px, drawn.screen_space_error_px);
    return drawn;
  }

  std::size_t bytes() const { return surface_.bytes_resident() + shader_.bytes_resident() + library_.bytes(); }

 private:
  std::shared_ptr<const paging::PlanetFile> planet_;
  paging::Surface surface_;
  paging::TerrainShader shader_;
  base::ThreadPool pool_;
  SceneLibrary library_;
  std::function<void(const std::string&)> note_;
  std::shared_ptr<const PlacedParts> told_of_;
};

bool has_objects(const core::DrawRequest& request) { return !request.settings.scene.empty(); }

// Ranges that triangles know only roughly, or only when they are asked for, decide what hides an object.
bool needs_own_ranges(const core::SettingsValues& settings) {
  return settings.samples > 1 || settings.mode == core::Mode::kWireframe ||
         settings.mode == core::Mode::kMarkers;
}

// Returns the request of the ground below the objects: with ranges, without gamma.
core::DrawRequest ground_request(const core::DrawRequest& request, const PlacedScene& placed) {
  core::DrawRequest ground = request;
  ground.settings.scene.clear();
  ground.settings.gamma = 1;
  ground.want_rough_range = true;
  ground.want_range = request.want_range || !request.want_colour || needs_own_ranges(request.settings);
  ground.interest.insert(ground.interest.end(), placed.interest.begin(), placed.interest.end());
  ground.ground_parts = placed.ground_parts;
  return ground;
}

// Returns the request with objects as coarse as the ground, where a limit of triangles made that coarser than the
// tolerance.
core::DrawRequest within_triangle_limit(core::DrawRequest request, const core::Certificate& ground) {
  const double tolerance_px = request.settings.lod_tolerance_px;
  if (request.settings.lod_triangles > 0 && tolerance_px > 0)
    request.coarsening = std::max(request.coarsening, ground.screen_space_error_px / tolerance_px);
  return request;
}

template <class Base>
class ObjectRenderer : public Base, public paging::PlanetUser {
 public:
  ObjectRenderer(std::unique_ptr<Base> ground, std::shared_ptr<const paging::PlanetFile> planet,
                 const ObjectRendererOptions& options)
      : ground_(std::move(ground)), planet_(std::move(planet)), options_(options) {}

  core::DrawResult draw(const core::DrawRequest& request) override {
    if (!has_objects(request)) return ground_->draw(request);
    show_layers(request);
    const PlacedScene placed = pass().scene(request);
    pass().note_cuts(placed, request);
    if (!request.want_range && request.want_colour) {
      if (std::optional<core::DrawResult> dome = pass().draw_dome(placed, request)) {
        core::apply_gamma(dome->frame.colour, request.settings.gamma);
        dome->stats.bytes_resident += static_cast<std::int64_t>(pass().bytes());
        return std::move(*dome);
      }
    }
    core::DrawRequest below = ground_request(request, placed);
    if (request.paging.next && has_objects(*request.paging.next))
      below.paging.next =
          std::make_shared<const core::DrawRequest>(ground_request(*request.paging.next, placed));
    core::DrawResult result = ground_->draw(below);
    if (!result.certificate.is_below_ground && !result.frame.range_m.empty()) {
      pass().draw(drawn_objects(placed, request), placed.posters.get(),
                  within_triangle_limit(request, result.certificate), is_exact(request), {}, result.frame,
                  result);
    }
    core::apply_gamma(result.frame.colour, request.settings.gamma);
    if (!request.want_range && !request.want_rough_range) result.frame.range_m = {};
    result.stats.bytes_resident += static_cast<std::int64_t>(pass().bytes());
    return result;
  }

  // Objects stand on the ground, so they are placed anew.
  void change_planet(std::shared_ptr<const paging::PlanetFile> planet) override {
    paging::change_planet(*ground_, planet);
    pass_.reset();
    planet_ = std::move(planet);
  }

 protected:
  // What is added to the ground is an object where the ground is drawn without it.
  static const objects::Scene& drawn_objects(const PlacedScene& placed, const core::DrawRequest& request) {
    const bool draws_parts = std::is_same_v<Base, core::PixelRenderer> && voxel::draws_ground_parts(request);
    return draws_parts ? *placed.apart : *placed.scene;
  }

  // Rays meet the surface itself; triangles and cells keep to a tolerance.
  static bool is_exact(const core::DrawRequest& request) {
    return std::is_same_v<Base, core::PixelRenderer> && request.settings.ray_mode == core::RayMode::kExact &&
           request.coarsening <= 1;
  }

  // Objects are lit by the imagery that the request shows.
  void show_layers(const core::DrawRequest& request) {
    auto planet = paging::with_layers_of(planet_, request.settings.image_layers);
    if (planet == planet_) return;
    pass_.reset();
    planet_ = std::move(planet);
  }

  ObjectPass& pass() {
    if (!pass_) pass_.emplace(planet_, options_);
    return *pass_;
  }

  std::unique_ptr<Base> ground_;

 private:
  std::shared_ptr<const paging::PlanetFile> planet_;
  ObjectRendererOptions options_;
  std::optional<ObjectPass> pass_;
};

class ObjectPixelRenderer : public ObjectRenderer<core::PixelRenderer> {
 public:
  using ObjectRenderer::ObjectRenderer;

  core::DrawResult draw_pixels(const core::DrawRequest& request, const core::WantedPixels& wanted,
                               core::Frame& frame) override {
    if (!has_objects(request)) return ground_->draw_pixels(request, wanted, frame);
    show_layers(request);
    const PlacedScene placed = pass().scene(request);
    core::DrawResult result = ground_->draw_pixels(ground_request(request, placed), wanted, frame);
    if (!result.certificate.is_below_ground)
      pass().draw(drawn_objects(placed, request), placed.posters.get(), request, is_exact(request),
                  wanted.is_wanted, frame, result);
    return result;
  }
};

}  // namespace

std::unique_ptr<core::Renderer> with_objects(std::unique_ptr<core::Renderer> ground,
                                             std::shared_ptr<const paging::PlanetFile> planet,
                                             const ObjectRendererOptions& options) {
  return std::make_unique<ObjectRenderer<core::Renderer>>(std::move(ground), std::move(planet), options);
}

std::unique_ptr<core::PixelRenderer> with_objects(std::unique_ptr<core::PixelRenderer> ground,
                                                  std::shared_ptr<const paging::PlanetFile> planet,
                                                  const ObjectRendererOptions& options) {
  return std::make_unique<ObjectPixelRenderer>(std::move(ground), std::move(planet), options);
}

}  // namespace vpe::app
