// Jobs beside drawing: their order, how many wait, and their errors.
#include "vpe/app/film/frame_sink.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <stdexcept>
#include <vector>

namespace vpe::app {
namespace {

TEST(FrameSink, RunsJobsInTheirOrder) {
  std::vector<int> done;
  FrameSink sink;
  for (int n = 0; n < 100; ++n) sink.push([&done, n] { done.push_back(n); }, 1 << 20);
  sink.finish();
  ASSERT_EQ(done.size(), 100U);
  for (int n = 0; n < 100; ++n) EXPECT_EQ(done[static_cast<std::size_t>(n)], n);
}

// Returns how many jobs of this size can be pushed while the first one runs; waits for `wanted` of them.
int jobs_beside_one(std::size_t bytes, int wanted) {
  std::promise<void> begun;
  std::promise<void> opened;
  std::atomic<int> pushed{0};
  FrameSink sink;
  sink.push([&] {
    begun.set_value();
    opened.get_future().wait();
  });
  begun.get_future().wait();
  std::thread drawing([&] {
    for (int n = 0; n < 40; ++n) {
      sink.push([] {}, bytes);
      ++pushed;
    }
  });
  const auto late = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (pushed < wanted && std::chrono::steady_clock::now() < late) std::this_thread::yield();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // for more than there should be
  const int waiting = pushed;
  opened.set_value();
  drawing.join();
  sink.finish();
  EXPECT_EQ(pushed, 40);
  return waiting;
}

TEST(FrameSink, SoManyWaitAsTheMemoryAllows) {
  EXPECT_EQ(jobs_beside_one(FrameSink::kMostWaitingBytes / 10, 10), 10);
  EXPECT_EQ(jobs_beside_one(10 * FrameSink::kMostWaitingBytes, 3), 3);
}

TEST(FrameSink, AnErrorComesOutAndStopsTheRest) {
  int done = 0;
  FrameSink sink;
  sink.push([&] { ++done; });
  sink.push([] { throw std::runtime_error("the disk is full"); });
  try {
    sink.push([&] { ++done; });
    sink.finish();
    FAIL() << "no error";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "the disk is full");
  }
  EXPECT_EQ(done, 1);
}

}  // namespace
}  // namespace vpe::app
