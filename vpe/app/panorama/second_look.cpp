#include "vpe/app/panorama/second_look.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "vpe/core/margin.h"
#include "vpe/core/stereo.h"
#include "vpe/warp/fill_open.h"

namespace vpe::app {

namespace {

constexpr float kMostNearest_m = 1e9F;

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
  // What lies beside the view is taken to be no nearer than what it shows.
  float nearest_m = kMostNearest_m;
  for (const float range : range_m) nearest_m = std::min(nearest_m, range);
  const core::View right = core::eye_view(view, base_m_, std::nullopt);
  const glm::ivec2 margin_px =
      core::margin_for(view, {&right, 1}, static_cast<double>(nearest_m), {view.width / 2, 0});
  const core::View wide = core::with_margin(view, margin_px);
  core::RgbImage image = draw_left(wide);
  const core::Frame frame{image.width, image.height, image.pixels, panorama::view_ranges(*ranges_, map_, wide)};
  warp::CarryOptions carry;
  carry.gap_px = options_.gap_px;
  carry.nearest_m = std::max(0.0, static_cast<double>(nearest_m) - base_m_);
  carrier_.carry(wide, frame, right, carry, pool_, carried_);
  const std::int64_t filled = warp::fill_open(carried_);
  return {core::without_margin(std::move(image), margin_px),
          {carried_.width, carried_.height, carried_.colour},
          static_cast<double>(filled) / static_cast<double>(carried_.origin.size())};
}

}  // namespace vpe::app
