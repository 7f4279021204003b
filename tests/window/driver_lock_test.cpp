#include "vpe/window/ui/driver_lock.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace {

using vpe::window::DriverLock;

TEST(DriverLock, HoldsNothingUnlessThreadsAreKeptApart) {
  EXPECT_FALSE(DriverLock().is_held());
  DriverLock::keep_apart(true);
  EXPECT_TRUE(DriverLock().is_held());
  DriverLock::keep_apart(false);
  EXPECT_FALSE(DriverLock().is_held());
}

TEST(DriverLock, LetsOneThreadInAtATime) {
  DriverLock::keep_apart(true);
  std::atomic<int> inside{0};
  std::atomic<int> most{0};
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int n = 0; n < 1000; ++n) {
        const DriverLock lock;
        const int now = ++inside;
        if (now > most) most = now;
        std::this_thread::yield();
        --inside;
      }
    });
  }
  threads.clear();
  DriverLock::keep_apart(false);
  EXPECT_EQ(most, 1);
}

}  // namespace
