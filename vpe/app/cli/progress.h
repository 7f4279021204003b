// A line on stderr that says how far long work is and how long it will still take.
#pragma once

#include <chrono>
#include <string>

namespace vpe::app {

// Shows nothing when quiet; on a terminal one line that is rewritten, else a line now and then.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();  // ends the line
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // fraction 0..1 of the whole; may be called as often as one likes, by one thread at a time.
  void show(const std::string& what, double fraction);

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool terminal_;
  bool shown_ = false;
  double first_fraction_ = -1;  // work that was done before is not counted into the speed
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_{};
};

}  // namespace vpe::app
