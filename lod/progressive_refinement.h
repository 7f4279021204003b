// Look and wait (Hitchner 1992, section 3.1): while the camera moves fast the image may be coarse; when it rests
// it is refined to the full tolerance; then nothing is drawn until something changes. A state machine over
// frames, pure: no clock. For a window: once a frame, ask next() what to draw, draw or not, and tell how that
// went with the next call.
#pragma once

#include <cstdint>

#include "vpe/core/view.h"

namespace lod {

struct ProgressiveRefinementOptions {
  double still_px = 0.01;     // motion a frame up to which the camera rests
  double sharp_px = 4;        // motion a frame up to which nothing is given up
  double max_multiplier = 8;  // of the tolerance, however fast the camera moves
  double refine_factor = 2;   // > 1: at rest and when slowing down, the multiplier falls by this each frame
};

struct RefinementInput {
  double motion_px = 0;          // of the image since the frame before (image_motion_px)
  bool changed = false;          // something other than the pose did: a setting, the size, a tile that arrived
  bool settled = false;          // the frame drawn last showed all that it was to show
  double budget_multiplier = 1;  // of the frame-time controller (frame_budget.h); counts while the camera moves
};

enum class RefinementState : std::uint8_t { kMoving, kRefining, kWaiting };

struct RefinementOutput {
  RefinementState state = RefinementState::kRefining;
  bool draw = true;       // false: the image that is there is the final one
  double multiplier = 1;  // on the tolerance; 1 whenever the image is final
};

class ProgressiveRefinement {
 public:
  // Throws std::invalid_argument for options out of range.
  explicit ProgressiveRefinement(const ProgressiveRefinementOptions& options = {});

  // Motion that is not a number counts as fast.
  RefinementOutput next(const RefinementInput& input);

 private:
  ProgressiveRefinementOptions options_;
  double multiplier_ = 1;
  bool is_full_drawn_ = false;  // the frame drawn last had multiplier 1 and nothing has changed since
};

// How far points of the image move from one view to another, pixels: an upper estimate, to first order, of
// turning (and rolling, at the image's corner), of moving past the nearest terrain, and of zooming. Infinite
// for another projection or size, and for a camera that moves at nearest_m = 0.
double image_motion_px(const vpe::core::View& before, const vpe::core::View& after, double nearest_m);

}  // namespace lod
