// Progress of a build as one rising fraction.
#pragma once

#include <mutex>

#include "paging/build/builder.h"

namespace paging {

// Adds the progress of successive stages up. Members but advance() and report_again() belong to one thread.
class Stages {
 public:
  explicit Stages(const ProgressFunction& report) : report_(report) {}

  bool replaced = false;
  bool patched = false;
  std::int64_t kept() const { return kept_; }
  void add_kept(std::int64_t count) { kept_ += count; }

  // Begins a stage that takes `share` of the whole build. `done` of its `total` items are finished already.
  void begin(const char* name, std::int64_t total, double share, std::int64_t done = 0) {
    done_share_ += share_;
    share_ = share;
    name_ = name;
    total_ = total;
    done_ = done;
    report();
  }

  // Counts one item. May be called from any thread.
  void advance() {
    const std::lock_guard lock(mutex_);
    ++done_;
    report();
  }

  // Reports the same progress again, so that the receiver can interrupt a long item. May be called from any
  // thread.
  void report_again() {
    const std::lock_guard lock(mutex_);
    report();
  }

 private:
  void report() {
    if (!report_) return;
    const double done = total_ > 0 ? static_cast<double>(done_) / static_cast<double>(total_) : 1.0;
    report_({name_, done_, total_, done_share_ + share_ * done, kept_, replaced, patched});
  }

  const ProgressFunction& report_;
  std::mutex mutex_;
  std::int64_t kept_ = 0;
  const char* name_ = "";
  std::int64_t done_ = 0;
  std::int64_t total_ = 0;
  double share_ = 0;
  double done_share_ = 0;
};

}  // namespace paging
