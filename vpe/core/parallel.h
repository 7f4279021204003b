// Loops over independent items on several threads.
//
// Items are handed out in ascending order, in shrinking chunks, to whoever is free, so results must not
// depend on who runs what: write each item's result to its own place. No globals: a pool is an object.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace vpe::core {

inline constexpr int kMaxThreads = 256;

// Threads that the machine runs at once, 1 to kMaxThreads.
int default_threads();

class ThreadPool {
 public:
  // `threads` counts the caller of run() as one; <= 0 means default_threads(), more than kMaxThreads means
  // kMaxThreads. Works with fewer when the system refuses to start that many.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return static_cast<int>(workers_.size()) + 1; }

  // Calls item(0) ... item(count - 1), each at most once, and returns when no call runs any more: true when
  // all were made, false when *cancel became true first. When calls throw, no later items are begun, all
  // earlier ones are made, and the exception of the lowest item is rethrown: the same one for any number of
  // threads (unless cancelled). May be called from many threads at once, and from inside an item.
  bool run(std::size_t count, const std::function<void(std::size_t)>& item,
           const std::atomic<bool>* cancel = nullptr);

 private:
  struct Job;

  void serve();
  void work(Job& job) const;
  void withdraw(Job& job);

  std::mutex mutex_;
  std::condition_variable job_posted_;
  std::condition_variable helper_left_;
  std::deque<Job*> jobs_;
  bool stopping_ = false;
  std::vector<std::thread> workers_;
};

// The same with a pool for this one loop, of at most `count` threads.
bool parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& item,
                  const std::atomic<bool>* cancel = nullptr);

}  // namespace vpe::core
