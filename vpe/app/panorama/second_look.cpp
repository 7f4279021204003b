#include "vpe/app/panorama/second_look.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "vpe/core/margin.h"
#include "vpe/core/stereo.h"
#include "vpe/warp/fill_open.h"

namespace vpe::app {

namespace {

constexpr float kMostNearest_m = 1e9F;

// What lies beside the view is taken to be no nearer than what it shows.
float nearest_of(const std::vector<float>& range_m) {
  float nearest_m = kMostNearest_m;
  for (const float range : range_m) nearest_m = std::min(nearest_m, range);
  return nearest_m;
}

}  // namespace

SecondLook::SecondLook(const panorama::PanoramaDescription& description, std::size_t budget_bytes,
                       const SecondLookOptions& options)
    : map_(description.map),
      ranges_(panorama::open_ranges(description, budget_bytes)),
      options_(options),
      base_m_(options.eye_base_m),
      pool_(options.threads) {
  if (!ranges_)
    throw std::runtime_error("'" + description.image.string() +
                             "' has no ranges, from which the other eye's view could be made; make it with "
                             "--aux-layers range, or give the other eye's image with --right");
}

EyePair SecondLook::draw(const core::View& view,
                         const std::function<core::RgbImage(const core::View&)>& draw_left) {
  const std::vector<float> range_m = panorama::view_ranges(*ranges_, map_, view);
  if (base_m_ <= 0) {
    const std::optional<double> base_m = core::comfortable_base_m(range_m);
    if (!base_m)
      throw std::runtime_error(
          "the first view shows no ground, so the distance of the eyes is not known; give --eye-base");
    base_m_ = *base_m;
  }
  const float nearest_m = nearest_of(range_m);
  Wide wide = carry(view, core::eye_view(view, base_m_, std::nullopt), base_m_, nearest_m, draw_left);
  return {core::without_margin(std::move(wide.image), wide.margin_px),
          {carried_.width, carried_.height, carried_.colour},
          static_cast<double>(wide.filled) / static_cast<double>(carried_.origin.size())};
}

MovedView SecondLook::draw_moved(const core::View& view,
                                 const std::function<core::RgbImage(const core::View&)>& draw_left) {
  core::View from = view;
  from.camera.position_m = {0, 0, 0};
  const float nearest_m = nearest_of(panorama::view_ranges(*ranges_, map_, from));
  const double asked_m = glm::length(view.camera.position_m);
  const double move_m = std::min(asked_m, kMostMove * static_cast<double>(nearest_m));
  core::View to = view;
  to.camera.position_m *= move_m / asked_m;
  const Wide wide = carry(from, to, move_m, nearest_m, draw_left);
  return {{carried_.width, carried_.height, carried_.colour},
          static_cast<double>(wide.filled) / static_cast<double>(carried_.origin.size()),
          move_m};
}

SecondLook::Wide SecondLook::carry(const core::View& view, const core::View& to, double move_m, float nearest_m,
                                   const std::function<core::RgbImage(const core::View&)>& draw_left) {
  Wide out;
  out.margin_px =
      core::margin_for(view, {&to, 1}, static_cast<double>(nearest_m), {view.width / 2, view.height / 2});
  const core::View wide = core::with_margin(view, out.margin_px);
  out.image = draw_left(wide);
  const core::Frame frame{out.image.width, out.image.height, out.image.pixels,
                          panorama::view_ranges(*ranges_, map_, wide)};
  warp::CarryOptions options;
  options.gap_px = options_.gap_px;
  options.nearest_m = std::max(0.0, static_cast<double>(nearest_m) - move_m);
  carrier_.carry(wide, frame, to, options, pool_, carried_);
  out.filled = warp::fill_open(carried_);
  return out;
}

}  // namespace vpe::app
