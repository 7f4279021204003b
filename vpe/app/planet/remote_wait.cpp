#include "vpe/app/planet/remote_wait.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "mars/remote/gdal_remote.h"
#include "mars/remote/remote_watch.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/program.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

constexpr double kGraceAfterSignal_s = 1;

// Returns the URL, as users give it, of what GDAL names /vsicurl/URL.
std::string address_of(const mars::RemoteWait& wait) {
  constexpr std::string_view kPrefix = "/vsicurl/";
  return wait.address.starts_with(kPrefix) ? wait.address.substr(kPrefix.size()) : wait.address;
}

// Reports reads that last. Used by one thread.
class WaitReporter {
 public:
  explicit WaitReporter(bool quiet) : quiet_(quiet) {}

  void operator()(const mars::RemoteWait& wait) {
    if (wait.number != number_) {
      number_ = wait.number;
      next_s_ = kToldWait_s;
      seconds_at_signal_.reset();
    }
    if (const int signal = InterruptGuard::pending(); signal != 0) {
      if (!seconds_at_signal_) seconds_at_signal_ = wait.seconds;
      if (wait.seconds - *seconds_at_signal_ > kGraceAfterSignal_s) {
        std::fprintf(stderr, "vpe: stopped while waiting for %s\n", address_of(wait).c_str());
        std::_Exit(kSignalBase + signal);
      }
    }
    if (wait.seconds < next_s_) return;
    next_s_ *= 2;
    if (quiet_) return;
    std::fprintf(stderr,
                 "vpe: note: still waiting for %s after %s s; a server that sends nothing for 30 s "
                 "(GDAL_HTTP_LOW_SPEED_TIME) is asked again, and given up after %s s\n",
                 address_of(wait).c_str(), base::format_rounded(wait.seconds, 0).c_str(),
                 base::format_rounded(mars::kRemotePatience_s, 0).c_str());
  }

 private:
  bool quiet_;
  int number_ = 0;
  double next_s_ = kToldWait_s;
  std::optional<double> seconds_at_signal_;
};

}  // namespace

void watch_remote_reads(bool quiet) { mars::set_remote_watch(WaitReporter(quiet)); }

void require_local_planet(const std::string& name) {
  if (!mars::is_remote(mars::raster_name(name))) return;
  throw std::runtime_error(
      name +
      ": planet files are read from a disk, not from a server; fetch it first, for example "
      "with curl -O, and give the file's name");
}

}  // namespace vpe::app
