#include "vpe/gl/tile_scene.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

namespace vpe::gl {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

constexpr std::size_t kMostUpcoming = 3;
constexpr double kBufferZone = 1.25;       // times the field of view: kept ready round a moving image
constexpr int kFramesForFallbacks = 20;    // where they do not find room
constexpr double kGroundUrgency_px = 1e6;  // without it the near plane is a guess

// The views for which pages are loaded ahead, nearest in time first.
std::vector<core::View> later_views(const core::DrawRequest& request) {
  const auto& upcoming = request.paging.upcoming;
  std::vector<core::View> views(upcoming.begin(), upcoming.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                         upcoming.size(), kMostUpcoming)));
  if (!request.paging.wait) {
    core::View& wider = views.emplace_back(request.view);
    wider.fov_deg = std::min(kBufferZone * wider.fov_deg, core::ViewLimits::kMaxFov_deg);
  }
  return views;
}

}  // namespace

TileScene::TileScene(const std::shared_ptr<const paging::PlanetFile>& planet, const RendererOptions& options)
    : streamer_(planet, options), most_triangles_(most_triangles(options.memory_bytes)) {
  clearance_.emplace(*planet, streamer_);
  cover_.emplace(*planet, streamer_, *clearance_, most_triangles_);
}

void TileScene::change_planet(const std::shared_ptr<const paging::PlanetFile>& planet) {
  cover_.reset();
  clearance_.reset();
  streamer_.change_planet(planet);
  clearance_.emplace(*planet, streamer_);
  cover_.emplace(*planet, streamer_, *clearance_, most_triangles_);
}

void TileScene::prepare(const core::DrawRequest& request) {
  auto start = Clock::now();
  const bool starts_anew = streamer_.begin_frame(request);
  cover_->select(request);
  select_ms_ = ms_since(start);
  start = Clock::now();
  settled_ = true;
  if (request.paging.wait) {
    settled_ = cover_->load_all(request, request.paging.timeout_s);
  } else if (starts_anew && request.paging.change_wait_s > 0) {
    settled_ = cover_->load_all(request, request.paging.change_wait_s);
  } else {
    streamer_.take_loaded(request.paging.upload_ms);
    cover_->use_resident(request);
  }
  cover_->lay_out(request.view);
  request_pages(request);
  clearance_->update(request.view);
  if (settled_) streamer_.drop_other_shadings();
  streamer_.trim();
  load_ms_ = ms_since(start);
}

void TileScene::request_pages(const core::DrawRequest& request) {
  streamer_.begin_requests();
  if (!request.paging.wait) {
    if (streamer_.is_all_readable()) {
      streamer_.request_frame(cover_->wanted(), cover_->not_needed(), cover_->cover(), request.view);
    } else {
      streamer_.request_frame(cover_->readable(request.view), {}, cover_->cover(), request.view);
    }
    const auto request_ground = [&](const core::View& view) {
      if (const auto page = clearance_->needed_page(view)) streamer_.request(*page, kGroundUrgency_px);
    };
    request_ground(request.view);
    if (request.cull_view) request_ground(*request.cull_view);
    if (streamer_.has_requests()) settled_ = false;
  }
  // Where a motion brings a tile that is not there, its nearest ancestor stands in for all below it: the nearer, the
  // less of the image becomes coarser. So an image is not at rest before these are there.
  if (!request.paging.wait && streamer_.has_room_for_coarse(cover_->bytes())) {
    const bool lacks_any = streamer_.request_coarse(cover_->near_fallbacks());
    frames_for_fallbacks_ = lacks_any && settled_ ? frames_for_fallbacks_ + 1 : 0;
    if (frames_for_fallbacks_ > 0 && frames_for_fallbacks_ <= kFramesForFallbacks) settled_ = false;
  }
  if (streamer_.has_room_for_later(cover_->bytes())) {
    lod::Selection later;
    for (const core::View& view : later_views(request)) {
      cover_->select_later(view, later);
      streamer_.request_later(later, view, clearance_->needed_page(view));
    }
  }
  streamer_.send_requests();
}

void TileScene::report(core::DrawResult& result) const {
  result.stats = {};
  result.stats.select_ms = select_ms_;
  result.stats.load_ms = load_ms_;
  result.settled = settled_;
  cover_->report(result);
  streamer_.report(result);
}

}  // namespace vpe::gl
