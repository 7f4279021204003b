#include "vpe/app/frame_sink.h"

namespace vpe::app {

FrameSink::FrameSink(Write write, std::size_t depth)
    : write_(std::move(write)), depth_(depth), thread_([this] { run(); }) {}

FrameSink::~FrameSink() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    waiting_.clear();
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void FrameSink::push(std::int64_t index, core::Frame frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return waiting_.size() < depth_ || error_; });
  throw_if_failed();
  waiting_.emplace_back(index, std::move(frame));
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
    std::pair<std::int64_t, core::Frame> item;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return !waiting_.empty() || closed_; });
      if (waiting_.empty()) return;
      item = std::move(waiting_.front());
      waiting_.pop_front();
    }
    changed_.notify_all();
    try {
      write_(item.first, item.second);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
      changed_.notify_all();
      return;
    }
  }
}

}  // namespace vpe::app
