#include "vpe/app/picture/pair_drawer.h"

#include <algorithm>
#include <stdexcept>

#include "paging/surface/distance.h"
#include "vpe/core/appearance/shading.h"
#include "vpe/core/image/edge_filter.h"
#include "vpe/core/ray_lengths.h"
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

// Takes the larger bound of both.
void add(const core::Certificate& other, core::Certificate& certificate) {
  const auto larger = [&](double core::Certificate::*bound) {
    certificate.*bound = std::max(certificate.*bound, other.*bound);
  };
  larger(&core::Certificate::geometric_error_m);
  larger(&core::Certificate::screen_space_error_px);
  larger(&core::Certificate::quantisation_m);
  larger(&core::Certificate::quantisation_px);
  larger(&core::Certificate::shift_bound_px);
  larger(&core::Certificate::corner_stretch);
  certificate.tiles_missing += other.tiles_missing;
  certificate.tiles_substituted += other.tiles_substituted;
}

}  // namespace

std::string why_not_carried(const core::DrawRequest& request) {
  if (request.view.projection != core::Projection::kPerspective)
    return "only perspective images are carried to the second eye";
  if (request.settings.samples > 1) return "images with several samples a pixel (samples) are not carried";
  return voxel::why_not(request);
}

PairDrawer::PairDrawer(core::Renderer& renderer, core::PixelRenderer& rays, const paging::Surface& surface,
                       const PairOptions& options)
    : renderer_(renderer), rays_(rays), surface_(surface), options_(options), pool_(options.threads) {}

void PairDrawer::finish(const core::DrawRequest& request, core::Frame& frame) {
  if (request.settings.smooth_edges && !frame.colour.empty()) {
    inverse_depth_.resize(frame.range_m.size());
    core::inverse_depths(request.view, frame.range_m, pool_, inverse_depth_);
    core::smooth_edges(frame.colour, inverse_depth_, frame.width, frame.height, pool_);
  }
  core::apply_gamma(frame.colour, request.settings.gamma);
  if (!request.want_range) frame.range_m = {};
}

core::DrawResult PairDrawer::first(const core::DrawRequest& request) {
  core::DrawResult result = renderer_.draw(raw(request));
  view_ = request.view;
  raw_ = result.frame;
  certificate_ = result.certificate;
  has_first_ = true;
  finish(request, result.frame);
  return result;
}

core::DrawResult PairDrawer::second(const core::DrawRequest& request) {
  if (!has_first_) throw std::logic_error("PairDrawer: there is no first eye");
  warp::CarryOptions options;
  options.gap_px = options_.gap_px;
  options.filters = options_.filters;
  options.nearest_m = kOfDistance * paging::distance_to_ground_m(surface_, request.view.camera.position_m,
                                                                 request.settings.exaggeration);
  carrier_.carry(view_, raw_, request.view, options, pool_, carried_);
  wanted_.resize(carried_.origin.size());
  std::ranges::transform(carried_.origin, wanted_.begin(), [](warp::Origin origin) {
    return static_cast<std::uint8_t>(origin == warp::Origin::kOpen ? 1 : 0);
  });
  core::Frame frame{carried_.width, carried_.height, carried_.colour, carried_.range_m};
  core::DrawResult result = rays_.draw_pixels(raw(request), {wanted_, carried_.range_m}, frame);
  add(certificate_, result.certificate);
  result.certificate.carried = shares_of(carried_);
  result.certificate.shift_bound_px += carried_.added_px;
  result.certificate.image_bound_px.reset();
  finish(request, frame);
  result.frame = std::move(frame);
  return result;
}

}  // namespace vpe::app
