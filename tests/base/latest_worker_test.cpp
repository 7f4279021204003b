#include "vpe/base/latest_worker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

// After GoogleTest, which it does not include.
#include <rapidcheck/gtest.h>

namespace vpe::base {
namespace {

constexpr double kLong_s = 60;  // never waited for, unless a test fails

// A work that a test holds back: requests below 0 report that they have begun and wait for let_go().
class Gate {
 public:
  int pass(int request) {
    begun_requests.push_back(request);
    if (request < 0) {
      begun_.set_value();
      go_.get_future().wait();
    }
    return request;
  }
  void wait_for_begin() { begun_.get_future().wait(); }
  void let_go() { go_.set_value(); }

  std::vector<int> begun_requests;  // read it when the worker is idle or gone

 private:
  std::promise<void> begun_;
  std::promise<void> go_;
};

TEST(LatestWorker, RunsOnlyTheNewestOfTheRequestsThatWait) {
  Gate gate;
  LatestWorker<int, int> worker([&](int request) { return gate.pass(request); });
  worker.request(-1);
  gate.wait_for_begin();
  for (int n = 2; n <= 5; ++n) worker.request(n);
  gate.let_go();
  int last = 0;
  while (last != 5) last = worker.take(kLong_s).value();
  EXPECT_TRUE(worker.is_idle());
  EXPECT_EQ(gate.begun_requests, (std::vector<int>{-1, 5}));
}

TEST(LatestWorker, GivesAResultOnce) {
  LatestWorker<int, std::string> worker([](int request) { return std::to_string(request); });
  EXPECT_TRUE(worker.is_idle());
  worker.request(3);
  EXPECT_FALSE(worker.is_idle());
  EXPECT_EQ(worker.take(kLong_s), "3");
  EXPECT_TRUE(worker.is_idle());
  EXPECT_EQ(worker.take(), std::nullopt);
}

TEST(LatestWorker, IsNotIdleUntilTheResultIsTaken) {
  std::promise<void> notified;
  LatestWorker<int, int> worker([](int request) { return request; }, [&] { notified.set_value(); });
  worker.request(3);
  notified.get_future().wait();
  EXPECT_FALSE(worker.is_idle());
  EXPECT_EQ(worker.take(), 3);
  EXPECT_TRUE(worker.is_idle());
}

TEST(LatestWorker, ReplacesAResultThatWasNotTaken) {
  std::atomic<int> done = 0;
  LatestWorker<int, int> worker([](int request) { return request; }, [&] { ++done; });
  for (int n = 1; n <= 3; ++n) {
    worker.request(n);
    while (done < n) std::this_thread::yield();
  }
  EXPECT_EQ(worker.take(), 3);
  EXPECT_EQ(worker.take(), std::nullopt);
}

TEST(LatestWorker, WaitsOnlyWhileSomethingIsUnderWay) {
  Gate gate;
  LatestWorker<int, int> worker([&](int request) { return gate.pass(request); });
  EXPECT_EQ(worker.take(kLong_s), std::nullopt);
  worker.request(-1);
  gate.wait_for_begin();
  EXPECT_EQ(worker.take(0.01), std::nullopt);
  EXPECT_EQ(worker.take(-1), std::nullopt);
  gate.let_go();
  EXPECT_EQ(worker.take(1e300), -1);
}

TEST(LatestWorker, KeepsAnEarlierResultWhenThereIsNoNewOne) {
  std::atomic<int> done = 0;
  const auto odd_ones = [](int request) { return request % 2 == 1 ? std::optional(request) : std::nullopt; };
  LatestWorker<int, int> worker(odd_ones, [&] { ++done; });
  for (int n = 1; n <= 2; ++n) {
    worker.request(n);
    while (done < n) std::this_thread::yield();
  }
  EXPECT_EQ(worker.take(), 1);
  worker.request(4);
  EXPECT_EQ(worker.take(kLong_s), std::nullopt);  // returns when the request is done
  EXPECT_TRUE(worker.is_idle());
}

TEST(LatestWorker, PassesOnExceptionsAndGoesOn) {
  LatestWorker<int, int> worker([](int request) {
    if (request == 1) throw std::runtime_error("unreadable tile");
    if (request == 2) throw 17;
    return request;
  });
  worker.request(1);
  try {
    worker.take(kLong_s);
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "unreadable tile");
  }
  EXPECT_TRUE(worker.is_idle());
  EXPECT_EQ(worker.take(), std::nullopt);
  worker.request(2);
  EXPECT_THROW(worker.take(kLong_s), int);
  worker.request(3);
  EXPECT_EQ(worker.take(kLong_s), 3);
}

TEST(LatestWorker, GivesTheLatestOfResultsAndExceptions) {
  std::atomic<int> done = 0;
  const auto even_ones = [](int request) {
    if (request % 2 == 1) throw std::runtime_error("odd");
    return request;
  };
  LatestWorker<int, int> worker(even_ones, [&] { ++done; });
  const auto run = [&](int request) {
    const int before = done;
    worker.request(request);
    while (done == before) std::this_thread::yield();
  };
  run(1);
  run(2);
  EXPECT_EQ(worker.take(), 2);
  EXPECT_EQ(worker.take(), std::nullopt);
  run(2);
  run(1);
  EXPECT_THROW(worker.take(), std::runtime_error);
  EXPECT_EQ(worker.take(), std::nullopt);
}

TEST(LatestWorker, ForgetsWhatWaitsAndWhatIsFinishedButNotWhatRuns) {
  Gate gate;
  LatestWorker<int, int> worker([&](int request) { return gate.pass(request); });
  worker.request(-1);
  gate.wait_for_begin();
  worker.request(2);
  worker.forget();
  EXPECT_FALSE(worker.is_idle());
  gate.let_go();
  EXPECT_EQ(worker.take(kLong_s), -1);
  EXPECT_EQ(gate.begun_requests, std::vector<int>{-1});
  worker.request(3);
  while (true) {
    // Until the result is there, forget() may come before the request has begun.
    if (auto result = worker.take(kLong_s)) break;
  }
  worker.forget();
  EXPECT_TRUE(worker.is_idle());
}

TEST(LatestWorker, ForgetsAnException) {
  std::promise<void> notified;
  LatestWorker<int, int> worker([](int) -> int { throw std::runtime_error("no"); },
                                [&] { notified.set_value(); });
  worker.request(1);
  notified.get_future().wait();
  EXPECT_FALSE(worker.is_idle());
  worker.forget();
  EXPECT_TRUE(worker.is_idle());
  EXPECT_EQ(worker.take(), std::nullopt);
}

TEST(LatestWorker, NotifiesOnItsThreadAfterEveryRequest) {
  std::thread::id work_thread;
  std::atomic<int> notified = 0;
  std::atomic<bool> same_thread = true;
  {
    LatestWorker<int, int> worker(
        [&](int request) -> std::optional<int> {
          work_thread = std::this_thread::get_id();
          if (request == 2) throw std::runtime_error("no");
          return request == 3 ? std::nullopt : std::optional(request);
        },
        [&] {
          if (std::this_thread::get_id() != work_thread) same_thread = false;
          ++notified;
        });
    for (int n = 1; n <= 3; ++n) {
      worker.request(n);
      while (notified < n) std::this_thread::yield();
    }
  }
  EXPECT_TRUE(same_thread);
  EXPECT_NE(work_thread, std::this_thread::get_id());
  EXPECT_EQ(notified, 3);
}

TEST(LatestWorker, FinishesWhatRunsAndDropsWhatWaitsAtItsEnd) {
  Gate gate;
  std::atomic<bool> ended = false;
  std::thread opener;
  {
    LatestWorker<int, int> worker([&](int request) {
      gate.pass(request);
      ended = true;
      return request;
    });
    worker.request(-1);
    gate.wait_for_begin();
    worker.request(2);
    opener = std::thread([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      EXPECT_FALSE(ended);
      gate.let_go();
    });
  }
  EXPECT_TRUE(ended);
  opener.join();
  EXPECT_EQ(gate.begun_requests, std::vector<int>{-1});
}

TEST(LatestWorker, EndsAtOnceWithoutRequests) {
  const LatestWorker<int, int> worker([](int n) { return n; });
}

TEST(LatestWorker, DestroysItsWorkOnItsThread) {
  struct Context {
    std::thread::id* made;
    std::thread::id* gone;
    ~Context() { *gone = std::this_thread::get_id(); }
  };
  std::thread::id made;
  std::thread::id gone;
  {
    LatestWorker<int, int> worker([&, context = std::unique_ptr<Context>()](int request) mutable {
      made = std::this_thread::get_id();
      if (context == nullptr) context.reset(new Context{&made, &gone});
      return request;
    });
    worker.request(1);
    worker.take(kLong_s);
  }
  EXPECT_NE(made, std::this_thread::get_id());
  EXPECT_EQ(made, gone);
}

TEST(LatestWorker, TakesRequestsAndResultsThatCanOnlyBeMoved) {
  using Box = std::unique_ptr<int>;
  LatestWorker<Box, Box> worker([](Box request) {
    ++*request;
    return request;
  });
  worker.request(std::make_unique<int>(1));
  EXPECT_EQ(**worker.take(kLong_s), 2);
}

// For any number of requests at any pace: they run in order, each at most once, and the last one always.
RC_GTEST_PROP(LatestWorkerProperty, NeverLosesTheLastRequest, ()) {
  const auto pauses_us = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 40)));
  std::vector<int> begun;
  int last = -1;
  {
    LatestWorker<int, int> worker([&](int request) {
      begun.push_back(request);
      return request;
    });
    for (std::size_t n = 0; n < pauses_us.size(); ++n) {
      worker.request(static_cast<int>(n));
      if (pauses_us[n] < 30) std::this_thread::sleep_for(std::chrono::microseconds(pauses_us[n]));
      if (pauses_us[n] % 5 != 0) continue;
      if (const auto result = worker.take()) {
        RC_ASSERT(*result > last);
        last = *result;
      }
    }
    while (const auto result = worker.take(kLong_s)) {
      RC_ASSERT(*result > last);
      last = *result;
    }
    RC_ASSERT(worker.is_idle());
  }
  RC_ASSERT(last == static_cast<int>(pauses_us.size()) - 1);
  RC_ASSERT(begun.back() == last);
  RC_ASSERT(std::is_sorted(begun.begin(), begun.end(), std::less_equal<>()));
}

}  // namespace
}  // namespace vpe::base
