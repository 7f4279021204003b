// Whether an image may read tiles while it is drawn.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>

namespace vpe::voxel {

// Says whether tiles may be read now, on the threads that draw an image. Copies share their state. Any thread may
// call any member. Once it says no it never says yes again.
class ReadingRule {
 public:
  static ReadingRule always() { return ReadingRule(std::numeric_limits<double>::infinity(), 1); }
  static ReadingRule never() { return ReadingRule(0, 1); }
  // Allows reading until `threads` threads have spent `seconds` each with it, on average. A read that has begun is
  // not interrupted.
  ReadingRule(double seconds, int threads)
      : limit_ns_(seconds < kLongest_s ? static_cast<std::int64_t>(1e9 * seconds * threads)
                                       : std::numeric_limits<std::int64_t>::max()),
        spent_ns_(std::make_shared<std::atomic<std::int64_t>>(0)) {}

  bool may_read() const { return *spent_ns_ < limit_ns_; }

  // Returns what read() returns, and counts the time that it takes.
  template <class Read>
  auto timed(const Read& read) const {
    const Timer timer(*spent_ns_);
    return read();
  }

 private:
  static constexpr double kLongest_s = 1e6;
  class Timer {
   public:
    explicit Timer(std::atomic<std::int64_t>& sum) : sum_(sum) {}
    ~Timer() {
      sum_ += std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start_)
                  .count();
    }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

   private:
    std::atomic<std::int64_t>& sum_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  };

  std::int64_t limit_ns_;
  std::shared_ptr<std::atomic<std::int64_t>> spent_ns_;
};

}  // namespace vpe::voxel
