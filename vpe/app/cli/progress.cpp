#include "vpe/app/cli/progress.h"

#include <unistd.h>

#include <cstdio>

namespace vpe::app {

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shown_ && terminal_) std::fprintf(stderr, "\r\033[K");
}

void ProgressLine::show(const std::string& what, double fraction) {
  if (quiet_) return;
  if (first_fraction_ < 0) first_fraction_ = fraction;
  const auto now = Clock::now();
  const auto pause = terminal_ ? std::chrono::milliseconds(200) : std::chrono::milliseconds(15000);
  // Off a terminal, short work prints nothing.
  if (now - (shown_ || terminal_ ? last_ : start_) < pause) return;
  last_ = now;
  shown_ = true;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  std::string left = "...";
  if (const double made = fraction - first_fraction_; made > 0.01) {
    const auto seconds = static_cast<long>(elapsed * (1.0 - fraction) / made + 0.5);
    left = std::to_string(seconds / 60) + ":" + (seconds % 60 < 10 ? "0" : "") + std::to_string(seconds % 60) +
           " left";
  }
  std::fprintf(stderr, "%s%s: %.0f %%, %s%s", terminal_ ? "\r" : "", what.c_str(), 100.0 * fraction,
               left.c_str(), terminal_ ? "\033[K" : "\n");
  std::fflush(stderr);
}

}  // namespace vpe::app
