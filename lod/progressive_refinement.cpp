#include "lod/progressive_refinement.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "mars/geodesy/sphere.h"

namespace lod {

ProgressiveRefinement::ProgressiveRefinement(const ProgressiveRefinementOptions& options) : options_(options) {
  const bool good = options.still_px >= 0.0 && options.sharp_px > options.still_px &&
                    std::isfinite(options.sharp_px) && options.max_multiplier >= 1.0 &&
                    std::isfinite(options.max_multiplier) && options.refine_factor > 1.0;
  if (!good) throw std::invalid_argument("progressive refinement: options out of range");
}

RefinementOutput ProgressiveRefinement::next(const RefinementInput& input) {
  const bool rests = input.motion_px <= options_.still_px;
  if (!rests || input.changed) is_full_drawn_ = false;
  if (rests && is_full_drawn_ && input.settled) return {RefinementState::kWaiting, false, 1.0};
  // Detail that moves by several pixels per frame is not visible at the full tolerance.
  const double speed = std::isnan(input.motion_px) ? std::numeric_limits<double>::infinity() : input.motion_px;
  const double by_speed = std::clamp(speed / options_.sharp_px, 1.0, options_.max_multiplier);
  const double wanted = rests ? 1.0 : std::max(by_speed, std::max(1.0, input.budget_multiplier));
  // Coarsens at once, but refines gradually: a step of the tolerance is a visible jump in the image.
  multiplier_ = std::max(wanted, multiplier_ / options_.refine_factor);
  is_full_drawn_ = rests && multiplier_ == 1.0;
  return {rests ? RefinementState::kRefining : RefinementState::kMoving, true, multiplier_};
}

double image_motion_px(const vpe::core::View& before, const vpe::core::View& after, double nearest_m) {
  namespace core = vpe::core;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (before.projection != after.projection || before.width != after.width || before.height != after.height ||
      before.principal_offset_px != after.principal_offset_px) {
    return kInfinity;
  }
  const bool flat = after.projection == core::Projection::kPerspective;
  const double focal = flat ? core::focal_px(after) : after.width / (2.0 * std::numbers::pi);
  const double corner = 0.5 * std::hypot(after.width, after.height);
  const double turned = mars::angle_between_rad(before.camera.axes.forward, after.camera.axes.forward);
  const double rolled = mars::angle_between_rad(before.camera.axes.up, after.camera.axes.up);
  // Off the axis of a flat image, turning moves points by up to 1 / cos^2 more.
  const double off_axis_magnification = flat ? 1.0 + corner * corner / (focal * focal) : 1.0;
  const double step_m = glm::length(after.camera.position_m - before.camera.position_m);
  const double past = step_m == 0.0     ? 0.0
                      : nearest_m > 0.0 ? step_m / nearest_m * focal * off_axis_magnification
                                        : kInfinity;
  const double zoom = std::abs(core::focal_px(after) / core::focal_px(before) - 1.0) * corner;
  return turned * focal * off_axis_magnification + rolled * corner + past + zoom;
}

}  // namespace lod
