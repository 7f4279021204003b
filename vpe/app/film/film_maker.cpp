#include "vpe/app/film/film_maker.h"

#include <algorithm>
#include <new>
#include <utility>

#include "paging/planet/planet_user.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/film/frame_sink.h"
#include "vpe/app/picture/contour_ranges.h"

namespace vpe::app {

namespace {

constexpr const char* kIncomplete = "-incomplete";
// Single rays are slower than whole images, so that a frame which is carried to a smaller share takes longer.
constexpr double kMostDrawnShare = 0.25;

bool all_done(std::span<const FilmFrame> frames) {
  return std::all_of(frames.begin(), frames.end(), [](const FilmFrame& f) { return f.is_done(); });
}

}  // namespace

FilmMaker::FilmMaker(const FilmPlan& plan, FilmTarget& target, std::span<FilmFrame> frames, std::int64_t first,
                     const RenderOptions& options, Makers makers, FrameOverlays& overlays)
    : plan_(plan),
      target_(target),
      frames_(frames),
      first_(first),
      options_(options),
      makers_(std::move(makers)),
      overlays_(overlays) {}

void FilmMaker::run(FilmReports& reports, ProgressLine& line) {
  FrameSink sink;
  reports_ = &reports;
  line_ = &line;
  sink_ = &sink;
  const auto size = static_cast<std::size_t>(target_.group_size());
  for (std::size_t begin = 0; begin < frames_.size(); begin += size) {
    const std::size_t end = std::min(begin + size, frames_.size());
    if (all_done(frames_.subspan(begin, end - begin))) {
      for (std::size_t n = begin; n < end; ++n) report_kept(frames_[n]);
    } else {
      make_group(begin, end);
    }
  }
  sink.finish();
}

void FilmMaker::make_group(std::size_t begin, std::size_t end) {
  if (!is_prepared_) target_.prepare();
  is_prepared_ = true;
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

std::size_t FilmMaker::bytes_of(const std::vector<DrawnEye>& eyes) {
  const auto bytes = [](const core::Frame& frame) {
    return frame.colour.size() * sizeof(base::Rgb) + frame.range_m.size() * sizeof(float);
  };
  std::size_t sum = 0;
  for (const DrawnEye& eye : eyes)
    sum += bytes(eye.result.frame) + (eye.contours ? bytes(eye.contours->frame) : 0);
  return sum;
}

core::Renderer& FilmMaker::renderer_for(core::Backend backend) {
  if (renderer_ && backend_ == backend) return *renderer_;
  drawer_.reset();
  renderer_.reset();
  renderer_ = makers_.renderer(backend);
  planet_.reset();
  backend_ = backend;
  return *renderer_;
}

CarriedDrawer& FilmMaker::drawer_for(const PlannedFrame& planned, core::Renderer& renderer) {
  CarriedDrawerOptions options;
  if (planned.carried_gap_px) options.gap_px = *planned.carried_gap_px;
  if (planned.reuse) {
    options.most_added_px = planned.reuse->most_added_px;
    options.most_drawn_share = kMostDrawnShare;
    options.repaints_sky = true;
  }
  const std::pair px(options.gap_px, options.most_added_px);
  if (!drawer_ || drawer_px_ != px) {
    drawer_.reset();
    drawer_ = makers_.carried(renderer, options);
    if (planet_) drawer_->change_planet(planet_);
    drawer_px_ = px;
    key_.reset();
  }
  return *drawer_;
}

void FilmMaker::change_ground(const scripts::GroundState& ground, core::Renderer& renderer) {
  if (!makers_.planet) return;
  const std::shared_ptr<const paging::PlanetFile> planet = makers_.planet(ground);
  if (planet == planet_) return;
  if (planet_ || !ground.empty()) {
    paging::change_planet(renderer, planet);
    if (drawer_) drawer_->change_planet(planet);
    key_.reset();
  }
  planet_ = planet;
}

core::DrawResult FilmMaker::draw_reusing(const PlannedFrame& planned, const core::DrawRequest& request,
                                         core::Renderer& renderer) {
  CarriedDrawer& drawer = drawer_for(planned, renderer);
  const std::int64_t key = planned.reuse->key;
  if (key_ != key || key == planned.index) {
    key_.reset();
    core::DrawRequest first = plan_.at(key).request;
    first.paging = request.paging;
    core::DrawResult drawn = drawer.draw_first(first, planned.reuse->margin_px);
    key_missing_ = drawn.missing;
    if (key != planned.index) keep_failures(drawn);
    key_ = key;
    if (key == planned.index) return drawn;
  }
  core::DrawResult result = drawer.draw_carried(request);
  result.missing.insert(result.missing.end(), key_missing_.begin(), key_missing_.end());
  return result;
}

core::DrawResult FilmMaker::keep_failures(core::DrawResult result) {
  reports_->failures.insert(reports_->failures.end(), result.failures.begin(), result.failures.end());
  require_complete(options_, result);
  return result;
}

std::vector<FilmMaker::DrawnEye> FilmMaker::draw_eyes(std::size_t n, const PlannedFrame& planned,
                                                      core::Renderer& renderer) {
  core::PagingRequest paging = planned.request.paging;
  paging.timeout_s = options_.wait_s;
  if (n + 1 < frames_.size() && !frames_[n + 1].is_done()) {
    const PlannedFrame next = plan_.at(frames_[n + 1].index);
    if (next.backend == planned.backend) paging.upcoming = {next.request.view};
    // The renderer may begin the next request at once; between both eyes that is another one.
    if (next.backend == planned.backend && !next.stereo && !planned.stereo && !next.reuse &&
        next.ground == planned.ground)
      paging.next = std::make_shared<const core::DrawRequest>(next.request);
  }
  std::vector<DrawnEye> eyes;
  CarriedDrawer* const pair = planned.carried_gap_px ? &drawer_for(planned, renderer) : nullptr;
  for (core::DrawRequest& request : planned.requests()) {
    request.paging = paging;
    DrawnEye eye{request, {}, {}};
    eye.result = keep_failures(planned.reuse     ? draw_reusing(planned, request, renderer)
                               : pair == nullptr ? renderer.draw(request)
                               : eyes.empty()    ? pair->draw_first(request)
                                                 : pair->draw_carried(request));
    if (const auto finer = contour_request(request, eye.result))
      eye.contours = keep_failures(renderer.draw(*finer));
    eyes.push_back(std::move(eye));
  }
  return eyes;
}

core::Frame FilmMaker::finish(std::vector<DrawnEye>& eyes, const std::optional<core::StereoPair>& stereo,
                              double time_s) {
  std::vector<core::RgbImage> images;
  for (DrawnEye& eye : eyes) {
    core::Frame& frame = eye.result.frame;
    const FrameGround ground{frame.range_m, eye.result.certificate, std::move(eye.contours)};
    overlay::composite(overlays_.layer(eye.request, ground, time_s), frame.colour);
    images.push_back({frame.width, frame.height, std::move(frame.colour)});
  }
  core::RgbImage image =
      stereo ? core::combine_stereo(images.front(), images.back(), stereo->layout) : std::move(images.front());
  return {image.width, image.height, std::move(image.pixels), {}};
}

bool FilmMaker::draw(std::size_t n) {
  FilmFrame& frame = frames_[n];
  const PlannedFrame planned = plan_.at(frame.index);
  log(frame, planned);
  core::Renderer& renderer = renderer_for(planned.backend);
  const auto eyes = std::make_shared<std::vector<DrawnEye>>();
  try {
    change_ground(planned.ground, renderer);
    *eyes = draw_eyes(n, planned, renderer);
  } catch (const std::bad_alloc&) {
    throw;  // the next frame would not fit either
  } catch (const std::exception& e) {
    frame.state = FilmFrame::State::kFailed;
    frame.error = e.what();
    return false;
  }
  // Of two eyes, the figures are those of the one with the larger bound.
  const DrawnEye& worst = *std::ranges::max_element(
      *eyes, {}, [](const DrawnEye& eye) { return eye.result.certificate.shift_bound_px; });
  frame.figures = {worst.result.stats, worst.result.certificate};
  if (reports_->stats)
    reports_->stats->row(frame.index, frame.time_s, frame.figures.stats, frame.figures.certificate);
  // The next run makes it again.
  const bool is_whole = std::ranges::all_of(*eyes, [](const DrawnEye& eye) {
    return eye.result.missing.empty() && !(eye.contours && !eye.contours->missing.empty());
  });
  if (!is_whole) frame.fingerprint += kIncomplete;
  const std::int64_t group = (first_ + static_cast<std::int64_t>(n)) / target_.group_size();
  sink_->push(
      [this, group, &frame, eyes, stereo = planned.stereo, planet = planet_] {
        if (planet) overlays_.change_planet(planet);
        target_.add(group, frame, finish(*eyes, stereo, frame.time_s));
      },
      bytes_of(*eyes));
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
    reports_->log->frame(frame.time_s, planned.state.pose, planned.state.head, planned.settings,
                         planned.request.interest, planned.drawn_view());
}

void FilmMaker::show(std::size_t done) {
  line_->show("frame " + std::to_string(done) + " of " + std::to_string(frames_.size()),
              static_cast<double>(done) / static_cast<double>(frames_.size()));
}

}  // namespace vpe::app
