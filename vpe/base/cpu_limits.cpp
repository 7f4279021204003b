#include "vpe/base/cpu_limits.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

namespace vpe::base {

namespace {

namespace fs = std::filesystem;

constexpr int kMostProcessors = 1 << 16;

int affinity_or(int otherwise) {
  // The system refuses sets that are smaller than its own.
  for (int processors = 1024; processors <= kMostProcessors; processors *= 2) {
    const std::unique_ptr<cpu_set_t, void (*)(cpu_set_t*)> set(CPU_ALLOC(static_cast<std::size_t>(processors)),
                                                               [](cpu_set_t* s) { CPU_FREE(s); });
    const std::size_t bytes = CPU_ALLOC_SIZE(static_cast<std::size_t>(processors));
    if (set && ::sched_getaffinity(0, bytes, set.get()) == 0) {
      const int count = CPU_COUNT_S(bytes, set.get());
      return count > 0 ? count : otherwise;
    }
  }
  return otherwise;
}

std::optional<double> first_number(const fs::path& path) {
  std::ifstream file(path);
  double value = 0;
  if (file >> value) return value;
  return std::nullopt;
}

// Returns the quota of one group: cpu.max is "max PERIOD" or "QUOTA PERIOD" in microseconds (version 2);
// cpu.cfs_quota_us is -1 without a limit (version 1).
std::optional<double> quota_of(const fs::path& group) {
  std::optional<double> quota;
  std::optional<double> period;
  if (std::ifstream both(group / "cpu.max"); both) {
    double a = 0;
    double b = 0;
    if (both >> a >> b) {
      quota = a;
      period = b;
    }
  } else {
    quota = first_number(group / "cpu.cfs_quota_us");
    period = first_number(group / "cpu.cfs_period_us");
  }
  if (!quota || !period || !(*quota > 0) || !(*period > 0)) return std::nullopt;
  return *quota / *period;
}

bool names_cpu(const std::string& controllers) {
  return ("," + controllers + ",").find(",cpu,") != std::string::npos;
}

}  // namespace

std::optional<double> cpu_quota(const fs::path& root) {
  const fs::path mount = root / "sys/fs/cgroup";
  std::ifstream groups(root / "proc/self/cgroup");
  std::optional<double> smallest;
  for (std::string line; std::getline(groups, line);) {
    // "ID:CONTROLLERS:PATH"; version 2 has no controllers.
    const std::size_t colon = line.find(':');
    const std::size_t second = colon == std::string::npos ? colon : line.find(':', colon + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(colon + 1, second - colon - 1);
    if (!controllers.empty() && !names_cpu(controllers)) continue;
    fs::path top = mount;
    if (!controllers.empty()) {
      std::error_code none;
      top /= fs::exists(mount / controllers, none) ? controllers : "cpu";
    }
    // In a container the path may be that of the host, which is not mounted: its top is the container's group.
    for (fs::path path = fs::path(line.substr(second + 1)).relative_path();; path = path.parent_path()) {
      if (const auto quota = quota_of(path.empty() ? top : top / path))
        smallest = std::min(smallest.value_or(*quota), *quota);
      if (path.empty()) break;
    }
  }
  return smallest;
}

CpuLimits cpu_limits() {
  CpuLimits limits;
  limits.machine = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  limits.affinity = affinity_or(limits.machine);
  limits.machine = std::max(limits.machine, limits.affinity);
  limits.quota = cpu_quota();
  return limits;
}

int CpuLimits::threads() const {
  const int allowed = std::min(machine, affinity);
  if (!quota || *quota >= allowed) return std::max(1, allowed);
  return std::max(1, static_cast<int>(std::ceil(*quota - 1e-6)));
}

}  // namespace vpe::base
