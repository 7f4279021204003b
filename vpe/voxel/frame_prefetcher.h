// Prefetches the coming frames of a film: reads the tiles of upcoming views, and casts the ranges of the next
// frame on worker threads that are idle (the overlap of frames of Cohen-Or 1996, section 3.2, with whole images
// in place of columns).
//
// It stands beside the pipeline RangeCaster -> ImagePainter (ray_renderer.h): it runs the first of them early.
//
// Typical usage, by a renderer that draws `request` and then request.paging.next:
//   std::optional<ColumnWalk::Usage> usage = prefetcher.take(request.view, range_options(request, radius_m), range_m);
//   if (!usage) usage = caster.cast(request.view, range_options(request, radius_m), pool, range_m);
//   prefetcher.begin(request);  // works on the next frame while this one is painted
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

// Never changes an image: ranges are handed over only for the very view and options that they were cast for,
// and caches keep within their budgets. Errors met here are dropped; the frame that needs the damaged tile
// meets and reports them again.
//
// One thread may call the members. The first begin() starts a thread of the prefetcher's own.
class FramePrefetcher {
 public:
  // `caster`, `painter` and `pool` must outlive this. `budget_bytes` limits the ranges of the next frame to an
  // eighth of it. Smaller: large frames are not cast early; larger: more memory for them. Frames with several
  // samples or rays.fovea, and pools of one thread, only get their tiles read.
  FramePrefetcher(const RangeCaster& caster, const ImagePainter& painter, base::ThreadPool& pool,
                  std::size_t budget_bytes);
  // Stops all work first.
  ~FramePrefetcher();
  FramePrefetcher(const FramePrefetcher&) = delete;
  FramePrefetcher& operator=(const FramePrefetcher&) = delete;

  // Drops earlier work and starts on paging.next and paging.upcoming of the request. Reads their tiles on the
  // prefetcher's thread, found by rays kDownsampling pixels apart, until they fill the part of the caches that
  // leaves room for the current frame. Then casts paging.next in the background of the pool. Ignores the paging
  // of the next request itself.
  void begin(const core::DrawRequest& request);
  static constexpr int kDownsampling = 32;

  // Drops all work, and returns when nothing runs any more.
  void stop();

  // Moves the ranges into `range_m` and returns the cast's usage of tiles, if begin() was given this view and
  // these options and the cast has begun; gives an unfinished cast the whole pool and waits for it. Otherwise
  // drops all work and returns nullopt.
  std::optional<ColumnWalk::Usage> take(const core::View& view, const RangeOptions& options,
                                        std::vector<float>& range_m);

  // Waits until all work that can be done early is done.
  void wait();

  // Returns the bytes of ranges and samples that are held.
  std::size_t bytes() const;

 private:
  enum class State : std::uint8_t { kIdle, kReading, kCasting, kCast };
  struct Job;

  void run_thread();
  void work(Job& job);
  // Reads the tiles of a view. Returns false if no further views are to be read.
  bool read(Job& job, const core::DrawRequest& request, const core::View& view);
  bool can_cast(const core::DrawRequest& next) const;
  double planet_radius_m() const { return caster_.surface().planet_radius_m(); }

  const RangeCaster& caster_;
  const ImagePainter& painter_;
  base::ThreadPool& pool_;
  std::size_t budget_;
  // Used by the prefetcher's thread alone while a job runs.
  SectorCaster sectors_;
  SectorCaster coarse_sectors_;
  std::vector<float> range_m_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::shared_ptr<Job> job_;  // from begin() until it is taken or dropped
  bool working_ = false;      // the thread works on a job
  bool closed_ = false;
  std::size_t bytes_ = 0;
  std::thread thread_;
};

}  // namespace vpe::voxel
