// A thread that runs the newest of many requests, so that a user interface never waits for slow work.
//
// Typical usage:
//   LatestWorker<Request, Image> worker([painter = Painter()](Request r) mutable { return painter.paint(r); },
//                                       [] { wake_the_event_loop(); });
//   worker.request(request);                       // each time something changes
//   if (auto image = worker.take()) show(*image);  // in each iteration of the event loop
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>

namespace vpe::base {

// Keeps at most one request waiting, at most one running and at most one result. A request that has not begun
// is replaced by a later one; one that has begun is finished. One thread at a time may call the members.
template <class Request, class Result>
class LatestWorker {
 public:
  // Calls `work` on the worker's thread for each request that begins. It returns a Result, or an optional one:
  // nullopt leaves the result of an earlier request in place. `work` may be move-only. It is destroyed on the
  // worker's thread together with what it holds, which matters for graphics contexts.
  //
  // Calls `notify`, unless it is empty, on the worker's thread after each finished request, with or without a
  // result. `notify` must not throw and must not destroy the worker.
  template <class Work>
  explicit LatestWorker(Work work, std::function<void()> notify = {})
      : notify_(std::move(notify)),
        thread_([this, work = std::move(work)]() mutable { run(std::move(work)); }) {
    static_assert(std::is_invocable_r_v<std::optional<Result>, Work&, Request>);
  }

  // Waits for the request that runs; drops the one that waits.
  ~LatestWorker() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  LatestWorker(const LatestWorker&) = delete;
  LatestWorker& operator=(const LatestWorker&) = delete;

  // Replaces the waiting request, if any.
  void request(Request request) {
    {
      const std::lock_guard lock(mutex_);
      waiting_.emplace(std::move(request));
    }
    changed_.notify_all();
  }

  // Drops the waiting request and the result that was not taken. Does not affect the request that runs: its
  // result can be taken when it is finished.
  void forget() {
    const std::lock_guard lock(mutex_);
    waiting_.reset();
    finished_.reset();
    error_ = nullptr;
  }

  // Returns true if nothing waits, nothing runs and there is no result to take.
  bool is_idle() const {
    const std::lock_guard lock(mutex_);
    return !is_pending() && !is_finished();
  }

  // Returns the latest result, once. Waits for at most `wait_s` seconds while there is none and a request waits
  // or runs. If the latest request with an outcome ended with an exception, rethrows that instead, also once.
  std::optional<Result> take(double wait_s = 0) {
    std::unique_lock lock(mutex_);
    if (wait_s > 0) {
      // Longer waits could overflow the clock's type.
      const std::chrono::duration<double> wait(std::min(wait_s, 1e6));
      changed_.wait_for(lock, wait, [this] { return is_finished() || !is_pending(); });
    }
    if (error_ != nullptr) std::rethrow_exception(std::exchange(error_, nullptr));
    return std::exchange(finished_, std::nullopt);
  }

 private:
  bool is_pending() const { return waiting_.has_value() || is_busy_; }
  bool is_finished() const { return finished_.has_value() || error_ != nullptr; }

  template <class Work>
  void run(Work work) {
    for (;;) {
      std::optional<Request> next;
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return waiting_ || ends_; });
        if (ends_) return;
        next.swap(waiting_);
        is_busy_ = true;
      }
      std::optional<Result> result;
      std::exception_ptr error;
      try {
        result = work(std::move(*next));
      } catch (...) {
        error = std::current_exception();
      }
      next.reset();
      {
        const std::lock_guard lock(mutex_);
        is_busy_ = false;
        if (error != nullptr) {
          finished_.reset();
          error_ = std::move(error);
        } else if (result) {
          finished_.swap(result);  // the former result is destroyed outside the lock
          error_ = nullptr;
        }
      }
      changed_.notify_all();
      if (notify_) notify_();
    }
  }

  std::function<void()> notify_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Request> waiting_;
  std::optional<Result> finished_;  // at most one of these two is set
  std::exception_ptr error_;
  bool is_busy_ = false;
  bool ends_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace vpe::base
