#include "vpe/base/parallel.h"

#include <condition_variable>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/support.h"

namespace vpe::base {
namespace {

TEST(Parallel, EveryItemOnceForAnyCountAndThreads) {
  for (const int threads : {-1, 0, 1, 2, 3, 8, 1000000}) {
    for (const std::size_t count : {0U, 1U, 2U, 3U, 17U, 1000U, 100003U}) {
      std::vector<int> made(count, 0);  // written without locks: an item made twice is a race
      EXPECT_TRUE(parallel_for(count, threads, [&](std::size_t n) { ++made[n]; }));
      EXPECT_EQ(std::count(made.begin(), made.end(), 1), static_cast<std::ptrdiff_t>(count));
    }
  }
}

TEST(Parallel, SeveralThreadsTakePart) {
  // Each item waits for the other: one thread alone would never end.
  ThreadPool pool(2);
  ASSERT_EQ(pool.threads(), 2);
  std::atomic<int> arrived = 0;
  EXPECT_TRUE(pool.run(2, [&](std::size_t) {
    ++arrived;
    while (arrived < 2) std::this_thread::yield();
  }));
}

TEST(Parallel, OneThreadIsTheCallerInOrder) {
  std::vector<std::size_t> order;
  const std::thread::id caller = std::this_thread::get_id();
  parallel_for(100, 1, [&](std::size_t n) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    order.push_back(n);
  });
  std::vector<std::size_t> expected(100);
  std::iota(expected.begin(), expected.end(), std::size_t{0});
  EXPECT_EQ(order, expected);
}

TEST(Parallel, TheExceptionOfTheLowestItemComesOut) {
  test_support::Random random(1);
  for (int round = 0; round < 300; ++round) {
    const auto count = static_cast<std::size_t>(random.integer(1, 3000));
    std::vector<char> throws(count, 0);
    for (int n = random.integer(1, 20); n > 0; --n) {
      throws[static_cast<std::size_t>(random.integer(0, static_cast<int>(count) - 1))] = 1;
    }
    const auto lowest = static_cast<std::size_t>(std::find(throws.begin(), throws.end(), 1) - throws.begin());
    std::vector<char> made(count, 0);
    try {
      parallel_for(count, random.integer(1, 8), [&](std::size_t n) {
        made[n] = 1;
        if (throws[n] != 0) throw std::runtime_error(std::to_string(n));
      });
      FAIL() << "nothing thrown";
    } catch (const std::runtime_error& e) {
      EXPECT_EQ(e.what(), std::to_string(lowest));
    }
    EXPECT_EQ(std::count(made.begin(), made.begin() + static_cast<std::ptrdiff_t>(lowest), 1),
              static_cast<std::ptrdiff_t>(lowest));
  }
}

TEST(Parallel, ThePoolOutlivesAnException) {
  ThreadPool pool(4);
  EXPECT_THROW(pool.run(1000, [](std::size_t) { throw 1; }), int);
  std::atomic<int> made = 0;
  EXPECT_TRUE(pool.run(1000, [&](std::size_t) { ++made; }));
  EXPECT_EQ(made, 1000);
}

TEST(Parallel, CancelStopsAndSaysSo) {
  std::atomic<bool> cancel = false;
  std::atomic<int> made = 0;
  EXPECT_FALSE(parallel_for(
      1000000, 4,
      [&](std::size_t) {
        if (++made == 10) cancel = true;
      },
      &cancel));
  EXPECT_GE(made, 10);
  EXPECT_LT(made, 1000000);

  made = 0;
  EXPECT_FALSE(parallel_for(
      10, 2, [&](std::size_t) { ++made; }, &cancel));
  EXPECT_EQ(made, 0);

  cancel = false;
  EXPECT_TRUE(parallel_for(
      10, 2, [](std::size_t) {}, &cancel));
}

TEST(Parallel, NestedLoopsOnOnePoolEnd) {
  ThreadPool pool(3);
  std::vector<std::vector<int>> made(50, std::vector<int>(50, 0));
  pool.run(50, [&](std::size_t i) { pool.run(50, [&](std::size_t j) { ++made[i][j]; }); });
  for (const auto& row : made) EXPECT_EQ(row, std::vector<int>(50, 1));
}

TEST(Parallel, ManyCallersShareOnePool) {
  ThreadPool pool(3);
  std::vector<std::thread> callers;
  std::atomic<int> made = 0;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([&] {
      for (int round = 0; round < 200; ++round) EXPECT_TRUE(pool.run(50, [&](std::size_t) { ++made; }));
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(made, 4 * 200 * 50);
}

TEST(Parallel, ThreadsAreLimited) {
  EXPECT_GE(default_threads(), 1);
  EXPECT_LE(default_threads(), kMaxThreads);
  EXPECT_LE(ThreadPool(1 << 30).threads(), kMaxThreads);
  EXPECT_EQ(ThreadPool(0).threads(), default_threads());
  EXPECT_EQ(ThreadPool(1).threads(), 1);
}

// Of a worker and a caller, who are let go one after the other.
class Gate {
 public:
  void open() {
    {
      const std::lock_guard lock(mutex_);
      open_ = true;
    }
    changed_.notify_all();
  }
  void pass() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return open_; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
};

TEST(Parallel, BackgroundLoopsRunOnIdleThreads) {
  ThreadPool pool(3);
  ThreadPool background(ThreadPool::Background{pool});
  EXPECT_EQ(background.threads(), 3);
  const std::thread::id caller = std::this_thread::get_id();
  for (const std::size_t count : {0U, 1U, 2U, 17U, 5000U}) {
    std::vector<int> made(count, 0);
    EXPECT_TRUE(background.run(count, [&](std::size_t n) {
      EXPECT_NE(std::this_thread::get_id(), caller);
      ++made[n];
    }));
    EXPECT_EQ(made, std::vector<int>(count, 1));
  }
}

TEST(Parallel, BackgroundLoopsGiveWayAfterAnItem) {
  ThreadPool pool(2);
  ThreadPool background(ThreadPool::Background{pool});
  Gate begun, go_on;
  std::atomic<int> made = 0;
  std::atomic<int> made_when_foreground_ran = -1;
  std::thread later([&] {
    background.run(100, [&](std::size_t n) {
      if (n == 0) begun.open();
      if (n == 0) go_on.pass();
      ++made;
    });
  });
  begun.pass();  // the one worker is in item 0
  Gate helped;
  pool.run(2, [&](std::size_t n) {
    if (n == 0) {
      go_on.open();
      helped.pass();  // by the worker, in place of its next background item
    } else {
      made_when_foreground_ran = made.load();
      helped.open();
    }
  });
  EXPECT_EQ(made_when_foreground_ran, 1);
  later.join();
  EXPECT_EQ(made, 100);
}

// Also if no other thread could ever run them.
TEST(Parallel, BackgroundLoopsCanBePromoted) {
  for (const int threads : {1, 2, 4}) {
    ThreadPool pool(threads);
    ThreadPool background(ThreadPool::Background{pool});
    std::vector<int> made(3000, 0);
    Gate begun;
    std::thread later([&] {
      begun.open();
      EXPECT_TRUE(background.run(made.size(), [&](std::size_t n) { ++made[n]; }));
      EXPECT_TRUE(background.run(made.size(), [&](std::size_t n) { ++made[n]; }));
    });
    begun.pass();
    background.promote();
    later.join();
    EXPECT_EQ(made, std::vector<int>(3000, 2));
  }
}

TEST(Parallel, BackgroundLoopsCanBeStopped) {
  for (const int threads : {1, 2, 4}) {
    ThreadPool pool(threads);
    ThreadPool background(ThreadPool::Background{pool});
    Gate begun;
    std::thread later([&] {
      begun.open();
      EXPECT_FALSE(background.run(1U << 30, [&](std::size_t) { EXPECT_GT(threads, 1); }));
      EXPECT_FALSE(background.run(5, [&](std::size_t) { ADD_FAILURE() << "begun after the stop"; }));
    });
    begun.pass();
    background.stop();
    later.join();
    EXPECT_TRUE(background.is_stopped());
    // The foreground pool goes on.
    EXPECT_TRUE(pool.run(100, [](std::size_t) {}));
  }
}

TEST(Parallel, ExceptionsComeOutOfBackgroundLoops) {
  ThreadPool pool(3);
  ThreadPool background(ThreadPool::Background{pool});
  for (int round = 0; round < 100; ++round) {
    EXPECT_THROW(background.run(50,
                                [&](std::size_t n) {
                                  if (n >= 7) throw std::runtime_error("n");
                                }),
                 std::runtime_error);
  }
  EXPECT_TRUE(background.run(50, [](std::size_t) {}));
}

TEST(Parallel, ForegroundAndBackgroundLoopsAlwaysEnd) {
  test_support::Random random(5);
  for (int round = 0; round < 200; ++round) {
    ThreadPool pool(random.integer(1, 4));
    ThreadPool background(ThreadPool::Background{pool});
    const auto count = static_cast<std::size_t>(random.integer(1, 200));
    std::vector<int> made(count, 0);
    bool whole = false;
    std::thread later([&] { whole = background.run(count, [&](std::size_t n) { ++made[n]; }); });
    std::atomic<int> in_foreground = 0;
    for (int loops = random.integer(0, 20); loops > 0; --loops) {
      in_foreground = 0;
      EXPECT_TRUE(pool.run(30, [&](std::size_t) { ++in_foreground; }));
      EXPECT_EQ(in_foreground, 30);
    }
    const bool stops = random.integer(0, 1) == 0;
    if (stops) {
      background.stop();
    } else {
      background.promote();
    }
    later.join();
    const auto all = std::count(made.begin(), made.end(), 1);
    EXPECT_EQ(whole, all == static_cast<std::ptrdiff_t>(count));
    EXPECT_TRUE(whole || stops);
  }
}

}  // namespace
}  // namespace vpe::base
