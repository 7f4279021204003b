// The cache against a plain model, and under many threads.
#include "vpe/base/lru_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

// After GoogleTest, which it does not include.
#include <rapidcheck/gtest.h>

namespace vpe::base {
namespace {

using Cache = LruCache<int, int, std::hash<int>>;
constexpr std::size_t kEntry = Cache::kEntryBytes;

Cache::Pointer value(int n) { return std::make_shared<const int>(n); }
std::pair<Cache::Pointer, std::size_t> loaded(int n, std::size_t bytes) { return {value(n), bytes}; }

TEST(LruCache, DropsTheLeastRecentlyUsed) {
  Cache cache(3 * (kEntry + 100));
  for (int n = 0; n < 3; ++n) cache.insert(n, value(n), 100);
  EXPECT_NE(cache.find(0), nullptr);
  cache.insert(3, value(3), 100);
  EXPECT_EQ(cache.find(1), nullptr);
  for (const int n : {0, 2, 3}) EXPECT_EQ(*cache.find(n), n);
  EXPECT_EQ(cache.bytes(), 3 * (kEntry + 100));
}

TEST(LruCache, KeepsTheNewestWhateverItsSize) {
  Cache cache(1000, 0);
  cache.insert(1, value(1), 10);
  cache.insert(2, value(2), 50'000);
  EXPECT_EQ(cache.find(1), nullptr);
  EXPECT_EQ(*cache.find(2), 2);
  cache.set_limit(1);
  EXPECT_EQ(*cache.find(2), 2);
}

TEST(LruCache, KeepsTheEarlierValue) {
  Cache cache(1000);
  const auto first = cache.insert(1, value(1), 10);
  EXPECT_EQ(cache.insert(1, value(2), 10), first);
  EXPECT_EQ(cache.get(1, [] { return loaded(3, 10); }), first);
  EXPECT_EQ(cache.bytes(), kEntry + 10);
}

TEST(LruCache, CountsWhatItIsToldToForAnEntry) {
  Cache cache(1000, 7);
  cache.insert(1, value(1), 10);
  EXPECT_EQ(cache.bytes(), 17U);
}

TEST(LruCache, ValuesOutliveTheirPlace) {
  Cache cache(1);
  const auto held = cache.insert(1, value(1), 10);
  cache.insert(2, value(2), 10);
  cache.clear();
  EXPECT_EQ(*held, 1);
  EXPECT_EQ(cache.bytes(), 0U);
  EXPECT_EQ(cache.find(2), nullptr);
}

TEST(LruCache, ErasesOneOrMany) {
  Cache cache(100'000);
  for (int n = 0; n < 10; ++n) cache.insert(n, value(n), 10);
  cache.erase(4);
  cache.erase(4);
  EXPECT_EQ(cache.find(4), nullptr);
  cache.erase_if([](int key) { return key % 2 == 1; });
  for (int n = 0; n < 10; ++n) EXPECT_EQ(cache.find(n) != nullptr, n % 2 == 0 && n != 4) << n;
  EXPECT_EQ(cache.bytes(), 4 * (kEntry + 10));
  cache.set_limit(2 * (kEntry + 10));
  EXPECT_EQ(cache.bytes(), 2 * (kEntry + 10));
  EXPECT_NE(cache.find(8), nullptr);
  EXPECT_NE(cache.find(6), nullptr);
}

TEST(LruCache, HoldsValuesOfSeveralTypes) {
  LruCache<int, void, std::hash<int>> cache(1000);
  cache.insert(1, std::make_shared<const int>(5), 4);
  cache.insert(2, std::make_shared<const std::string>("text"), 4);
  EXPECT_EQ(*std::static_pointer_cast<const int>(cache.find(1)), 5);
  EXPECT_EQ(*std::static_pointer_cast<const std::string>(cache.find(2)), "text");
}

TEST(LruCache, MayDestroyValuesThatUseIt) {
  // The lock is not held then.
  Cache other(1000);
  struct User {
    Cache* cache;
    ~User() { cache->insert(1, value(1), 1); }
  };
  LruCache<int, User, std::hash<int>> users(1);
  users.insert(1, std::make_shared<const User>(User{&other}), 1);
  users.insert(2, std::make_shared<const User>(User{&other}), 1);
  users.erase(2);
  EXPECT_NE(other.find(1), nullptr);
}

TEST(LruCache, LoadsOnceForThreadsThatAskAtOnce) {
  Cache cache(100'000);
  std::atomic<int> loads = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      for (int key = 0; key < 50; ++key) {
        const auto got = cache.get_once(key, [&] {
          ++loads;
          std::this_thread::yield();
          return loaded(key, 10);
        });
        EXPECT_EQ(*got, key);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(loads, 50);
}

TEST(LruCache, LoadsAgainAfterAFailure) {
  Cache cache(1000);
  const auto fail = []() -> std::pair<Cache::Pointer, std::size_t> { throw std::runtime_error("unreadable"); };
  EXPECT_THROW(cache.get_once(1, fail), std::runtime_error);
  EXPECT_THROW(cache.get(1, fail), std::runtime_error);
  EXPECT_EQ(*cache.get_once(1, [] { return loaded(1, 10); }), 1);
  // One failure among many that wait: each calls its own load in turn.
  std::atomic<int> loads = 0;
  std::atomic<int> failures = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([&] {
      try {
        const auto got = cache.get_once(2, [&] {
          if (loads++ < 3) throw std::runtime_error("unreadable");
          return loaded(2, 10);
        });
        EXPECT_EQ(*got, 2);
      } catch (const std::runtime_error&) {
        ++failures;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(failures, 3);
  EXPECT_EQ(loads, 4);
}

TEST(LruList, TrimsOnlyWhatMayLeave) {
  LruList<std::unique_ptr<int>> list;
  std::vector<LruList<std::unique_ptr<int>>::Handle> at;
  for (int n = 0; n < 6; ++n) at.push_back(list.add(std::make_unique<int>(n), 10));
  const int* pinned = at[1]->value.get();
  list.touch(at[0]);
  auto gone = list.trim(25, [&](const std::unique_ptr<int>& v) { return v.get() != pinned; });
  std::vector<int> numbers;
  for (const auto& entry : gone) numbers.push_back(*entry.value);
  EXPECT_EQ(numbers, (std::vector<int>{2, 3, 4, 5}));
  EXPECT_EQ(list.bytes(), 20U);
  EXPECT_EQ(*at[1]->value, 1);  // handles stay valid
  EXPECT_EQ(list.trim(0, [](const auto&) { return false; }).size(), 0U);
  EXPECT_EQ(list.trim(0).size(), 1U);
  EXPECT_EQ(list.size(), 1U);
  EXPECT_EQ(*list.erase(at[0]).front().value, 0);
  EXPECT_EQ(list.bytes(), 0U);
}

// Any calls, against a model: a vector in order of use.
RC_GTEST_PROP(LruCacheProperty, IsAListInOrderOfUse, ()) {
  struct Known {
    int key;
    std::size_t bytes;
  };
  std::size_t limit = *rc::gen::inRange<std::size_t>(0, 100);
  Cache cache(limit, 3);
  std::vector<Known> model;  // most recently used first
  const auto trim = [&] {
    std::size_t bytes = 0;
    for (const Known& known : model) bytes += known.bytes + 3;
    while (bytes > limit && model.size() > 1) {
      bytes -= model.back().bytes + 3;
      model.pop_back();
    }
    return bytes;
  };
  const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 10'000));
  for (const int step : steps) {
    const int key = step % 8;
    const auto at = std::find_if(model.begin(), model.end(), [&](const Known& k) { return k.key == key; });
    const auto bytes = static_cast<std::size_t>(step / 8 % 40);
    switch (step / 320 % 6) {
      case 0:
      case 1:
        cache.insert(key, value(key), bytes);
        if (at == model.end()) model.insert(model.begin(), Known{key, bytes});
        break;
      case 2:
        RC_ASSERT((cache.find(key) != nullptr) == (at != model.end()));
        if (at != model.end()) std::rotate(model.begin(), at, at + 1);
        break;
      case 3:
        cache.get_once(key, [&] { return loaded(key, bytes); });
        if (at != model.end())
          std::rotate(model.begin(), at, at + 1);
        else
          model.insert(model.begin(), Known{key, bytes});
        break;
      case 4:
        cache.erase(key);
        if (at != model.end()) model.erase(at);
        break;
      default:
        limit = bytes * 4;
        cache.set_limit(limit);
        break;
    }
    RC_ASSERT(cache.bytes() == trim());
  }
  for (const Known& known : model) RC_ASSERT(cache.find(known.key) != nullptr);
}

}  // namespace
}  // namespace vpe::base
