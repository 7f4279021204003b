// Selects the next image of an interactive view: coarse while the camera moves and time is short, full when it
// rests, none when nothing would change. Combines progressive refinement (lod/progressive_refinement.h, "look
// and wait" in Hitchner 1992) with the frame-time controller (lod/frame_budget.h), for images that are drawn
// one after the other. Has no clock.
//
// The time budget alone makes images coarser: ProgressiveRefinement's rule for motion is switched off
// (max_multiplier = 1). One factor m describes a coarse image: it has sqrt(m) times fewer pixels along each side,
// down to LiveImageOptions::smallest_side; only then its tolerance grows, in pixels of the screen, up to
// most_tolerance. So the tiles of an image that moves are those of the image at rest, or at most about a level
// coarser: other tiles would not be there when a motion begins. Images can exceed the budget therefore.
#pragma once

#include <optional>

#include "lod/frame_budget.h"
#include "lod/progressive_refinement.h"
#include "vpe/core/view.h"

namespace vpe::explore {

struct LiveImageOptions {
  // Time of an image while the camera moves. Smaller: smoother motion, coarser images; larger: the reverse. 0:
  // all images are full.
  double budget_ms = 50;
  // Smallest side of a coarse image relative to the full one. Smaller: budgets are met on slower machines, with
  // blurred images; larger: sharper, but the budget may be exceeded.
  double smallest_side = 1.0 / 3.0;
  // Largest factor on the tolerance of a coarse image, >= 1. Smaller: the ground changes less when a motion begins
  // or ends; larger: budgets are met on slower machines. The error of a tile is about twice that of its children.
  double most_tolerance = 2;
};

// Chooses image by image. For one thread at a time.
//
// Typical usage:
//   if (const auto request = live.next(view, has_changed, nearest_m)) {
//     ...                               // draw request->view with request->multiplier
//     live.record(milliseconds, is_settled);
//   }
class LiveImage {
 public:
  // Throws std::invalid_argument for a budget under 0, a side outside (0, 1] or a tolerance under 1.
  explicit LiveImage(const LiveImageOptions& options = {});

  void set_budget_ms(double budget_ms);

  struct Request {
    double multiplier = 1;  // DrawRequest::coarsening, in pixels of the screen
    double side = 1;      // pixels along a side, relative to the wanted view; a pixel of the screen is so long
    core::View view;      // the wanted view, possibly with fewer pixels
    bool is_full = true;  // in tolerance and pixels
  };
  // Returns the next image to draw, or nullopt if the last one is final. Call it whenever no image is being
  // drawn. `changed`: something besides the view has changed since the last request. `nearest_m`: distance of
  // the nearest ground, from which the motion in the image follows.
  std::optional<Request> next(const core::View& wanted, bool changed, double nearest_m);

  // Records the time and the result of the last request. Times of images at rest tell the controller something only
  // before the first motion: full images take as long as they need.
  void record(double ms, bool settled);

  lod::RefinementState state() const { return state_; }

 private:
  LiveImageOptions options_;
  lod::ProgressiveRefinement refinement_;
  lod::FrameBudgetState budget_;
  std::optional<core::View> last_;  // wanted view of the last request
  double last_multiplier_ = 1;
  bool settled_ = false;
  bool is_first_ = true;  // nothing was requested yet
  lod::RefinementState state_ = lod::RefinementState::kRefining;
};

// Returns the same view with fewer pixels (0 < side <= 1), at least 16 a side.
core::View reduced(const core::View& view, double side);

}  // namespace vpe::explore
