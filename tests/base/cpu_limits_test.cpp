#include "vpe/base/cpu_limits.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <fstream>
#include <thread>

#include "tests/support/support.h"
#include "vpe/base/parallel.h"

namespace {

using vpe::base::cpu_limits;
using vpe::base::cpu_quota;
using vpe::base::CpuLimits;

class CpuQuota : public testing::Test {
 protected:
  void write(const std::string& path, const std::string& text) {
    std::filesystem::create_directories((dir_ / path).parent_path());
    std::ofstream(dir_ / path) << text;
  }
  test_support::TempDir dir_;
};

TEST_F(CpuQuota, Version2) {
  EXPECT_FALSE(cpu_quota(dir_.path()));
  write("proc/self/cgroup", "0::/system.slice/slurmstepd.scope/job_7/step_0\n");
  write("sys/fs/cgroup/system.slice/slurmstepd.scope/job_7/step_0/cpu.max", "max 100000\n");
  EXPECT_FALSE(cpu_quota(dir_.path()));
  write("sys/fs/cgroup/system.slice/slurmstepd.scope/job_7/cpu.max", "250000 100000\n");
  EXPECT_EQ(cpu_quota(dir_.path()), 2.5);
  write("sys/fs/cgroup/system.slice/slurmstepd.scope/job_7/step_0/cpu.max", "50000 100000\n");
  EXPECT_EQ(cpu_quota(dir_.path()), 0.5);
}

TEST_F(CpuQuota, InAContainerOnlyTheTopIsMounted) {
  write("proc/self/cgroup", "0::/docker/0123456789abcdef\n");
  write("sys/fs/cgroup/cpu.max", "300000 100000\n");
  EXPECT_EQ(cpu_quota(dir_.path()), 3.0);
}

TEST_F(CpuQuota, Version1) {
  write("proc/self/cgroup", "5:memory:/m\n4:cpu,cpuacct:/job\n3:cpuset:/job\n0::/\n");
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "-1\n");
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_period_us", "100000\n");
  EXPECT_FALSE(cpu_quota(dir_.path()));
  write("sys/fs/cgroup/cpu,cpuacct/job/cpu.cfs_quota_us", "150000\n");
  EXPECT_EQ(cpu_quota(dir_.path()), 1.5);
}

TEST_F(CpuQuota, NonsenseIsNoLimit) {
  for (const char* text : {"", "x y\n", "-5 100000\n", "100000 0\n", "100000\n"}) {
    write("proc/self/cgroup", "0::/\nno colons\n:\n");
    write("sys/fs/cgroup/cpu.max", text);
    EXPECT_FALSE(cpu_quota(dir_.path())) << text;
  }
}

TEST(CpuLimits, ThreadsAreTheSmallestLimit) {
  EXPECT_EQ((CpuLimits{.machine = 8, .affinity = 8, .quota = {}}.threads()), 8);
  EXPECT_EQ((CpuLimits{.machine = 8, .affinity = 3, .quota = {}}.threads()), 3);
  EXPECT_EQ((CpuLimits{.machine = 8, .affinity = 8, .quota = 1.5}.threads()), 2);
  EXPECT_EQ((CpuLimits{.machine = 8, .affinity = 8, .quota = 2.0}.threads()), 2);
  EXPECT_EQ((CpuLimits{.machine = 8, .affinity = 8, .quota = 0.1}.threads()), 1);
  EXPECT_EQ((CpuLimits{.machine = 8, .affinity = 4, .quota = 16.0}.threads()), 4);
}

TEST(CpuLimits, AffinityLimitsThreads) {
  int affinity = 0;
  int threads = 0;
  std::thread([&] {
    cpu_set_t all;
    ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
    cpu_set_t one;
    CPU_ZERO(&one);
    for (int n = 0; n < CPU_SETSIZE; ++n) {
      if (!CPU_ISSET(n, &all)) continue;
      CPU_SET(n, &one);
      break;
    }
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    affinity = cpu_limits().affinity;
    threads = vpe::base::default_threads();
  }).join();
  EXPECT_EQ(affinity, 1);
  EXPECT_EQ(threads, 1);
  EXPECT_GE(cpu_limits().machine, cpu_limits().affinity);
}

}  // namespace
