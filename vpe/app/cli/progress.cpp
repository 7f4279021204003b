#include "vpe/app/cli/progress.h"

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "vpe/base/number.h"

namespace vpe::app {

namespace {

std::chrono::milliseconds pause_off_terminals() {
  constexpr std::chrono::milliseconds kUsual(15000);
  const char* text = std::getenv(kProgressVariable);
  const auto seconds = text == nullptr ? std::nullopt : base::parse_number(text);
  if (!seconds || !(*seconds >= 0.1 && *seconds <= 3600)) return kUsual;
  return std::chrono::milliseconds(static_cast<std::int64_t>(1000 * *seconds));
}

}  // namespace

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (shown_ && terminal_) std::fprintf(stderr, "\r\033[K");
}

void ProgressLine::show(const std::string& what, double fraction) {
  if (quiet_) return;
  if (first_fraction_ < 0) first_fraction_ = fraction;
  const auto now = Clock::now();
  const auto pause = terminal_ ? std::chrono::milliseconds(200) : pause_off_terminals();
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
