// What comes after the image at hand: its tiles are read, and its ranges are cast, by whoever has nothing
// else to do (Cohen-Or 1996, section 3.2, with images in place of columns).
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "vpe/voxel/cast/range_caster.h"
#include "vpe/voxel/paint/image_painter.h"

namespace vpe::voxel {

// How an image is cast, as the settings and the coarsening of a request have it.
RangeOptions range_options(const core::DrawRequest& request);

// Never changes an image: ranges are handed over only for the very view and options that they were cast for,
// and caches keep within their budgets. What goes wrong here is left to the image that meets it again. Called
// by one thread; has one of its own, from the first begin() on.
class FramePrefetcher {
 public:
  // All three must outlive this. Nothing is cast beforehand with a pool of one thread, nor images whose
  // ranges take more than an eighth of `budget_bytes`, nor such with several samples.
  FramePrefetcher(const RangeCaster& caster, const ImagePainter& painter, base::ThreadPool& pool,
                  std::size_t budget_bytes);
  ~FramePrefetcher();  // stops
  FramePrefetcher(const FramePrefetcher&) = delete;
  FramePrefetcher& operator=(const FramePrefetcher&) = delete;

  // Drops what is there and begins on paging.next and paging.upcoming of a request: reads their tiles on the
  // thread of its own, found by rays kThinning pixels apart and as long as they take up no more than a
  // part of the caches that leaves room for the image at hand; then casts paging.next behind the pool's
  // loops.
  void begin(const core::DrawRequest& request);
  static constexpr int kThinning = 32;

  // Drops what is there, and returns when nothing runs any more.
  void stop();

  // Ranges of the view, when they are what begin() was told, with what the cast used; else drops what is there.
  // Waits for a cast that has begun, which then has the whole pool.
  std::optional<ColumnWalk::Used> take(const core::View& view, const RangeOptions& options,
                                       std::vector<float>& range_m);

  // Returns when all is done that can be done ahead.
  void wait();

  std::size_t bytes() const;

 private:
  enum class State : std::uint8_t { kIdle, kReading, kCasting, kCast };
  struct Job;

  void serve();
  void work(Job& job);
  bool read(Job& job, const core::DrawRequest& request, const core::View& view);
  bool can_cast(const core::DrawRequest& next) const;

  const RangeCaster& caster_;
  const ImagePainter& painter_;
  base::ThreadPool& pool_;
  std::size_t budget_;
  // Of the thread of its own, while a job is under way.
  SectorCaster sectors_;
  SectorCaster coarse_sectors_;
  std::vector<float> range_m_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<Job> job_;  // from begin() until it is taken or dropped
  bool working_ = false;      // the thread has a job in hand
  bool closed_ = false;
  std::size_t bytes_ = 0;
  std::thread thread_;
};

}  // namespace vpe::voxel
