#include "vpe/explore/live_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vpe::explore {

namespace {

lod::ProgressiveRefinementOptions look_options() {
  lod::ProgressiveRefinementOptions options;
  options.max_multiplier = 1;  // only what the budget asks for is given up
  options.refine_factor = 2;
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
  // The field of view is vertical: the horizontal one follows the ratio of the sides, which rounding bends by
  // less than a pixel.
  small.principal_offset_px = {view.principal_offset_px.x * small.width / view.width,
                               view.principal_offset_px.y * small.height / view.height};
  return small;
}

LiveImage::LiveImage(const LiveImageOptions& options) : options_(options), look_(look_options()) {
  if (!(options.budget_ms >= 0.0) || !std::isfinite(options.budget_ms))
    throw std::invalid_argument("the budget of a picture must be 0 (none) or more milliseconds");
  if (!(options.smallest_side > 0.0 && options.smallest_side <= 1.0))
    throw std::invalid_argument("the smallest side must be within 0..1 of the picture's");
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
  input.changed = changed || lost_;
  // An image in which something was given up is not the final one, whatever was loaded.
  input.settled = settled_ && last_multiplier_ == 1.0;
  input.budget_multiplier = options_.budget_ms > 0.0 ? budget_.multiplier : 1.0;
  const lod::RefinementOutput output = look_.next(input);
  state_ = output.state;
  if (!output.draw) return std::nullopt;
  Request order;
  order.multiplier = output.multiplier;
  order.is_full = output.multiplier == 1.0;
  order.view = reduced(wanted, std::max(options_.smallest_side, 1.0 / std::sqrt(output.multiplier)));
  last_ = wanted;
  last_multiplier_ = output.multiplier;
  lost_ = false;
  return order;
}

void LiveImage::made(double ms, bool settled) {
  settled_ = settled;
  // Images at rest are full whatever they take; they tell the controller about its line all the same.
  if (options_.budget_ms > 0.0) {
    lod::FrameBudgetOptions budget;
    budget.budget_ms = options_.budget_ms;
    lod::next_multiplier(budget, {last_multiplier_, ms}, budget_);
  }
}

}  // namespace vpe::explore
