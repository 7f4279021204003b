// Where the frames of a film go: a video, or a folder of pictures. Encoding runs beside drawing.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include "vpe/core/frame.h"

namespace vpe::app {

// Hands frames, in order, to a function on a thread of its own; at most `depth` wait. An exception there is
// thrown by the next push() or by finish().
class FrameSink {
 public:
  using Write = std::function<void(std::int64_t index, const core::Frame&)>;
  FrameSink(Write write, std::size_t depth);
  ~FrameSink();  // drops what waits
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;

  void push(std::int64_t index, core::Frame frame);
  void finish();  // waits until all are written

 private:
  void run();
  void throw_if_failed();

  Write write_;
  std::size_t depth_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::pair<std::int64_t, core::Frame>> waiting_;
  bool closed_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace vpe::app
