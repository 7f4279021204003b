// The number of processors that this process may use.
#pragma once

#include <filesystem>
#include <optional>

namespace vpe::base {

struct CpuLimits {
  int machine = 1;              // processors that are online
  int affinity = 1;             // processors that the calling thread may run on (sched_setaffinity, cpusets)
  std::optional<double> quota;  // processors' worth of time that control groups allow, such as 1.5

  // Returns the number of threads that can run at once, at least 1. A fraction of a processor counts as one.
  int threads() const;
};

// Returns the limits of the calling thread. Never throws for what cannot be read: that limit is left out.
CpuLimits cpu_limits();

// Returns the smallest quota of the control groups of this process and of all above them, version 2 or 1, or
// nullopt if there is none. Reads proc/self/cgroup and sys/fs/cgroup below `root`.
std::optional<double> cpu_quota(const std::filesystem::path& root = "/");

}  // namespace vpe::base
