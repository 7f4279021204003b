// Work on finished frames beside the drawing of later ones.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace vpe::app {

// Runs jobs in order on a thread of its own. So many wait that their thread may stop for a while, as when a segment of a video
// is closed, without stopping the one that draws: kFewestWaiting of any size, and more while they hold kMostWaitingBytes at
// most. An exception of a job comes out of the next push() or of finish(); jobs after it do not run.
//
// Typical usage:
//   FrameSink sink;
//   for (Frame& frame : film) sink.push([frame = draw(frame)] { encode(frame); }, bytes_of(frame));
//   sink.finish();
class FrameSink {
 public:
  using Job = std::function<void()>;
  static constexpr std::size_t kFewestWaiting = 3;
  static constexpr std::size_t kMostWaitingBytes = std::size_t{16} << 20;

  FrameSink();
  ~FrameSink();  // drops waiting jobs
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;

  // Waits until there is room. `bytes` is what the job holds.
  void push(Job job, std::size_t bytes = 0);
  // Waits until all jobs are done. Nothing can be pushed afterwards.
  void finish();

 private:
  struct Waiting {
    Job job;
    std::size_t bytes;
  };
  void run();
  bool has_room(std::size_t bytes) const;
  void throw_if_failed();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Waiting> waiting_;
  std::size_t waiting_bytes_ = 0;
  bool closed_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace vpe::app
