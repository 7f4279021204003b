// Whether a culler earns its time. What is culled is invisible, so images do not depend on the answer.
#pragma once

namespace cull {

struct AdaptiveCullingLimits {
  int memory_frames = 8;    // what is weighed is a mean over about this many frames of use
  double keep_ratio = 0.8;  // goes off when the time saved falls below this times the time spent,
  double accept_ratio =
      1.25;              // and after a trial stays on only when it is above this: between both nothing changes
  int trial_frames = 4;  // the first frames, and those of a later try
  int wait_frames = 30;  // off, until it is tried again; twice as long after every trial that fails,
  int longest_wait_frames = 960;
};

// What a culler did in one frame in which it was used.
struct CullingFrame {
  double spent_ms = 0;
  int tested = 0;
  int culled = 0;
  double tile_ms = 0;  // mean time that a tile takes to be drawn
};

// Counts frames, knows no clock. Frames in which nothing was tested say nothing and do not count as use.
class AdaptiveCulling {
 public:
  explicit AdaptiveCulling(const AdaptiveCullingLimits& limits = {})
      : limits_(limits), wait_(limits.wait_frames) {}

  // Whether to use the culler in the next frame.
  bool use() const { return state_ != State::kOff; }

  // After every frame: what it did, if it was used. Times must be finite and not negative; others are not
  // counted.
  void record_frame(const CullingFrame& frame);
  void skip_frame();

 private:
  enum class State { kTrial, kOn, kOff };
  void begin(State state);

  AdaptiveCullingLimits limits_;
  State state_ = State::kTrial;
  int frames_ = 0;  // in this state
  int wait_;
  double spent_ms_ = 0;
  double saved_ms_ = 0;
};

}  // namespace cull
