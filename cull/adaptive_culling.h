// Decides whether a culling test saves more time than it costs. Culled tiles are invisible, so images do not
// depend on the decision.
//
// Typical usage, once per frame:
//   if (culling.use()) {
//     const CullingFrame frame = cull_and_measure();
//     culling.record_frame(frame);
//   } else {
//     culling.skip_frame();
//   }
#pragma once

namespace cull {

struct AdaptiveCullingLimits {
  // Number of frames over which costs and savings are averaged. Larger: steadier, slower to react.
  int memory_frames = 8;
  // Culling is switched off if the saved time falls below keep_ratio times the spent time, and after a trial it
  // stays on only if the saved time is above accept_ratio times the spent time. Nothing changes between both
  // ratios: the farther apart, the fewer changes.
  double keep_ratio = 0.8;
  double accept_ratio = 1.25;
  int trial_frames = 4;  // length of the first trial and of later ones
  // Frames without culling until the next trial. The wait doubles after each failed trial, up to the longest
  // one.
  int wait_frames = 30;
  int longest_wait_frames = 960;
};

// Measurements of one frame in which culling was used.
struct CullingFrame {
  double spent_ms = 0;
  int tested = 0;
  int culled = 0;
  double tile_ms = 0;  // mean drawing time of one tile
};

// Counts frames; does not read a clock. Frames in which nothing was tested are ignored.
class AdaptiveCulling {
 public:
  explicit AdaptiveCulling(const AdaptiveCullingLimits& limits = {})
      : limits_(limits), wait_(limits.wait_frames) {}

  // Returns true if culling should be used in the next frame.
  bool use() const { return state_ != State::kOff; }

  // Call one of these after every frame, depending on whether culling was used. Frames with times that are
  // negative or not finite are ignored.
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
