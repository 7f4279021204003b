#include "vpe/voxel/frame_prefetcher.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <system_error>

#include "vpe/voxel/downsampled_view.h"

namespace vpe::voxel {

namespace {

// Of the lattices' budget: what may be made ahead of one image.
constexpr std::size_t kGridPart = 4;
// Of the whole budget: the ranges of an image that is cast beforehand.
constexpr std::size_t kRangePart = 8;
// An image is read in so many strips, to look after each of them at what that took.
constexpr int kStrips = 4;
constexpr std::size_t kMostUpcoming = 3;

bool same_options(const RangeOptions& a, const RangeOptions& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return bits(a.exaggeration) == bits(b.exaggeration) && bits(a.cell_px) == bits(b.cell_px) &&
         a.method == b.method;
}

std::size_t pixels_of(const core::View& view) {
  const glm::ivec2 size = core::drawn_size(view);
  return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
}

}  // namespace

RangeOptions range_options(const core::DrawRequest& request) {
  RangeOptions options;
  options.exaggeration = request.settings.exaggeration;
  if (request.settings.ray_mode == core::RayMode::kPlain) options.method = RangeOptions::Method::kPlain;
  // What is given up for speed are cells.
  if (request.settings.ray_mode == core::RayMode::kMultires || request.coarsening > 1)
    options.cell_px = request.settings.ray_cell_px * std::max(1.0, request.coarsening);
  return options;
}

struct FramePrefetcher::Job {
  explicit Job(base::ThreadPool& front) : behind(base::ThreadPool::Behind{front}) {}

  base::ThreadPool alone{1};
  base::ThreadPool behind;
  std::optional<core::DrawRequest> next;  // to be cast
  std::vector<core::DrawRequest> reading;
  std::size_t made_before = 0;  // bytes of lattices
  ColumnWalk::Used used;
  State state = State::kReading;  // guarded by the mutex
  bool begun = false;             // guarded by the mutex

  void stop() {
    alone.stop();
    behind.stop();
  }
};

FramePrefetcher::FramePrefetcher(const RangeCaster& caster, const ImagePainter& painter, base::ThreadPool& pool,
                                 std::size_t budget_bytes)
    : caster_(caster), painter_(painter), pool_(pool), budget_(budget_bytes) {}

FramePrefetcher::~FramePrefetcher() {
  stop();
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool FramePrefetcher::can_cast(const core::DrawRequest& next) const {
  return pool_.threads() > 1 && next.settings.samples <= 1 &&
         pixels_of(next.view) * sizeof(float) * kRangePart <= budget_;
}

void FramePrefetcher::begin(const core::DrawRequest& request) {
  stop();
  auto job = std::make_shared<Job>(pool_);
  const auto add = [&](core::DrawRequest later) {
    later.paging = {};
    if (core::check(later.view).empty()) job->reading.push_back(std::move(later));
  };
  const core::PagingRequest& paging = request.paging;
  if (paging.next) {
    add(*paging.next);
    if (!job->reading.empty() && can_cast(*paging.next)) job->next = job->reading.front();
  }
  for (std::size_t n = 0; n < std::min(paging.upcoming.size(), kMostUpcoming); ++n) {
    if (paging.next && same_view(paging.upcoming[n], paging.next->view)) continue;
    core::DrawRequest later = request;
    later.view = paging.upcoming[n];
    add(std::move(later));
  }
  if (job->reading.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    try {
      if (!thread_.joinable()) thread_ = std::thread([this] { serve(); });
    } catch (const std::system_error&) {
      return;  // everything works without
    }
    job_ = std::move(job);
  }
  changed_.notify_all();
}

void FramePrefetcher::stop() {
  std::unique_lock lock(mutex_);
  if (job_) job_->stop();
  changed_.wait(lock, [this] { return !working_; });
  job_ = nullptr;
}

void FramePrefetcher::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return !job_ || (job_->begun && !working_); });
}

std::optional<ColumnWalk::Used> FramePrefetcher::take(const core::View& view, const RangeOptions& options,
                                                      std::vector<float>& range_m) {
  {
    std::unique_lock lock(mutex_);
    const auto is_cast = [this] { return job_->state == State::kCast; };
    if (job_ && job_->next && same_view(job_->next->view, view) &&
        same_options(range_options(*job_->next), options) && (job_->state == State::kCasting || is_cast())) {
      job_->behind.hurry();
      changed_.wait(lock, [&] { return !working_; });
      if (is_cast()) {
        range_m.swap(range_m_);
        const ColumnWalk::Used used = std::move(job_->used);
        job_ = nullptr;
        return used;
      }
    }
  }
  stop();
  return std::nullopt;
}

std::size_t FramePrefetcher::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

void FramePrefetcher::serve() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return closed_ || (job_ && !job_->begun); });
    if (closed_) return;
    const std::shared_ptr<Job> job = job_;
    job->begun = true;
    working_ = true;
    lock.unlock();
    try {
      work(*job);
    } catch (...) {
      // Whoever draws this image meets it again.
    }
    lock.lock();
    if (job->state != State::kCast) job->state = State::kIdle;
    bytes_ = sectors_.bytes() + coarse_sectors_.bytes() + range_m_.capacity() * sizeof(float);
    working_ = false;
    changed_.notify_all();
  }
}

void FramePrefetcher::work(Job& job) {
  job.made_before = caster_.store().made().bytes;
  for (const core::DrawRequest& later : job.reading) {
    if (!read(job, later, downsampled_view(later.view, kThinning))) break;
  }
  if (!job.next || job.alone.is_stopped()) return;
  {
    const std::lock_guard lock(mutex_);
    job.state = State::kCasting;
  }
  range_m_.resize(pixels_of(job.next->view));
  job.used = caster_.cast(job.next->view, range_options(*job.next), job.behind, range_m_, sectors_);
  if (job.behind.is_stopped()) return;
  const std::lock_guard lock(mutex_);
  job.state = State::kCast;
}

// False when no more is to be read.
bool FramePrefetcher::read(Job& job, const core::DrawRequest& request, const core::View& view) {
  RangeOptions options = range_options(request);
  if (options.method != RangeOptions::Method::kColumns) return false;
  options.cell_px /= kThinning;
  const HeightGridStore& store = caster_.store();
  const core::SubRectangle whole = core::drawn_part(view);
  std::vector<float> all_m(pixels_of(view));
  std::vector<float> range_m;
  for (int strip = 0; strip < kStrips; ++strip) {
    core::View part = view;
    const int begin = whole.width * strip / kStrips;
    part.part = {whole.x + begin, whole.y, whole.width * (strip + 1) / kStrips - begin, whole.height};
    if (part.part.width == 0) continue;
    range_m.resize(pixels_of(part));
    caster_.cast(part, options, job.alone, range_m, coarse_sectors_);
    if (job.alone.is_stopped() || store.made().bytes - job.made_before > store.budget_bytes() / kGridPart)
      return false;
    for (int row = 0; row < whole.height; ++row)
      std::copy_n(range_m.begin() + std::ptrdiff_t{row} * part.part.width, part.part.width,
                  all_m.begin() + std::ptrdiff_t{row} * whole.width + begin);
  }
  painter_.read_ahead(request, view, all_m, job.alone);
  return !job.alone.is_stopped();
}

}  // namespace vpe::voxel
