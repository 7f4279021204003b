// The time of a scene whose objects move, while no flight gives it.
#pragma once

#include <algorithm>

#include "vpe/explore/objects/scene_item.h"

namespace vpe::explore {

// Runs over a range of times, and stops at its end. Has no clock: the caller passes the elapsed time.
//
// Typical usage:
//   clock.set_range(time_range(editor.items()));
//   clock.play(true);
//   clock.advance(dt_s);
class SceneClock {
 public:
  // Covers these times. Keeps the time within; where nothing can play, pauses.
  void set_range(const TimeRange& range) {
    begin_s_ = range.begin_s;
    end_s_ = range.end_s;
    set(time_s_);
    plays_ = plays_ && can_play();
  }

  double begin_s() const { return begin_s_; }
  double end_s() const { return end_s_; }
  double time_s() const { return time_s_; }
  bool plays() const { return plays_; }
  // Returns true if anything moves.
  bool can_play() const { return begin_s_ < end_s_; }

  // Jumps to a time, clamped to the range. Does not start or pause.
  void set(double time_s) { time_s_ = std::clamp(time_s, begin_s_, end_s_); }
  // Starts or pauses. At the end it starts from the beginning.
  void play(bool plays) {
    plays_ = plays && can_play();
    if (plays_ && time_s_ >= end_s_) time_s_ = begin_s_;
  }
  // Advances by elapsed time, seconds, 0 or more. Pauses exactly at the end.
  void advance(double dt_s) {
    if (!plays_) return;
    set(time_s_ + dt_s);
    if (time_s_ >= end_s_) plays_ = false;
  }

 private:
  double begin_s_ = 0;
  double end_s_ = 0;
  double time_s_ = 0;
  bool plays_ = false;
};

}  // namespace vpe::explore
