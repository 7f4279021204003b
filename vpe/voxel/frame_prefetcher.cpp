#include "vpe/voxel/frame_prefetcher.h"

#include <algorithm>
#include <cstdint>
#include <system_error>

#include "vpe/voxel/downsampled_view.h"
#include "vpe/voxel/ray_renderer.h"

namespace vpe::voxel {

namespace {

// At most a quarter of the height grids' budget is filled before an image is drawn.
constexpr std::size_t kGridDivisor = 4;
// The ranges of an image that is cast early take at most an eighth of the whole budget.
constexpr std::size_t kRangeDivisor = 8;
// Strips that an image is read in. The filled budget is checked after each of them.
constexpr int kStrips = 4;
constexpr std::size_t kMostUpcoming = 3;

}  // namespace

struct FramePrefetcher::Job {
  explicit Job(base::ThreadPool& front) : background_pool(base::ThreadPool::Background{front}) {}

  base::ThreadPool reading_pool{1};
  base::ThreadPool background_pool;
  std::optional<core::DrawRequest> next;   // the request to cast
  std::vector<core::DrawRequest> reading;  // the requests whose tiles are read
  std::size_t bytes_before = 0;            // of height grids built before the job
  ColumnWalk::Usage usage;
  State state = State::kReading;  // guarded by the mutex
  bool begun = false;             // guarded by the mutex

  void stop() {
    reading_pool.stop();
    background_pool.stop();
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
  return pool_.threads() > 1 && next.settings.samples <= 1 && !next.settings.ray_fovea &&
         next.settings.ray_mode != core::RayMode::kDiscrete &&
         drawn_pixels(next.view) * sizeof(float) * kRangeDivisor <= budget_;
}

void FramePrefetcher::begin(const core::DrawRequest& request) {
  stop();
  auto job = std::make_shared<Job>(pool_);
  const auto add = [&](core::DrawRequest later) {
    later.paging = {};
    // Smooth ground is not cast by columns.
    if (core::check(later.view).empty() && !smooth_form(later)) job->reading.push_back(std::move(later));
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
      if (!thread_.joinable()) thread_ = std::thread([this] { run_thread(); });
    } catch (const std::system_error&) {
      return;  // without a thread nothing is done early
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

std::optional<ColumnWalk::Usage> FramePrefetcher::take(const core::View& view, const RangeOptions& options,
                                                       std::vector<float>& range_m) {
  {
    std::unique_lock lock(mutex_);
    const auto is_cast = [this] { return job_->state == State::kCast; };
    if (job_ && job_->next && same_view(job_->next->view, view) &&
        range_options(*job_->next, planet_radius_m()) == options &&
        (job_->state == State::kCasting || is_cast())) {
      job_->background_pool.promote();
      changed_.wait(lock, [&] { return !working_; });
      if (is_cast()) {
        range_m.swap(range_m_);
        const ColumnWalk::Usage usage = std::move(job_->usage);
        job_ = nullptr;
        return usage;
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

void FramePrefetcher::run_thread() {
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
      // The frame that needs this image meets the error again.
    }
    lock.lock();
    if (job->state != State::kCast) job->state = State::kIdle;
    bytes_ = sectors_.bytes() + coarse_sectors_.bytes() + range_m_.capacity() * sizeof(float);
    working_ = false;
    changed_.notify_all();
  }
}

void FramePrefetcher::work(Job& job) {
  job.bytes_before = caster_.store().build_totals().bytes;
  for (const core::DrawRequest& later : job.reading) {
    if (!read(job, later, downsampled_view(later.view, kDownsampling))) break;
  }
  if (!job.next || job.reading_pool.is_stopped()) return;
  {
    const std::lock_guard lock(mutex_);
    job.state = State::kCasting;
  }
  range_m_.resize(drawn_pixels(job.next->view));
  job.usage = caster_.cast(job.next->view, range_options(*job.next, planet_radius_m()), job.background_pool,
                           range_m_, sectors_);
  if (job.background_pool.is_stopped()) return;
  const std::lock_guard lock(mutex_);
  job.state = State::kCast;
}

bool FramePrefetcher::read(Job& job, const core::DrawRequest& request, const core::View& view) {
  if (range_options(request, planet_radius_m()).method == RangeOptions::Method::kReference) return false;
  const RangeOptions options = for_hints(range_options(request, planet_radius_m()), kDownsampling);
  const HeightGridStore& store = caster_.store();
  const core::SubRectangle whole = core::drawn_part(view);
  std::vector<float> all_m(drawn_pixels(view));
  std::vector<float> range_m;
  for (int strip = 0; strip < kStrips; ++strip) {
    core::View part = view;
    const int begin = whole.width * strip / kStrips;
    part.part = {whole.x + begin, whole.y, whole.width * (strip + 1) / kStrips - begin, whole.height};
    if (part.part.width == 0) continue;
    range_m.resize(drawn_pixels(part));
    caster_.cast(part, options, job.reading_pool, range_m, coarse_sectors_);
    if (job.reading_pool.is_stopped() ||
        store.build_totals().bytes - job.bytes_before > store.budget_bytes() / kGridDivisor)
      return false;
    for (int row = 0; row < whole.height; ++row)
      std::copy_n(range_m.begin() + std::ptrdiff_t{row} * part.part.width, part.part.width,
                  all_m.begin() + std::ptrdiff_t{row} * whole.width + begin);
  }
  painter_.read_ahead(request, view, all_m, job.reading_pool);
  return !job.reading_pool.is_stopped();
}

}  // namespace vpe::voxel
