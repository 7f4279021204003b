// Which image to draw next while somebody looks: coarse while the camera moves and time is short, full when it
// rests, none when nothing would change. Look and wait (lod/progressive_refinement.h) and the frame-time controller
// (lod/frame_budget.h) in one, over images that are made one after the other. Pure: no clock.
//
// What is given up for speed is one factor m: the tolerance counts m times, and the image has sqrt(m) times
// fewer pixels along each side, to kSmallestSide; so triangles, rays and pixels all fall.
#pragma once

#include <optional>

#include "lod/frame_budget.h"
#include "lod/progressive_refinement.h"
#include "vpe/core/view.h"

namespace vpe::explore {

struct LiveImageOptions {
  double budget_ms = 50;  // of an image while the camera moves; 0: nothing is given up
  double smallest_side = 1.0 / 3.0;
};

class LiveImage {
 public:
  // Throws std::invalid_argument for a budget under 0 or a side outside (0, 1].
  explicit LiveImage(const LiveImageOptions& options = {});

  void set_budget_ms(double budget_ms);

  struct Request {
    double multiplier = 1;  // DrawRequest::coarsening
    core::View view;        // `wanted`, perhaps of fewer pixels
    bool is_full = true;    // nothing is given up
  };
  // Whenever no image is on its way. `changed`: something besides the view did since the last order.
  // nearest_m: distance of the nearest ground, for how far the image moves. Nothing: the image that is
  // there is final.
  std::optional<Request> next(const core::View& wanted, bool changed, double nearest_m);

  // How the last order went.
  void made(double ms, bool settled);

  lod::RefinementState state() const { return state_; }

 private:
  LiveImageOptions options_;
  lod::ProgressiveRefinement look_;
  lod::FrameBudgetState budget_;
  std::optional<core::View> last_;  // wanted at the last order
  double last_multiplier_ = 1;
  bool settled_ = false;
  bool lost_ = true;  // nothing was drawn yet
  lod::RefinementState state_ = lod::RefinementState::kRefining;
};

// The same view of fewer pixels (0 < side <= 1), at least 16 a side.
core::View reduced(const core::View& view, double side);

}  // namespace vpe::explore
