// Where the frames of a film go on their way out: encoding runs beside drawing.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace vpe::app {

// Does jobs, in order, on a thread of its own; at most `depth` wait. An exception there is thrown by the next
// push() or by finish().
class FrameSink {
 public:
  using Job = std::function<void()>;
  explicit FrameSink(std::size_t depth);
  ~FrameSink();  // drops what waits
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;

  void push(Job job);
  void finish();  // waits until all are done

 private:
  void run();
  void throw_if_failed();

  std::size_t depth_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> waiting_;
  bool closed_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace vpe::app
