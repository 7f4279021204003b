#include "objects/files/child_limits.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <limits>

namespace objects {

namespace {

constexpr unsigned kWaitingPerTime = 5;  // for slow disks

void limit(decltype(RLIMIT_AS) what, rlim_t soft, rlim_t hard) {
  rlimit former{};
  if (::getrlimit(what, &former) == 0) {
    hard = std::min(hard, former.rlim_max);
    soft = std::min(soft, hard);
  }
  const rlimit limits{soft, hard};
  ::setrlimit(what, &limits);
}

}  // namespace

void limit_this_process([[maybe_unused]] double memory_gb, double time_s) {
  limit(RLIMIT_CORE, 0, 0);
#ifndef VPE_CHILD_WITHOUT_MEMORY_LIMIT
  const auto memory_bytes = static_cast<rlim_t>(memory_gb * 1e9);
  limit(RLIMIT_AS, memory_bytes, memory_bytes);
#endif
  const auto most_time_s = static_cast<unsigned>(time_s);
  limit(RLIMIT_CPU, most_time_s, most_time_s + 5);
  ::alarm(kWaitingPerTime * most_time_s);
}

bool send_output(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

double number_of(const char* text) {
  double value = 0;
  const char* end = text + std::strlen(text);
  const auto parsed = std::from_chars(text, end, value);
  return parsed.ec == std::errc() && parsed.ptr == end ? value : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace objects
