// Progressive refinement ("look and wait", Hitchner 1992, section 3.1): while the camera moves fast, the image
// may be coarse; when it rests, the image is refined to the full tolerance; then nothing is drawn until
// something changes.
//
// A state machine over frames, pure, without a clock.
//
// Typical usage, once per frame of a window:
//   const RefinementOutput out = refinement.next({motion_px, changed, settled, budget_multiplier});
//   if (!out.draw) continue;
//   request.coarsening = out.multiplier;
//   settled = renderer.draw(request).settled;
#pragma once

#include <cstdint>

#include "vpe/core/view.h"

namespace lod {

struct ProgressiveRefinementOptions {
  double still_px = 0.01;  // motion per frame up to which the camera counts as resting
  // Motion per frame up to which the full tolerance is kept. Smaller: coarser in motion, faster.
  double sharp_px = 4;
  double max_multiplier = 8;  // of the tolerance, for the fastest motion. Larger: coarser in motion, faster
  // > 1; at rest and when slowing down, the multiplier falls by this factor each frame. Larger: fewer steps,
  // more visible ones.
  double refine_factor = 2;
};

struct RefinementInput {
  double motion_px = 0;          // of the image since the frame before (image_motion_px())
  bool changed = false;          // a change other than of the pose: a setting, the size, a loaded tile
  bool settled = false;          // the frame drawn last was complete
  double budget_multiplier = 1;  // of the frame-time controller (frame_budget.h); used while the camera moves
};

enum class RefinementState : std::uint8_t { kMoving, kRefining, kWaiting };

struct RefinementOutput {
  RefinementState state = RefinementState::kRefining;
  bool draw = true;       // false: the current image is the final one
  double multiplier = 1;  // on the tolerance; 1 whenever the image is final
};

// Decides for each frame whether and how coarsely to draw.
class ProgressiveRefinement {
 public:
  // Throws std::invalid_argument for options out of range.
  explicit ProgressiveRefinement(const ProgressiveRefinementOptions& options = {});

  // Returns the decision for the next frame. Motion that is not a number counts as fast.
  RefinementOutput next(const RefinementInput& input);

 private:
  ProgressiveRefinementOptions options_;
  double multiplier_ = 1;
  bool is_full_drawn_ = false;  // the frame drawn last had multiplier 1 and nothing has changed since
};

// Returns an upper estimate, to first order, of how far points of the image move from one view to another, in
// pixels: by turning (and rolling, at the image's corner), by moving past the nearest terrain, and by zooming.
// Infinite for another projection or size, and for a camera that moves at nearest_m = 0.
double image_motion_px(const vpe::core::View& before, const vpe::core::View& after, double nearest_m);

}  // namespace lod
