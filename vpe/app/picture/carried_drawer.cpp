#include "vpe/app/picture/carried_drawer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "paging/planet/planet_user.h"
#include "paging/surface/distance.h"
#include "vpe/app/scene/object_renderer.h"
#include "vpe/core/appearance/shading.h"
#include "vpe/core/image/edge_filter.h"
#include "vpe/core/margin.h"
#include "vpe/core/ray_lengths.h"
#include "vpe/voxel/ray_renderer.h"
#include "vpe/voxel/ray_request.h"

namespace vpe::app {

namespace {

// The surface as drawn may be nearer than the reference surface by its error, which is small beside the distance.
constexpr double kOfDistance = 0.95;

core::DrawRequest raw(core::DrawRequest request) {
  request.settings.smooth_edges = false;
  request.settings.gamma = 1;
  request.want_range = true;
  return request;
}

core::Certificate::Carried shares_of(const warp::CarriedImage& image) {
  const auto share = [&](warp::Origin origin) {
    return static_cast<double>(image.count(origin)) / static_cast<double>(image.origin.size());
  };
  core::Certificate::Carried carried;
  carried.added_px = image.added_px;
  carried.carried_share = share(warp::Origin::kCarried) + share(warp::Origin::kSky);
  carried.between_share = share(warp::Origin::kBetween);
  carried.drawn_share = share(warp::Origin::kOpen);
  return carried;
}

// Completes the certificate of the drawn pixels by that of the image that the others come from, and by what carrying adds.
void state(const warp::CarriedImage& image, const core::Certificate& first, core::Certificate& certificate) {
  const auto larger = [&](double core::Certificate::*bound) {
    certificate.*bound = std::max(certificate.*bound, first.*bound);
  };
  larger(&core::Certificate::geometric_error_m);
  larger(&core::Certificate::screen_space_error_px);
  larger(&core::Certificate::quantisation_m);
  larger(&core::Certificate::quantisation_px);
  larger(&core::Certificate::shift_bound_px);
  larger(&core::Certificate::thinning_px);
  larger(&core::Certificate::sample_distance_px);
  larger(&core::Certificate::smoothing_m);
  larger(&core::Certificate::smoothing_px);
  larger(&core::Certificate::corner_stretch);
  certificate.tiles_missing += first.tiles_missing;
  certificate.tiles_substituted += first.tiles_substituted;
  certificate.carried = shares_of(image);
  const double kept_share = 1 - certificate.carried->drawn_share;
  if (certificate.nodata_share) *certificate.nodata_share += kept_share * first.nodata_share.value_or(0);
  certificate.share_at_data_limit = certificate.carried->drawn_share * certificate.share_at_data_limit +
                                    kept_share * first.share_at_data_limit;
  certificate.shift_bound_px += image.added_px;
  certificate.image_bound_px.reset();
  certificate.middle_bound_px.reset();
}

}  // namespace

std::string why_not_carried(const core::DrawRequest& request) {
  if (request.view.projection != core::Projection::kPerspective)
    return "only perspective images are carried from others";
  if (!core::has_one_ray_a_pixel(request.settings))
    return "images with several samples a pixel (samples, rays.vertical) are not carried";
  return voxel::why_not(request);
}

CarriedDrawer::CarriedDrawer(core::Renderer& renderer, const std::shared_ptr<const paging::PlanetFile>& planet,
                             const CarriedDrawerOptions& options)
    : renderer_(renderer),
      rays_(dynamic_cast<core::PixelRenderer*>(&renderer)),
      surface_(planet, options.memory_bytes / 4),
      options_(options),
      pool_(options.threads) {
  if (rays_ != nullptr) return;
  own_rays_ = with_objects(voxel::make_ray_renderer(planet, {.memory_bytes = options.memory_bytes / 4 * 3,
                                                             .threads = options.threads}),
                           planet, {.threads = options.threads});
  rays_ = own_rays_.get();
}

void CarriedDrawer::change_planet(const std::shared_ptr<const paging::PlanetFile>& planet) {
  has_first_ = false;
  if (own_rays_) paging::change_planet(*own_rays_, planet);
  surface_.change_planet(planet);
}

void CarriedDrawer::finish(const core::DrawRequest& request, core::Frame& frame) {
  if (request.settings.smooth_edges && !frame.colour.empty()) {
    inverse_depth_.resize(frame.range_m.size());
    core::inverse_depths(request.view, frame.range_m, pool_, inverse_depth_);
    core::smooth_edges(frame.colour, inverse_depth_, frame.width, frame.height, pool_);
  }
  core::apply_gamma(frame.colour, request.settings.gamma);
  if (!request.want_range && !request.want_rough_range) frame.range_m = {};
}

core::DrawResult CarriedDrawer::draw_first(const core::DrawRequest& request, glm::ivec2 margin_px) {
  has_first_ = false;
  core::DrawRequest wide = raw(request);
  wide.view = core::with_margin(request.view, margin_px);
  core::DrawResult result = renderer_.draw(wide);
  result.certificate.corner_stretch = core::corner_stretch(request.view);
  view_ = wide.view;
  certificate_ = result.certificate;
  clear_of_objects_m_ = result.clear_of_objects_m;
  shows_see_through_ = result.shows_see_through;
  if (margin_px == glm::ivec2(0)) {
    raw_ = result.frame;
  } else {
    raw_ = std::move(result.frame);
    result.frame = core::without_margin(raw_, margin_px);
  }
  has_first_ = true;
  finish(request, result.frame);
  return result;
}

void CarriedDrawer::choose_pixels(const core::DrawRequest& request) {
  const bool draws_sky =
      options_.repaints_sky && request.settings.background == core::Background::kSky && request.want_colour;
  const std::size_t count = carried_.origin.size();
  wanted_.resize(count);
  clear_m_.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    const bool is_open = carried_.origin[n] == warp::Origin::kOpen;
    const bool is_sky = draws_sky && carried_.origin[n] == warp::Origin::kSky;
    wanted_[n] = is_open || is_sky ? 1 : 0;
    const bool is_known = options_.uses_clear_air && std::isfinite(carried_.range_m[n]);
    clear_m_[n] = is_sky ? core::kSkyRange : is_known ? carried_.range_m[n] : 0;
  }
}

core::DrawResult CarriedDrawer::draw_carried(const core::DrawRequest& request) {
  if (!has_first_) throw std::logic_error("CarriedDrawer: there is no first image");
  drawing_s_ = 0;
  const double ground_m =
      paging::distance_to_ground_m(surface_, request.view.camera.position_m, request.settings.exaggeration);
  // A semi-transparent pixel has several ranges, and moves by none of them alone.
  if (certificate_.is_below_ground || ground_m == 0 || shows_see_through_) {
    carried_ = {};
    return renderer_.draw(request);
  }
  warp::CarryOptions options;
  options.gap_px = options_.gap_px;
  options.most_added_px = static_cast<float>(options_.most_added_px);
  options.filters = options_.filters;
  const double moved_m = glm::distance(view_.camera.position_m, request.view.camera.position_m);
  // Farther from the camera levels of objects are coarser, too, by less than the distance.
  options.nearest_m = std::min(kOfDistance * ground_m, std::max(clear_of_objects_m_ - 2 * moved_m, 0.0));
  carrier_.carry(view_, raw_, request.view, options, pool_, carried_);
  if (static_cast<double>(carried_.count(warp::Origin::kOpen)) >
      options_.most_drawn_share * static_cast<double>(carried_.origin.size())) {
    carried_ = {};
    return renderer_.draw(request);
  }
  choose_pixels(request);
  core::Frame frame{carried_.width, carried_.height, std::move(carried_.colour), carried_.range_m};
  const auto begun = std::chrono::steady_clock::now();
  core::DrawResult result = rays_->draw_pixels(raw(request), {wanted_, clear_m_}, frame);
  drawing_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  state(carried_, certificate_, result.certificate);
  finish(request, frame);
  result.frame = std::move(frame);
  return result;
}

std::vector<base::Rgb> with_drawn_pixels_red(const warp::CarriedImage& carried, const core::Frame& frame) {
  std::vector<base::Rgb> pixels = frame.colour;
  for (std::size_t n = 0; n < carried.origin.size(); ++n)
    if (carried.origin[n] == warp::Origin::kOpen) pixels[n] = {255, 0, 0};
  return pixels;
}

std::vector<base::Rgb> colour_differences(const core::Frame& a, const core::Frame& b) {
  constexpr double kWhite = 50;
  std::vector<base::Rgb> pixels(a.colour.size());
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    const glm::dvec3 apart(a.colour[n].r - b.colour[n].r, a.colour[n].g - b.colour[n].g,
                           a.colour[n].b - b.colour[n].b);
    const auto tone = static_cast<std::uint8_t>(255 * std::min(glm::length(apart) / kWhite, 1.0) + 0.5);
    pixels[n] = {tone, tone, tone};
  }
  return pixels;
}

}  // namespace vpe::app
