#include "vpe/core/parallel.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <system_error>

namespace vpe::core {

namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kMaxChunk = 1024;

}  // namespace

struct ThreadPool::Job {
  std::size_t count = 0;
  const std::function<void(std::size_t)>* item = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> made{0};
  std::atomic<std::size_t> lowest_failure{kNone};
  std::mutex failure_mutex;
  std::exception_ptr failure;
  int helpers = 0;  // guarded by the pool's mutex

  bool is_cancelled() const { return cancel != nullptr && cancel->load(std::memory_order_relaxed); }

  void fail(std::size_t index) {
    const std::lock_guard lock(failure_mutex);
    if (index >= lowest_failure.load()) return;
    lowest_failure = index;
    failure = std::current_exception();
  }

  // A range of items nobody has taken yet; smaller towards the end, so that all threads finish together.
  bool take(std::size_t threads, std::size_t& begin, std::size_t& end) {
    begin = next.load();
    do {
      if (begin >= count) return false;
      end = begin + std::clamp((count - begin) / (8 * threads), std::size_t{1}, kMaxChunk);
    } while (!next.compare_exchange_weak(begin, end));
    return true;
  }
};

int default_threads() {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMaxThreads);
}

ThreadPool::ThreadPool(int threads) {
  const int wanted = threads > 0 ? std::min(threads, kMaxThreads) : default_threads();
  workers_.reserve(static_cast<std::size_t>(wanted) - 1);
  for (int n = 1; n < wanted; ++n) {
    try {
      workers_.emplace_back([this] { serve(); });
    } catch (const std::system_error&) {
      break;
    }
  }
}

ThreadPool::~ThreadPool() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  job_posted_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void ThreadPool::serve() {
  std::unique_lock lock(mutex_);
  for (;;) {
    job_posted_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    Job& job = *jobs_.front();
    ++job.helpers;
    lock.unlock();
    work(job);
    lock.lock();
    withdraw(job);
    // Under the lock: the caller of run() cannot destroy the job before this thread has let go of it.
    if (--job.helpers == 0) helper_left_.notify_all();
  }
}

void ThreadPool::work(Job& job) const {
  std::size_t begin = 0;
  std::size_t end = 0;
  while (job.take(workers_.size() + 1, begin, end)) {
    std::size_t index = begin;
    for (; index < end && index < job.lowest_failure.load(std::memory_order_relaxed) && !job.is_cancelled();
         ++index) {
      try {
        (*job.item)(index);
      } catch (...) {
        job.fail(index);
      }
    }
    job.made += index - begin;
    if (index < end) return;
  }
}

void ThreadPool::withdraw(Job& job) { std::erase(jobs_, &job); }

bool ThreadPool::run(std::size_t count, const std::function<void(std::size_t)>& item,
                     const std::atomic<bool>* cancel) {
  Job job;
  job.count = count;
  job.item = &item;
  job.cancel = cancel;
  if (!workers_.empty() && count > 1) {
    {
      const std::lock_guard lock(mutex_);
      jobs_.push_back(&job);
    }
    job_posted_.notify_all();
  }
  work(job);
  {
    std::unique_lock lock(mutex_);
    withdraw(job);
    helper_left_.wait(lock, [&job] { return job.helpers == 0; });
  }
  if (job.failure) std::rethrow_exception(job.failure);
  return job.made == count;
}

bool parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& item,
                  const std::atomic<bool>* cancel) {
  const int wanted = threads > 0 ? threads : default_threads();
  ThreadPool pool(static_cast<int>(std::clamp(count, std::size_t{1}, static_cast<std::size_t>(wanted))));
  return pool.run(count, item, cancel);
}

}  // namespace vpe::core
