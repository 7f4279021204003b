// Loops over independent items on several threads.
//
// Items are handed out in ascending order, in shrinking chunks, to the threads that are free. Results must not
// depend on which thread runs which item: write each item's result to its own element. There are no global
// variables: a pool is an object.
//
// Typical usage:
//   ThreadPool pool(0);  // one thread for each core
//   std::vector<double> sums(rows.size());
//   pool.run(rows.size(), [&](std::size_t n) { sums[n] = sum_of(rows[n]); });
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>

namespace vpe::base {

inline constexpr int kMaxThreads = 256;

// Returns the number of threads that can run at once by cpu_limits(), 1 to kMaxThreads.
int default_threads();

// Runs loops on a fixed set of threads.
//
// A background pool has no threads. It runs on idle threads of its foreground pool, one item at a time, so it
// delays foreground work by at most one item. Use it for work that may turn out to be in vain, such as
// prefetching.
class ThreadPool {
 public:
  // `threads` includes the caller of run(). Values <= 0 mean default_threads(), values above kMaxThreads mean
  // kMaxThreads. Works with fewer threads if the system refuses to start that many.
  explicit ThreadPool(int threads);

  // Makes a background pool of `foreground`, which must outlive it.
  struct Background {
    ThreadPool& foreground;
  };
  explicit ThreadPool(Background background);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const;

  // Calls item(0) ... item(count - 1), each at most once, and returns after the last call has ended. Returns
  // true if all were called, false if *cancel became true or stop() was called first.
  //
  // If calls throw, no later items begin, all earlier ones run, and the exception of the lowest item is
  // rethrown: the same one for any number of threads, unless the loop is cancelled. Any number of threads may
  // call run() at once, also from inside an item. In a background pool the caller only waits; if the foreground
  // pool has a single thread, it waits until promote().
  bool run(std::size_t count, const std::function<void(std::size_t)>& item,
           const std::atomic<bool>* cancel = nullptr);

  // Makes a background pool run its loops like those of the foreground pool, including the loops in progress.
  // Any thread may call it.
  void promote();

  // Prevents any further item from beginning. Loops in progress return when their current items end. Any thread
  // may call it.
  void stop();
  bool is_stopped() const { return stopped_; }

 private:
  struct Job;
  struct Crew;

  bool yields_to_foreground() const { return is_background_ && !promoted_; }

  std::shared_ptr<Crew> crew_;
  bool is_background_ = false;
  std::atomic<bool> promoted_{false};
  std::atomic<bool> stopped_{false};
};

// Does the same as ThreadPool::run() with a pool of at most `count` threads for this one loop.
bool parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& item,
                  const std::atomic<bool>* cancel = nullptr);

}  // namespace vpe::base
