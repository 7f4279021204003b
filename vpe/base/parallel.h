// Loops over independent items on several threads.
//
// Items are handed out in ascending order, in shrinking chunks, to whoever is free, so results must not
// depend on who runs what: write each item's result to its own place. No globals: a pool is an object.
//
// A pool behind another has no threads of its own. Its loops get those of the other that find nothing to do in
// loops of theirs, an item at a time, so they hold up the other's by one item at most.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>

namespace vpe::base {

inline constexpr int kMaxThreads = 256;

// Threads that the machine runs at once, 1 to kMaxThreads.
int default_threads();

class ThreadPool {
 public:
  // `threads` counts the caller of run() as one; <= 0 means default_threads(), more than kMaxThreads means
  // kMaxThreads. Works with fewer when the system refuses to start that many.
  explicit ThreadPool(int threads);
  // Behind `front`, which must outlive this.
  struct Behind {
    ThreadPool& front;
  };
  explicit ThreadPool(Behind behind);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const;

  // Calls item(0) ... item(count - 1), each at most once, and returns when no call runs any more: true when
  // all were made, false when *cancel became true first, or after stop(). When calls throw, no later items are
  // begun, all earlier ones are made, and the exception of the lowest item is rethrown: the same one for any
  // number of threads (unless cancelled). May be called from many threads at once, and from inside an item.
  // Behind another pool the caller only waits; where that has one thread alone, until hurry().
  bool run(std::size_t count, const std::function<void(std::size_t)>& item,
           const std::atomic<bool>* cancel = nullptr);

  // From now on loops are run like those of the front pool, also those under way. Any thread.
  void hurry();
  // No items are begun any more; loops under way return when those in hand are done. Any thread.
  void stop();
  bool is_stopped() const { return stopped_; }

 private:
  struct Job;
  struct Crew;

  bool waits_behind() const { return is_behind_ && !hurried_; }

  std::shared_ptr<Crew> crew_;
  bool is_behind_ = false;
  std::atomic<bool> hurried_{false};
  std::atomic<bool> stopped_{false};
};

// The same with a pool for this one loop, of at most `count` threads.
bool parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& item,
                  const std::atomic<bool>* cancel = nullptr);

}  // namespace vpe::base
