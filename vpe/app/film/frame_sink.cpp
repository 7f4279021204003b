#include "vpe/app/film/frame_sink.h"

#include <utility>

namespace vpe::app {

FrameSink::FrameSink() : thread_([this] { run(); }) {}

FrameSink::~FrameSink() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool FrameSink::has_room(std::size_t bytes) const {
  return waiting_.size() < kFewestWaiting || waiting_bytes_ + bytes <= kMostWaitingBytes;
}

void FrameSink::push(Job job, std::size_t bytes) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this, bytes] { return has_room(bytes) || error_; });
  throw_if_failed();
  waiting_.push_back({std::move(job), bytes});
  waiting_bytes_ += bytes;
  changed_.notify_all();
}

void FrameSink::finish() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  thread_.join();
  throw_if_failed();
}

void FrameSink::throw_if_failed() {
  if (error_) std::rethrow_exception(error_);
}

void FrameSink::run() {
  for (;;) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return !waiting_.empty() || closed_; });
      if (waiting_.empty()) return;
      job = std::move(waiting_.front().job);
      waiting_bytes_ -= waiting_.front().bytes;
      waiting_.pop_front();
    }
    changed_.notify_all();
    try {
      job();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
      changed_.notify_all();
      return;
    }
  }
}

}  // namespace vpe::app
