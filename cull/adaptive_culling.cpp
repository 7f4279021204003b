#include "cull/adaptive_culling.h"

#include <algorithm>
#include <cmath>

namespace cull {

void AdaptiveCulling::begin(State state) {
  state_ = state;
  frames_ = 0;
  if (state == State::kTrial) spent_ms_ = saved_ms_ = 0.0;
}

void AdaptiveCulling::record_frame(const CullingFrame& frame) {
  const bool counts = std::isfinite(frame.spent_ms) && frame.spent_ms >= 0.0 && std::isfinite(frame.tile_ms) &&
                      frame.tile_ms >= 0.0 && frame.tested > 0;
  if (state_ == State::kOff || !counts) return;
  ++frames_;
  // The mean of a trial's frames, then an exponential moving average.
  const int memory = state_ == State::kTrial ? frames_ : std::max(1, limits_.memory_frames);
  const double share = 1.0 / memory;
  spent_ms_ += share * (frame.spent_ms - spent_ms_);
  saved_ms_ += share * (frame.culled * frame.tile_ms - saved_ms_);
  if (state_ == State::kTrial && frames_ >= limits_.trial_frames) {
    if (saved_ms_ >= limits_.accept_ratio * spent_ms_) {
      wait_ = limits_.wait_frames;
      begin(State::kOn);
    } else {
      begin(State::kOff);
    }
  } else if (state_ == State::kOn && saved_ms_ < limits_.keep_ratio * spent_ms_) {
    begin(State::kOff);
  }
}

void AdaptiveCulling::skip_frame() {
  if (state_ != State::kOff || ++frames_ < wait_) return;
  wait_ = std::min(2 * wait_, limits_.longest_wait_frames);
  begin(State::kTrial);
}

}  // namespace cull
