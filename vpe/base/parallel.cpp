#include "vpe/base/parallel.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <limits>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "vpe/base/cpu_limits.h"

namespace vpe::base {

namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kMaxChunk = 1024;

}  // namespace

struct ThreadPool::Job {
  const ThreadPool* pool = nullptr;
  std::size_t count = 0;
  const std::function<void(std::size_t)>* item = nullptr;
  const std::atomic<bool>* cancel = nullptr;
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> made{0};
  std::atomic<std::size_t> lowest_failure{kNone};
  std::mutex failure_mutex;
  std::exception_ptr failure;
  int helpers = 0;  // guarded by the crew's mutex

  bool is_cancelled() const {
    return (cancel != nullptr && cancel->load(std::memory_order_relaxed)) ||
           pool->stopped_.load(std::memory_order_relaxed);
  }

  // Returns true if no further item will begin.
  bool has_ended() const { return next.load() >= count || lowest_failure.load() != kNone || is_cancelled(); }

  void fail(std::size_t index) {
    const std::lock_guard lock(failure_mutex);
    if (index >= lowest_failure.load()) return;
    lowest_failure = index;
    failure = std::current_exception();
  }

  // Takes the next range of items. Ranges shrink towards the end, so that all threads finish together. Returns
  // false if none is left.
  bool take(std::size_t threads, std::size_t& begin, std::size_t& end) {
    const std::size_t largest = pool->yields_to_foreground() ? 1 : kMaxChunk;
    begin = next.load();
    do {
      if (begin >= count) return false;
      end = begin + std::clamp((count - begin) / (8 * threads), std::size_t{1}, largest);
    } while (!next.compare_exchange_weak(begin, end));
    return true;
  }
};

// The threads of a foreground pool, with the loops of it and of its background pools.
struct ThreadPool::Crew {
  std::mutex mutex;
  std::condition_variable job_posted;
  std::condition_variable changed;  // a helper has left a job, or a pool was promoted or stopped
  std::deque<Job*> jobs;
  std::deque<Job*> background_jobs;
  std::atomic<std::size_t> job_count{0};  // size of `jobs`; written under the mutex
  bool stopping = false;
  std::vector<std::thread> workers;

  explicit Crew(int threads) {
    workers.reserve(static_cast<std::size_t>(threads) - 1);
    for (int n = 1; n < threads; ++n) {
      try {
        workers.emplace_back([this] { serve(); });
      } catch (const std::system_error&) {
        break;
      }
    }
  }

  void dismiss() {
    {
      const std::lock_guard lock(mutex);
      stopping = true;
    }
    job_posted.notify_all();
    for (std::thread& worker : workers) worker.join();
  }

  // Expect a locked mutex.
  void post(Job& job) {
    jobs.push_back(&job);
    job_count = jobs.size();
  }
  void withdraw(Job& job) {
    std::erase(jobs, &job);
    std::erase(background_jobs, &job);
    job_count = jobs.size();
  }
  Job* next_job() const {
    if (!jobs.empty()) return jobs.front();
    return background_jobs.empty() ? nullptr : background_jobs.front();
  }

  void serve() {
    std::unique_lock lock(mutex);
    for (;;) {
      job_posted.wait(lock, [this] { return stopping || next_job() != nullptr; });
      Job* const job = next_job();
      if (job == nullptr) return;
      ++job->helpers;
      lock.unlock();
      const bool ended = work(*job);
      lock.lock();
      if (ended) withdraw(*job);
      // Under the lock: the caller of run() cannot destroy the job before this thread has let go of it.
      if (--job->helpers == 0) changed.notify_all();
    }
  }

  // Works until the job has ended; returns true then. Returns false if a background job has to give way first.
  bool work(Job& job) const {
    std::size_t begin = 0;
    std::size_t end = 0;
    while (job.take(workers.size() + 1, begin, end)) {
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
      if (index < end) return true;
      if (job_count.load() > 0 && job.pool->yields_to_foreground()) return job.has_ended();
    }
    return true;
  }

  // Waits until idle threads have done the job, or until its pool is promoted.
  void wait_for_idle_threads(Job& job, const ThreadPool& pool) {
    std::unique_lock lock(mutex);
    if (pool.yields_to_foreground() && !job.is_cancelled()) {
      background_jobs.push_back(&job);
      job_posted.notify_all();
      changed.wait(lock, [&] { return !pool.yields_to_foreground() || (job.helpers == 0 && job.has_ended()); });
    }
    withdraw(job);
    if (job.has_ended()) return;
    post(job);
    lock.unlock();
    job_posted.notify_all();
  }
};

int default_threads() { return std::min(cpu_limits().threads(), kMaxThreads); }

ThreadPool::ThreadPool(int threads)
    : crew_(std::make_shared<Crew>(threads > 0 ? std::min(threads, kMaxThreads) : default_threads())) {}

ThreadPool::ThreadPool(Background background) : crew_(background.foreground.crew_), is_background_(true) {}

ThreadPool::~ThreadPool() {
  if (!is_background_) crew_->dismiss();
}

int ThreadPool::threads() const { return static_cast<int>(crew_->workers.size()) + 1; }

void ThreadPool::promote() {
  {
    const std::lock_guard lock(crew_->mutex);
    promoted_ = true;
  }
  crew_->changed.notify_all();
}

void ThreadPool::stop() {
  {
    const std::lock_guard lock(crew_->mutex);
    stopped_ = true;
  }
  crew_->changed.notify_all();
}

bool ThreadPool::run(std::size_t count, const std::function<void(std::size_t)>& item,
                     const std::atomic<bool>* cancel) {
  Job job;
  job.pool = this;
  job.count = count;
  job.item = &item;
  job.cancel = cancel;
  if (yields_to_foreground() && count > 0) {
    crew_->wait_for_idle_threads(job, *this);
  } else if (!crew_->workers.empty() && count > 1) {
    {
      const std::lock_guard lock(crew_->mutex);
      crew_->post(job);
    }
    crew_->job_posted.notify_all();
  }
  crew_->work(job);
  {
    std::unique_lock lock(crew_->mutex);
    crew_->withdraw(job);
    crew_->changed.wait(lock, [&job] { return job.helpers == 0; });
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

}  // namespace vpe::base
