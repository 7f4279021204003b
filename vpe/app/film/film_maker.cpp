#include "vpe/app/film/film_maker.h"

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

#include "vpe/app/cli/interrupt.h"
#include "vpe/app/film/frame_sink.h"

namespace vpe::app {

namespace {

constexpr std::size_t kWaitingFrames = 3;
constexpr const char* kIncomplete = "-incomplete";

bool all_there(std::span<const FilmFrame> frames) {
  return std::all_of(frames.begin(), frames.end(), [](const FilmFrame& f) { return f.is_there(); });
}

}  // namespace

FilmMaker::FilmMaker(const FilmPlan& plan, FilmTarget& target, std::span<FilmFrame> frames, std::int64_t first,
                     const RenderOptions& options, MakeRenderer make_renderer, FrameOverlays& overlays)
    : plan_(plan),
      target_(target),
      frames_(frames),
      first_(first),
      options_(options),
      make_renderer_(std::move(make_renderer)),
      overlays_(overlays) {}

void FilmMaker::run(FilmReports& reports, ProgressLine& line) {
  FrameSink sink(kWaitingFrames);
  reports_ = &reports;
  line_ = &line;
  sink_ = &sink;
  const auto size = static_cast<std::size_t>(target_.group_size());
  for (std::size_t begin = 0; begin < frames_.size(); begin += size) {
    const std::size_t end = std::min(begin + size, frames_.size());
    if (all_there(frames_.subspan(begin, end - begin))) {
      for (std::size_t n = begin; n < end; ++n) report_kept(frames_[n]);
    } else {
      make_group(begin, end);
    }
  }
  sink.finish();
}

void FilmMaker::make_group(std::size_t begin, std::size_t end) {
  if (!renderer_) {
    target_.prepare();
    renderer_ = make_renderer_();
  }
  const std::int64_t group = (first_ + static_cast<std::int64_t>(begin)) / target_.group_size();
  bool whole = true;
  for (std::size_t n = begin; n < end; ++n) {
    InterruptGuard::check();
    if (whole) {
      whole = draw(n);
    } else {
      log(frames_[n], plan_.at(frames_[n].index));
    }
    show(n + 1);
  }
  const auto frames = frames_.subspan(begin, end - begin);
  if (whole) {
    sink_->push([this, group, frames] { target_.end_group(group, frames); });
  } else {
    sink_->push([this] { target_.abandon(); });
  }
}

bool FilmMaker::draw(std::size_t n) {
  FilmFrame& frame = frames_[n];
  const PlannedFrame planned = plan_.at(frame.index);
  log(frame, planned);
  core::DrawResult result;
  core::DrawRequest request = planned.request;
  request.paging.timeout_s = options_.wait_s;
  if (n + 1 < frames_.size() && !frames_[n + 1].is_there()) {
    request.paging.next = std::make_shared<const core::DrawRequest>(plan_.at(frames_[n + 1].index).request);
    request.paging.upcoming = {request.paging.next->view};
  }
  try {
    result = renderer_->draw(request);
    reports_->failures.insert(reports_->failures.end(), result.failures.begin(), result.failures.end());
    require_complete(options_, result);
  } catch (const std::bad_alloc&) {
    throw;  // the next frame would not fit either
  } catch (const std::exception& e) {
    frame.state = FilmFrame::State::kFailed;
    frame.trouble = e.what();
    return false;
  }
  if (reports_->stats) reports_->stats->row(frame.index, frame.time_s, result.stats, result.certificate);
  frame.figures = {result.stats, result.certificate};
  // Made again by the next run.
  if (!result.missing.empty()) frame.fingerprint += kIncomplete;
  const auto image = std::make_shared<core::Frame>(std::move(result.frame));
  const std::int64_t group = (first_ + static_cast<std::int64_t>(n)) / target_.group_size();
  sink_->push([this, group, &frame, image, request = planned.request] {
    overlay::composite(overlays_.layer(request, *image, frame.figures.certificate, frame.time_s),
                       image->colour);
    target_.add(group, frame, *image);
  });
  return true;
}

void FilmMaker::report_kept(const FilmFrame& frame) {
  InterruptGuard::check();
  if (reports_->log) log(frame, plan_.at(frame.index));
  if (reports_->stats)
    reports_->stats->row(frame.index, frame.time_s, frame.figures.stats, frame.figures.certificate);
}

void FilmMaker::log(const FilmFrame& frame, const PlannedFrame& planned) {
  if (reports_->log)
    reports_->log->frame(frame.time_s, planned.state.pose, planned.state.look, planned.settings,
                         planned.request.interest);
}

void FilmMaker::show(std::size_t done) {
  line_->show("frame " + std::to_string(done) + " of " + std::to_string(frames_.size()),
              static_cast<double>(done) / static_cast<double>(frames_.size()));
}

}  // namespace vpe::app
