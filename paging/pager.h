// Loads pages on threads of its own, the most urgent first.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace paging {

struct PagerCounts {
  std::size_t wanted = 0;  // in the last request list, not started
  std::size_t loading = 0;
  std::size_t loaded = 0;  // not taken yet
  std::size_t bytes = 0;   // of what is loaded
  std::size_t failed = 0;  // ever
};

// Loads pages in the background for one owner. A page is in one of these states, or in none (absent): wanted
// -> loading -> loaded -> (taken by the owner); or failed. Each call to want() replaces the request list.
// Requests no longer listed are dropped unless already started. A free loader starts the most urgent request,
// and waits while `limit_bytes` of loaded pages are not taken yet (one page may exceed the limit). A load that
// throws makes its page failed, with the exception's message, until the pager ends; std::bad_alloc is thrown
// again by take() and wait().
//
// Thread rule: one owner; any number of threads call `load` at once, never under the pager's lock. The
// destructor waits for loads that have started. Where the system refuses threads, wait() and take() load
// themselves.
//
// Typical usage:
//   Pager<TileKey, Page, TileKeyHash> pager(load, 2, 64 << 20);
//   for (;;) {  // each frame
//     pager.want(requests);
//     for (auto& loaded : pager.take(8 << 20)) upload(loaded.key, std::move(loaded.value));
//   }
template <typename Key, typename Value, typename Hash>
class Pager {
 public:
  struct Want {
    Key key;
    double urgency = 0;  // larger is sooner; equal ones load in the order of the list
  };
  struct Loaded {
    Key key;
    Value value;
    std::size_t bytes = 0;
  };
  using Load = std::function<std::pair<Value, std::size_t>(const Key&)>;  // value, bytes
  using Clock = std::chrono::steady_clock;

  Pager(Load load, int threads, std::size_t limit_bytes) : load_(std::move(load)), limit_(limit_bytes) {
    try {
      for (int n = 0; n < threads; ++n) threads_.emplace_back([this] { serve(); });
    } catch (const std::system_error&) {
      // The threads that exist are enough.
    }
  }
  ~Pager() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    work_.notify_all();
    for (std::thread& t : threads_) t.join();
  }
  Pager(const Pager&) = delete;
  Pager& operator=(const Pager&) = delete;

  // Replaces the request list.
  void want(std::vector<Want> wants) {
    std::stable_sort(wants.begin(), wants.end(),
                     [](const Want& a, const Want& b) { return a.urgency > b.urgency; });
    {
      const std::lock_guard lock(mutex_);
      wants_ = std::move(wants);
      next_ = 0;
      skip_known();
    }
    work_.notify_all();
  }

  // Returns loaded pages in the order of their completion, up to max_bytes (at least one page if there is any).
  std::vector<Loaded> take(std::size_t max_bytes) {
    std::vector<Loaded> out;
    {
      std::unique_lock lock(mutex_);
      if (threads_.empty()) load_one(lock);
      rethrow();
      std::size_t count = 0;
      std::size_t bytes = 0;
      while (count < loaded_.size() && (count == 0 || bytes + loaded_[count].bytes <= max_bytes)) {
        bytes += loaded_[count++].bytes;
      }
      for (std::size_t n = 0; n < count; ++n) {
        started_.erase(loaded_[n].key);
        out.push_back(std::move(loaded_[n]));
      }
      loaded_.erase(loaded_.begin(), loaded_.begin() + static_cast<std::ptrdiff_t>(count));
      bytes_ -= bytes;
      // A taken page belongs to the owner, who does not request it again while it is kept.
      drop_taken(out);
    }
    work_.notify_all();
    return out;
  }

  enum class Outcome { kSomething, kNothingLeft, kTimeout };

  // Waits until a page can be taken or has failed since the last call, nothing is loading or wanted any more,
  // or the deadline has passed.
  Outcome wait(Clock::time_point deadline) {
    std::unique_lock lock(mutex_);
    for (;;) {
      rethrow();
      if (!loaded_.empty() || has_new_failure_) {
        has_new_failure_ = false;
        return Outcome::kSomething;
      }
      if (loading_ == 0 && next_ >= wants_.size()) return Outcome::kNothingLeft;
      if (threads_.empty()) {
        if (Clock::now() >= deadline) return Outcome::kTimeout;
        load_one(lock);
      } else if (deadline == Clock::time_point::max()) {
        done_.wait(lock);
      } else if (done_.wait_until(lock, deadline) == std::cv_status::timeout && loaded_.empty() &&
                 !has_new_failure_) {
        return Outcome::kTimeout;
      }
    }
  }

  // Returns why a page could not be loaded, or nullopt when it has not failed.
  std::optional<std::string> failure(const Key& key) const {
    const std::lock_guard lock(mutex_);
    const auto at = failed_.find(key);
    return at == failed_.end() ? std::nullopt : std::optional(at->second);
  }
  bool any_failed() const {
    const std::lock_guard lock(mutex_);
    return !failed_.empty();
  }

  PagerCounts counts() const {
    const std::lock_guard lock(mutex_);
    return {wants_.size() - std::min(next_, wants_.size()), loading_, loaded_.size(), bytes_, failed_.size()};
  }

 private:
  bool known(const Key& key) const { return started_.count(key) != 0 || failed_.count(key) != 0; }
  void skip_known() {
    while (next_ < wants_.size() && known(wants_[next_].key)) ++next_;
  }
  bool can_start() const { return next_ < wants_.size() && bytes_ < limit_; }

  void drop_taken(const std::vector<Loaded>& taken) {
    if (taken.empty()) return;
    std::unordered_set<Key, Hash> keys;
    for (const Loaded& l : taken) keys.insert(l.key);
    const auto rest =
        std::remove_if(wants_.begin() + static_cast<std::ptrdiff_t>(std::min(next_, wants_.size())),
                       wants_.end(), [&](const Want& w) { return keys.count(w.key) != 0; });
    wants_.erase(rest, wants_.end());
    skip_known();
  }

  void rethrow() {
    if (fatal_) std::rethrow_exception(std::exchange(fatal_, nullptr));
  }

  // Loads the most urgent page; the lock is held before and after.
  void load_one(std::unique_lock<std::mutex>& lock) {
    skip_known();
    if (!can_start()) return;
    const Key key = wants_[next_++].key;
    started_.insert(key);
    skip_known();
    ++loading_;
    lock.unlock();
    std::optional<std::pair<Value, std::size_t>> value;
    std::string problem;
    std::exception_ptr fatal;
    try {
      value = load_(key);
    } catch (const std::bad_alloc&) {
      fatal = std::current_exception();
    } catch (const std::exception& e) {
      problem = e.what();
    }
    lock.lock();
    --loading_;
    if (value) {
      bytes_ += value->second;
      loaded_.push_back({key, std::move(value->first), value->second});
    } else {
      started_.erase(key);
      if (fatal) {
        fatal_ = fatal;
      } else {
        failed_.emplace(key, std::move(problem));
        has_new_failure_ = true;
      }
    }
    done_.notify_all();
  }

  void serve() {
    std::unique_lock lock(mutex_);
    for (;;) {
      work_.wait(lock, [this] { return stopping_ || (skip_known(), can_start()); });
      if (stopping_) return;
      load_one(lock);
    }
  }

  Load load_;
  std::size_t limit_;
  mutable std::mutex mutex_;
  std::condition_variable work_;
  std::condition_variable done_;
  std::vector<Want> wants_;
  std::size_t next_ = 0;                   // the first one that has not been started
  std::unordered_set<Key, Hash> started_;  // loading or loaded
  std::vector<Loaded> loaded_;
  std::unordered_map<Key, std::string, Hash> failed_;
  std::exception_ptr fatal_;
  std::size_t bytes_ = 0;
  std::size_t loading_ = 0;
  bool has_new_failure_ = false;
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace paging
