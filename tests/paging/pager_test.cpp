#include "paging/pager.h"

#include <atomic>
#include <set>

#include "tests/support/support.h"

namespace {

using namespace std::chrono_literals;
using test_support::Random;
using Pager = paging::Pager<int, int, std::hash<int>>;
using Outcome = Pager::Outcome;
constexpr auto kEver = Pager::Clock::time_point::max();

std::vector<Pager::Want> wants(std::initializer_list<std::pair<int, double>> list) {
  std::vector<Pager::Want> out;
  for (const auto& [key, urgency] : list) out.push_back({key, urgency});
  return out;
}

std::pair<int, std::size_t> twice(int key) { return {2 * key, 10}; }

TEST(Pager, LoadsWhatIsMostUrgentFirst) {
  Pager pager(twice, 0, 1000);
  pager.want(wants({{1, 0.5}, {2, 3}, {3, 1}, {4, 3}}));
  std::vector<int> order;
  for (int n = 0; n < 6; ++n) {
    for (const Pager::Loaded& page : pager.take(1000)) {
      EXPECT_EQ(page.value, 2 * page.key);
      order.push_back(page.key);
    }
  }
  EXPECT_EQ(order, (std::vector<int>{2, 4, 3, 1}));
}

TEST(Pager, WhatIsNoLongerWantedIsNotStarted) {
  std::vector<int> started;
  Pager pager(
      [&](int key) {
        started.push_back(key);
        return twice(key);
      },
      0, 1000);
  pager.want(wants({{1, 1}, {2, 0}, {3, 0}}));
  pager.take(1000);
  pager.want(wants({{3, 0}}));
  EXPECT_EQ(pager.counts().wanted, 1U);
  for (int n = 0; n < 3; ++n) pager.take(1000);
  EXPECT_EQ(started, (std::vector<int>{1, 3}));
  EXPECT_EQ(pager.wait(kEver), Outcome::kNothingLeft);
}

TEST(Pager, LoadersRestWhileTooMuchWaits) {
  std::atomic<int> loads{0};
  Pager pager(
      [&](int key) {
        ++loads;
        return twice(key);
      },
      2, 30);
  std::vector<Pager::Want> all;
  for (int k = 0; k < 100; ++k) all.push_back({k, 0});
  pager.want(all);
  while (pager.counts().bytes < 30) std::this_thread::yield();
  std::this_thread::sleep_for(20ms);
  EXPECT_LE(loads, 4);  // two threads may have started below the limit
  std::set<int> got;
  while (pager.wait(kEver) != Outcome::kNothingLeft) {
    for (const Pager::Loaded& page : pager.take(15)) EXPECT_TRUE(got.insert(page.key).second);
  }
  EXPECT_EQ(got.size(), 100U);
  EXPECT_EQ(pager.counts().bytes, 0U);
}

TEST(Pager, TakesWithinALimitButAtLeastOne) {
  Pager pager(twice, 0, 1000);
  pager.want(wants({{1, 0}, {2, 0}, {3, 0}}));
  ASSERT_EQ(pager.wait(kEver), Outcome::kSomething);
  EXPECT_EQ(pager.take(1).size(), 1U);
}

TEST(Pager, FailuresAreKeptAndNotTriedAgain) {
  std::atomic<int> loads{0};
  Pager pager(
      [&](int key) -> std::pair<int, std::size_t> {
        ++loads;
        if (key == 2) throw std::runtime_error("planet.vpe: tile 2 is damaged");
        return twice(key);
      },
      1, 1000);
  pager.want(wants({{2, 1}}));
  EXPECT_EQ(pager.wait(kEver), Outcome::kSomething);
  EXPECT_EQ(pager.failure(2), "planet.vpe: tile 2 is damaged");
  EXPECT_FALSE(pager.failure(1));
  pager.want(wants({{2, 1}}));
  EXPECT_EQ(pager.wait(kEver), Outcome::kNothingLeft);
  EXPECT_EQ(loads, 1);
  EXPECT_EQ(pager.counts().failed, 1U);
}

TEST(Pager, OutOfMemoryReachesTheOwner) {
  Pager pager([](int) -> std::pair<int, std::size_t> { throw std::bad_alloc(); }, 1, 1000);
  pager.want(wants({{1, 0}}));
  EXPECT_THROW(
      {
        while (pager.wait(kEver) != Outcome::kNothingLeft) {
        }
      },
      std::bad_alloc);
}

TEST(Pager, WaitingHasAnEnd) {
  std::atomic<bool> go{false};
  Pager pager(
      [&](int key) {
        while (!go) std::this_thread::sleep_for(1ms);
        return twice(key);
      },
      1, 1000);
  pager.want(wants({{1, 0}}));
  EXPECT_EQ(pager.wait(Pager::Clock::now() + 10ms), Outcome::kTimeout);
  go = true;
  EXPECT_EQ(pager.wait(kEver), Outcome::kSomething);
}

// Owners that request, take and end at random times; mainly for the thread sanitizer.
TEST(PagerThreads, AskTakeAndGoAwayAtRandom) {
  Random random(7);
  for (int round = 0; round < 40; ++round) {
    std::atomic<int> under_way{0};
    {
      const int limit = random.integer(10, 200);
      Pager pager(
          [&](int key) -> std::pair<int, std::size_t> {
            ++under_way;
            if (key % 7 == 0) std::this_thread::sleep_for(200us);
            --under_way;
            if (key % 11 == 0) throw std::runtime_error("broken");
            return twice(key);
          },
          random.integer(1, 6), static_cast<std::size_t>(limit));
      std::set<int> taken;
      for (int n = 0; n < 60; ++n) {
        std::vector<Pager::Want> asked;
        for (int k = random.integer(0, 20); k > 0; --k) {
          const int key = random.integer(0, 200);
          if (taken.count(key) == 0) asked.push_back({key, random.uniform(0, 1)});
        }
        pager.want(std::move(asked));
        for (const Pager::Loaded& page : pager.take(static_cast<std::size_t>(random.integer(0, 50)))) {
          EXPECT_TRUE(taken.insert(page.key).second) << page.key << " came twice";
          EXPECT_NE(page.key % 11, 0);
        }
        if (random.integer(0, 4) == 0) pager.wait(Pager::Clock::now() + 1ms);
        pager.counts();
        pager.failure(random.integer(0, 200));
      }
    }
    EXPECT_EQ(under_way, 0);  // nothing outlives the pager
  }
}

}  // namespace
