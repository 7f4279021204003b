#include "vpe/explore/images/live_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vpe::explore {

namespace {

lod::ProgressiveRefinementOptions refinement_options() {
  lod::ProgressiveRefinementOptions options;
  options.max_multiplier = 1;  // motion alone does not make images coarser: the budget does
  options.refine_factor = 4;
  return options;
}

}  // namespace

core::View reduced(const core::View& view, double side) {
  static constexpr int kLeast_px = 16;
  core::View small = view;
  const auto fewer = [side](int n) {
    return std::max(std::min(n, kLeast_px), static_cast<int>(std::lround(n * side)));
  };
  small.width = fewer(view.width);
  small.height = fewer(view.height);
  // The field of view is vertical. The horizontal one follows from the ratio of the sides, which rounding
  // changes by less than a pixel.
  small.principal_offset_px = {view.principal_offset_px.x * small.width / view.width,
                               view.principal_offset_px.y * small.height / view.height};
  return small;
}

LiveImage::LiveImage(const LiveImageOptions& options) : options_(options), refinement_(refinement_options()) {
  if (!(options.budget_ms >= 0.0) || !std::isfinite(options.budget_ms))
    throw std::invalid_argument("the budget of an image must be 0 (none) or more milliseconds");
  if (!(options.smallest_side > 0.0 && options.smallest_side <= 1.0))
    throw std::invalid_argument("the smallest side must be within 0..1 of the image's");
  if (!(options.most_tolerance >= 1.0) || !std::isfinite(options.most_tolerance))
    throw std::invalid_argument("the largest factor on the tolerance must be 1 or more");
}

void LiveImage::set_budget_ms(double budget_ms) {
  if (!(budget_ms >= 0.0) || !std::isfinite(budget_ms) || budget_ms == options_.budget_ms) return;
  options_.budget_ms = budget_ms;
  budget_ = {};
}

std::optional<LiveImage::Request> LiveImage::next(const core::View& wanted, bool changed, double nearest_m) {
  lod::RefinementInput input;
  input.motion_px =
      last_ ? lod::image_motion_px(*last_, wanted, nearest_m) : std::numeric_limits<double>::infinity();
  input.changed = changed || is_first_;
  // A coarse image is not the final one, even if all its tiles were loaded.
  input.settled = settled_ && last_multiplier_ == 1.0;
  input.budget_multiplier = options_.budget_ms > 0.0 ? budget_.multiplier : 1.0;
  const lod::RefinementOutput output = refinement_.next(input);
  state_ = output.state;
  if (!output.draw) return std::nullopt;
  Request request;
  request.is_full = output.multiplier == 1.0;
  request.side = std::max(options_.smallest_side, 1.0 / std::sqrt(output.multiplier));
  request.multiplier = request.is_full ? 1.0
                                       : std::clamp(output.multiplier * request.side * request.side, 1.0,
                                                    options_.most_tolerance);
  request.view = reduced(wanted, request.side);
  last_ = wanted;
  last_multiplier_ = output.multiplier;
  is_first_ = false;
  return request;
}

void LiveImage::record(double ms, bool settled) {
  settled_ = settled;
  if (options_.budget_ms > 0.0 && (state_ == lod::RefinementState::kMoving || !budget_.started)) {
    lod::FrameBudgetOptions budget;
    budget.budget_ms = options_.budget_ms;
    budget.max_multiplier = options_.most_tolerance / (options_.smallest_side * options_.smallest_side);
    lod::next_multiplier(budget, {last_multiplier_, ms}, budget_);
  }
}

}  // namespace vpe::explore
