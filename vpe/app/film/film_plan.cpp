#include "vpe/app/film/film_plan.h"

#include <utility>

#include "vpe/app/picture/image_options.h"
#include "vpe/overlay/overlay.h"

namespace vpe::app {

FilmPlan::FilmPlan(FilmBasis basis, scripts::FlightView view, scripts::Path path, core::Settings base,
                   std::vector<core::InterestRegion> interest)
    : basis_(std::move(basis)),
      view_(view),
      path_(std::move(path)),
      base_(std::move(base)),
      interest_(std::move(interest)),
      start_(path_.at(0.0).pose) {}

PlannedFrame FilmPlan::at(std::int64_t frame) const {
  PlannedFrame out;
  out.time_s = scripts::frame_time(view_.fps, frame);
  out.settings = base_;
  path_.apply_settings(out.time_s, out.settings);
  out.state = path_.at(out.time_s);
  core::DrawRequest& request = out.request;
  request.view.camera = out.state.camera;
  request.view.width = view_.width;
  request.view.height = view_.height;
  request.view.fov_deg = view_.fov_deg;
  request.settings = out.settings.values();
  request.interest = interest_;
  for (const scripts::Interest& i : path_.interests(out.time_s)) {
    request.interest.push_back({i.lon_deg, i.lat_deg, i.radius_m, i.levels});
  }
  // The sun stands still: azimuth and elevation, or the hour, are those at the ground below the flight's start.
  request.sun = sun_for(request.settings, start_);
  request.want_range = overlay::needs_range(request.settings);
  return out;
}

std::vector<FilmFrame> FilmPlan::frames(const FrameRange& range, std::int64_t begin, std::int64_t end) const {
  std::vector<FilmFrame> out;
  out.reserve(static_cast<std::size_t>(end - begin));
  for (std::int64_t n = begin; n < end; ++n) {
    const PlannedFrame planned = at(range.frame(n));
    FilmFrame frame;
    frame.index = range.frame(n);
    frame.time_s = planned.time_s;
    frame.fingerprint = fingerprint_of(basis_, planned.request, planned.settings, planned.time_s);
    out.push_back(std::move(frame));
  }
  return out;
}

}  // namespace vpe::app
