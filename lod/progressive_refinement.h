// Look and wait (Hitchner 1992, section 3.1): while the eye moves fast the picture may be coarse; when it rests
// it is refined to the full tolerance; then nothing is drawn until something changes. A state machine over
// frames, pure: no clock. For a window: once a frame, ask next() what to draw, draw or not, and tell how that
// went with the next call.
#pragma once

#include <cstdint>

#include "vpe/core/view.h"

namespace lod {

struct LookAndWaitOptions {
  double still_px = 0.01;     // motion a frame up to which the eye rests
  double sharp_px = 4;        // motion a frame up to which nothing is given up
  double max_multiplier = 8;  // of the tolerance, however fast the eye moves
  double refine_factor = 2;   // > 1: at rest and when slowing down, the multiplier falls by this each frame
};

struct LookInput {
  double motion_px = 0;          // of the picture since the frame before (picture_motion_px)
  bool changed = false;          // something other than the pose did: a setting, the size, a tile that arrived
  bool settled = false;          // the frame drawn last showed all that it was to show
  double budget_multiplier = 1;  // of the frame-time controller (frame_budget.h); counts while the eye moves
};

enum class LookState : std::uint8_t { kMoving, kRefining, kWaiting };

struct LookOutput {
  LookState state = LookState::kRefining;
  bool draw = true;       // false: the picture that is there is the final one
  double multiplier = 1;  // on the tolerance; 1 whenever the picture is final
};

class LookAndWait {
 public:
  // Throws std::invalid_argument for options out of range.
  explicit LookAndWait(const LookAndWaitOptions& options = {});

  // Motion that is not a number counts as fast.
  LookOutput next(const LookInput& input);

 private:
  LookAndWaitOptions options_;
  double multiplier_ = 1;
  bool is_full_drawn_ = false;  // the frame drawn last had multiplier 1 and nothing has changed since
};

// How far points of the picture move from one view to another, pixels: an upper estimate, to first order, of
// turning (and rolling, at the picture's corner), of moving past the nearest terrain, and of zooming. Infinite
// for another projection or size, and for an eye that moves at nearest_m = 0.
double picture_motion_px(const vpe::core::View& before, const vpe::core::View& after, double nearest_m);

}  // namespace lod
