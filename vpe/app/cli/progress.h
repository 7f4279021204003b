// A line on stderr with the progress of long work and the time left.
#pragma once

#include <chrono>
#include <string>

namespace vpe::app {

// Names the environment variable with the seconds between two lines that are not on a terminal, 0.1 to 3600.
inline constexpr const char* kProgressVariable = "VPE_PROGRESS_S";

// Shows nothing when quiet. On a terminal it rewrites one line; elsewhere it prints a line every 15 seconds, or as
// often as kProgressVariable says.
//
// Typical usage:
//   ProgressLine line(common.quiet);
//   for (int k = 0; k < count; ++k) {
//     line.show("drawing", static_cast<double>(k) / count);
//     draw(k);
//   }
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();  // clears the line on a terminal
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  // Shows the share of the work that is done, 0..1. Calls are cheap: most of them print nothing. One thread at
  // a time.
  void show(const std::string& what, double fraction);

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool terminal_;
  bool shown_ = false;
  double first_fraction_ = -1;  // work done before the first call does not count into the speed
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_{};
};

}  // namespace vpe::app
