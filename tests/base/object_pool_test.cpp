#include "vpe/base/object_pool.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

// After GoogleTest, which it does not include.
#include <rapidcheck/gtest.h>

namespace vpe::base {
namespace {

// Counts how many objects are alive.
struct Counted {
  explicit Counted(int& alive_count, int number_of_it = 0) : alive(&alive_count), number(number_of_it) {
    ++*alive;
  }
  ~Counted() { --*alive; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  int* alive;
  int number;
};

class ObjectPools : public testing::Test {
 protected:
  using Pool = ObjectPool<Counted>;
  Pool::Pointer make() { return std::make_unique<Counted>(alive_, made_++); }
  Pool pool_with(Pool::Options options) {
    return Pool([this] { return make(); }, std::move(options));
  }

  int alive_ = 0;
  int made_ = 0;
};

TEST_F(ObjectPools, LendAnIdleObjectBeforeANewOne) {
  Pool pool = pool_with({});
  EXPECT_EQ(pool.idle_count(), 0U);
  const Counted* first = nullptr;
  {
    const auto lease = pool.acquire();
    first = lease.get();
    EXPECT_EQ(pool.idle_count(), 0U);
    EXPECT_EQ(&*lease, first);
    EXPECT_EQ(lease->number, 0);
  }
  EXPECT_EQ(pool.idle_count(), 1U);
  EXPECT_EQ(pool.acquire().get(), first);
  EXPECT_EQ(made_, 1);
}

TEST_F(ObjectPools, LendDifferentObjectsAtTheSameTime) {
  Pool pool = pool_with({});
  const auto a = pool.acquire();
  const auto b = pool.acquire();
  EXPECT_NE(a.get(), b.get());
  EXPECT_EQ(alive_, 2);
}

TEST_F(ObjectPools, LendTheObjectReturnedLast) {
  Pool pool = pool_with({});
  std::optional<Pool::Lease> a(pool.acquire());
  std::optional<Pool::Lease> b(pool.acquire());
  std::optional<Pool::Lease> c(pool.acquire());
  b.reset();
  c.reset();
  a.reset();
  const auto first = pool.acquire();
  const auto second = pool.acquire();
  const auto third = pool.acquire();
  EXPECT_EQ(first->number, 0);
  EXPECT_EQ(second->number, 2);
  EXPECT_EQ(third->number, 1);
}

TEST_F(ObjectPools, DestroyTheirObjects) {
  {
    Pool pool = pool_with({});
    const auto a = pool.acquire();
    const auto b = pool.acquire();
  }
  EXPECT_EQ(alive_, 0);
}

TEST_F(ObjectPools, ReturnAMovedLeaseOnce) {
  Pool pool = pool_with({});
  {
    auto lease = pool.acquire();
    const auto moved = std::move(lease);
    EXPECT_EQ(moved->number, 0);
    EXPECT_EQ(lease.get(), nullptr);  // NOLINT(bugprone-use-after-move): that is the question
  }
  EXPECT_EQ(pool.idle_count(), 1U);
}

TEST_F(ObjectPools, KeepAnObjectWhenAnExceptionPropagates) {
  Pool pool = pool_with({});
  try {
    const auto lease = pool.acquire();
    throw std::runtime_error("stop");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(pool.idle_count(), 1U);
}

TEST_F(ObjectPools, DiscardAnObjectWhenAnExceptionPropagatesIfAskedTo) {
  Pool pool = pool_with({.discard_on_exception = true});
  try {
    const auto lease = pool.acquire();
    throw std::runtime_error("stop");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(pool.idle_count(), 0U);
  EXPECT_EQ(alive_, 0);
  // An exception that was caught while the object was in use is no reason.
  {
    const auto lease = pool.acquire();
    try {
      throw std::runtime_error("stop");
    } catch (const std::runtime_error&) {
    }
  }
  EXPECT_EQ(pool.idle_count(), 1U);
}

TEST_F(ObjectPools, KeepAnObjectThatIsUsedWhileAnotherExceptionPropagates) {
  Pool pool = pool_with({.discard_on_exception = true});
  struct Finisher {
    Pool& pool;
    ~Finisher() { const auto lease = pool.acquire(); }
  };
  try {
    const Finisher finisher{pool};
    throw std::runtime_error("stop");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(pool.idle_count(), 1U);
}

TEST_F(ObjectPools, DiscardOnRequest) {
  Pool pool = pool_with({});
  {
    auto lease = pool.acquire();
    lease.discard();
    EXPECT_EQ(alive_, 0);
    EXPECT_EQ(lease.get(), nullptr);
  }
  EXPECT_EQ(pool.idle_count(), 0U);
}

TEST_F(ObjectPools, KeepNoMoreThanTheLimit) {
  Pool pool = pool_with({.max_idle = 2});
  {
    const auto a = pool.acquire();
    const auto b = pool.acquire();
    const auto c = pool.acquire();
    EXPECT_EQ(alive_, 3);
  }
  EXPECT_EQ(pool.idle_count(), 2U);
  EXPECT_EQ(alive_, 2);
  Pool none = pool_with({.max_idle = 0});
  none.acquire();
  EXPECT_EQ(none.idle_count(), 0U);
}

TEST_F(ObjectPools, ResetAnObjectWhenItIsReturned) {
  Pool pool = pool_with({.reset = [](Counted& object) { object.number = -1; }});
  {
    const auto lease = pool.acquire();
    EXPECT_EQ(lease->number, 0);
  }
  EXPECT_EQ(pool.acquire()->number, -1);
}

TEST_F(ObjectPools, DiscardAnObjectThatCannotBeReset) {
  Pool pool = pool_with({.reset = [](Counted&) { throw std::runtime_error("broken"); }});
  pool.acquire();
  EXPECT_EQ(pool.idle_count(), 0U);
  EXPECT_EQ(alive_, 0);
}

TEST_F(ObjectPools, PassOnWhatTheFactoryThrows) {
  bool fails = true;
  Pool pool([&]() -> Pool::Pointer {
    if (fails) throw std::runtime_error("no more handles");
    return make();
  });
  EXPECT_THROW(pool.acquire(), std::runtime_error);
  fails = false;
  EXPECT_EQ(pool.acquire()->number, 0);
  EXPECT_EQ(pool.idle_count(), 1U);
}

TEST(ObjectPool, UsesTheDefaultConstructorWithoutAFactory) {
  ObjectPool<std::string> pool;
  pool.acquire()->append("text");
  EXPECT_EQ(*pool.acquire(), "text");
}

TEST(ObjectPool, UsesTheDeleterOfItsPointers) {
  using Pool = ObjectPool<int, std::function<void(int*)>>;
  int value = 7;
  int closed = 0;
  {
    Pool pool([&] { return Pool::Pointer(&value, [&](int*) { ++closed; }); });
    EXPECT_EQ(*pool.acquire(), 7);
    EXPECT_EQ(closed, 0);
  }
  EXPECT_EQ(closed, 1);
}

TEST(ObjectPool, CanBeOneOfManyInADeque) {
  std::deque<ObjectPool<int>> pools;
  for (int n = 0; n < 3; ++n) pools.emplace_back([n] { return std::make_unique<int>(n); });
  EXPECT_EQ(*pools[2].acquire(), 2);
}

// Owns a pool of a type that is incomplete here.
class Owner {
 public:
  Owner();
  ~Owner();
  int use();

 private:
  struct Hidden;
  ObjectPool<Hidden> pool_;
};
struct Owner::Hidden {
  int uses = 0;
};
Owner::Owner() : pool_([] { return std::make_unique<Hidden>(); }) {}
Owner::~Owner() = default;
int Owner::use() { return ++pool_.acquire()->uses; }

TEST(ObjectPool, MayHoldAnIncompleteType) {
  Owner owner;
  owner.use();
  EXPECT_EQ(owner.use(), 2);
}

TEST(ObjectPool, LendsAnObjectToOneThreadAtATime) {
  struct Guarded {
    std::atomic<int> users = 0;
    int uses = 0;  // without a lock: the lease is one
  };
  constexpr int kThreads = 8;
  constexpr int kUses = 5000;
  std::atomic<int> made = 0;
  std::atomic<int> collisions = 0;
  std::atomic<int> discarded_uses = 0;
  ObjectPool<Guarded> pool([&] {
    ++made;
    return std::make_unique<Guarded>();
  });
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (int n = 0; n < kUses; ++n) {
        auto lease = pool.acquire();
        if (lease->users.fetch_add(1) != 0) ++collisions;
        ++lease->uses;
        if (n % 7 == 0) std::this_thread::yield();
        lease->users.fetch_sub(1);
        if (n % 500 != t) continue;
        discarded_uses += lease->uses;
        lease.discard();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(collisions, 0);
  int uses = discarded_uses;
  std::vector<ObjectPool<Guarded>::Lease> all;
  for (std::size_t n = pool.idle_count(); n > 0; --n) {
    all.push_back(pool.acquire());
    uses += all.back()->uses;
  }
  EXPECT_EQ(uses, kThreads * kUses);
  EXPECT_LE(all.size(), static_cast<std::size_t>(kThreads));
}

// Any order of acquiring, returning, discarding and failing, against a model: a stack of numbers.
RC_GTEST_PROP(ObjectPoolProperty, IsAStack, ()) {
  const std::size_t max_idle = *rc::gen::inRange<std::size_t>(0, 5);
  int alive = 0;
  int made = 0;
  ObjectPool<Counted> pool([&] { return std::make_unique<Counted>(alive, made++); },
                           {.discard_on_exception = true, .max_idle = max_idle});
  using Lease = ObjectPool<Counted>::Lease;
  std::vector<std::unique_ptr<Lease>> used;
  std::vector<int> idle;
  const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 1000));
  for (const int step : steps) {
    if (step % 2 == 0 || used.empty()) {
      const int expected = idle.empty() ? made : idle.back();
      if (!idle.empty()) idle.pop_back();
      used.push_back(std::make_unique<Lease>(pool.acquire()));
      RC_ASSERT((*used.back())->number == expected);
    } else {
      std::swap(used[static_cast<std::size_t>(step) % used.size()], used.back());
      const int number = (*used.back())->number;
      const int way = step % 5;
      if (way == 0) used.back()->discard();
      try {
        const Lease last = std::move(*used.back());
        used.pop_back();
        if (way == 1) throw std::runtime_error("stop");
      } catch (const std::runtime_error&) {
      }
      if (way > 1 && idle.size() < max_idle) idle.push_back(number);
    }
    RC_ASSERT(pool.idle_count() == idle.size());
    RC_ASSERT(static_cast<std::size_t>(alive) == idle.size() + used.size());
  }
}

}  // namespace
}  // namespace vpe::base
