#include "vpe/app/film/film_plan.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "paging/planet/planet_file.h"
#include "relief/spec_line.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/picture/carried_drawer.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/scene_digests.h"
#include "vpe/app/picture/view_palette.h"
#include "vpe/base/number.h"
#include "vpe/core/margin.h"
#include "vpe/overlay/overlay.h"

namespace vpe::app {

scripts::Flight read_flight(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in)
    throw std::runtime_error(path + ": cannot open the flight: " + std::strerror(errno) + "; check the name");
  std::ostringstream text;
  text << in.rdbuf();
  scripts::ParsedFlight parsed = scripts::parse_flight(text.str(), path);
  if (parsed.flight) return *parsed.flight;
  std::string all;
  for (const scripts::FlightError& e : parsed.errors)
    all += (all.empty() ? "" : "\n     ") + scripts::to_string(e);
  throw std::runtime_error(all);
}

FrameRange parse_frames(const std::string& text, std::int64_t count) {
  if (text.empty()) return {0, count - 1, 1};
  std::string_view rest = text;
  std::optional<std::int64_t> step = 1;
  if (const std::size_t x = rest.find('x'); x != std::string_view::npos) {
    step = base::parse_integer(rest.substr(x + 1));
    rest = rest.substr(0, x);
  }
  const std::size_t dash = rest.find('-');
  const std::optional<std::int64_t> first = base::parse_integer(rest.substr(0, dash));
  const std::optional<std::int64_t> last =
      dash == std::string_view::npos ? first : base::parse_integer(rest.substr(dash + 1));
  if (!first || !last || !step || *step < 1 || *first < 0 || *last < *first || *last >= count) {
    throw UsageError("--frames '" + text + "': expected A-B or A-BxN within 0-" + std::to_string(count - 1));
  }
  return {*first, *last, *step};
}

FilmPlan::FilmPlan(RenderBasis basis, scripts::FlightView view, scripts::Path path, core::Settings base,
                   std::vector<core::InterestRegion> interest, ViewOptions views)
    : basis_(std::move(basis)),
      view_(view),
      path_(std::move(path)),
      base_(std::move(base)),
      interest_(std::move(interest)),
      views_(std::move(views)),
      start_(path_.at(0.0).pose) {
  if (!basis_.scenes) basis_.scenes = std::make_shared<SceneDigests>();
}

std::vector<core::DrawRequest> PlannedFrame::requests() const {
  if (!stereo) return {request};
  std::vector<core::DrawRequest> eyes{request, request};
  const std::optional<double> convergence_m = core::convergence_at(stereo->convergence_m);
  eyes[0].view = core::eye_view(request.view, -0.5 * stereo->eye_base_m, convergence_m);
  eyes[1].view = core::eye_view(request.view, 0.5 * stereo->eye_base_m, convergence_m);
  return eyes;
}

scripts::ViewState PlannedFrame::drawn_view() const {
  scripts::ViewState view = state.view;
  view.size.reset();
  if (view.backend) view.backend = core::drawn_by(backend);
  if (stereo) view.eye_base_m = stereo->eye_base_m;
  return view;
}

std::optional<core::StereoPair> FilmPlan::stereo_of(const scripts::FlightState& state, double time_s) const {
  const scripts::ViewState& view = state.view;
  if (!view.eyes || !view.eyes->layout) return std::nullopt;
  double base_m = view.eye_base_m.value_or(0);
  if (!(base_m > 0)) {
    const mars::LonLat place{state.pose.lon_deg, state.pose.lat_deg};
    const double ground_m =
        views_.terrain_height_m ? views_.terrain_height_m(place, path_.exaggeration(time_s)) : 0;
    base_m = core::base_for_height_m(state.pose.alt_m - (std::isfinite(ground_m) ? ground_m : 0));
  }
  return core::StereoPair{*view.eyes->layout, base_m, view.convergence_m.value_or(0)};
}

PlannedFrame FilmPlan::alone(std::int64_t frame) const {
  PlannedFrame out;
  out.index = frame;
  out.time_s = scripts::frame_time(view_.fps, frame);
  out.state = path_.at(out.time_s);
  const scripts::ViewState& view = out.state.view;
  const auto named = views_.named && view.backend ? core::named_backend(*view.backend) : std::nullopt;
  out.names_backend = named.has_value();
  out.backend = named.value_or(basis_.backend);
  out.stereo = stereo_of(out.state, out.time_s);
  out.settings = named ? *views_.named : base_;
  path_.apply_settings(out.time_s, out.settings);
  for (const FilmPalette& palette : palettes_) {
    const core::SettingsValues& values = out.settings.values();
    if (core::has_auto_ends(values) && values.colour == palette.colour) take_ends(out.settings, palette.ends);
  }
  core::DrawRequest& request = out.request;
  request.view.camera = out.state.camera;
  const auto has = [&](core::StereoLayout layout) { return out.stereo && out.stereo->layout == layout; };
  request.view.width = has(core::StereoLayout::kSideBySide) ? view_.width / 2 : view_.width;
  request.view.height = has(core::StereoLayout::kOverUnder) ? view_.height / 2 : view_.height;
  request.view.fov_deg = view.fov_deg.value_or(view_.fov_deg);
  request.settings = out.settings.values();
  request.time_s = out.time_s;
  request.tracks = path_.tracks();
  out.ground = path_.ground_at(out.time_s);
  request.interest = interest_;
  for (const scripts::InterestCommand& command : path_.interests(out.time_s)) {
    request.interest.push_back(command.region);
  }
  // The sun does not move: azimuth and elevation, or the hour, hold at the ground below the flight's start.
  request.sun = sun_for(request.settings, start_);
  request.want_range = overlay::needs_range(request.settings);
  if (out.stereo && views_.carried_gap_px && why_not_carried(request).empty())
    out.carried_gap_px = views_.carried_gap_px;
  return out;
}

core::View FilmPlan::view_of(const scripts::FlightState& state) const {
  core::View view;
  view.camera = state.camera;
  view.width = view_.width;
  view.height = view_.height;
  view.fov_deg = state.view.fov_deg.value_or(view_.fov_deg);
  return view;
}

glm::ivec2 FilmPlan::margin_of(std::int64_t key) const {
  // A wider margin would take longer than the strips that it saves.
  constexpr int kMostShare = 8;
  constexpr double kNearest = 2;  // heights above the ground
  const auto state_at = [&](std::int64_t frame) { return path_.at(scripts::frame_time(view_.fps, frame)); };
  const scripts::FlightState first = state_at(key);
  std::vector<core::View> others;
  for (std::int64_t n = key + 1; n < key + kKeyFrames; ++n) others.push_back(view_of(state_at(n)));
  const mars::LonLat place{first.pose.lon_deg, first.pose.lat_deg};
  const double exaggeration = path_.exaggeration(scripts::frame_time(view_.fps, key));
  double ground_m = 0;
  try {
    if (views_.terrain_height_m) ground_m = views_.terrain_height_m(place, exaggeration);
  } catch (const paging::PlanetError&) {
    // Frames that need the damaged tile report it themselves.
  }
  const double height_m = first.pose.alt_m - (std::isfinite(ground_m) ? ground_m : 0);
  return core::margin_for(view_of(first), others, kNearest * std::max(height_m, 1.0),
                          {view_.width / kMostShare, view_.height / kMostShare});
}

std::optional<PlannedFrame::Reuse> FilmPlan::reuse_of(const PlannedFrame& planned) const {
  const auto can_be_carried = [this](const PlannedFrame& one) {
    // What moves by itself is not where it was in the key frame.
    const std::string& scene = one.request.settings.scene;
    if (!scene.empty() && (one.request.tracks || basis_.scenes->of(scene).has_paths)) return false;
    return !one.stereo && one.request.settings.haze_visibility_m == 0 && why_not_carried(one.request).empty();
  };
  if (!views_.reuse_px || !can_be_carried(planned)) return std::nullopt;
  PlannedFrame::Reuse reuse{planned.index - planned.index % kKeyFrames, *views_.reuse_px, {}};
  reuse.margin_px = margin_of(reuse.key);
  if (reuse.key == planned.index) return reuse;
  const PlannedFrame key = alone(reuse.key);
  const core::DrawRequest& a = key.request;
  const core::DrawRequest& b = planned.request;
  const bool is_alike = can_be_carried(key) && key.backend == planned.backend && a.settings == b.settings &&
                        a.sun == b.sun && a.interest == b.interest && a.want_range == b.want_range &&
                        key.ground == planned.ground;
  return is_alike ? std::optional(reuse) : std::nullopt;
}

PlannedFrame FilmPlan::at(std::int64_t frame) const {
  PlannedFrame planned = alone(frame);
  planned.reuse = reuse_of(planned);
  return planned;
}

// Names do not count, contents do.
std::vector<std::string> FilmPlan::ground_lines(const scripts::GroundState& ground) const {
  std::vector<std::string> lines;
  for (const scripts::PatchState& patch : ground.patches) {
    const auto stamp = views_.ground_files.find(patch.file);
    lines.push_back((stamp == views_.ground_files.end() ? patch.file : stamp->second) + " " +
                    base::format_number(patch.mix));
  }
  for (const relief::ReliefSpec& one : ground.reliefs) lines.push_back(relief::to_line(one));
  return lines;
}

std::string FilmPlan::fingerprint(const PlannedFrame& planned) const {
  RenderBasis basis = basis_;
  basis.backend = planned.backend;
  FingerprintOrigin origin{planned.stereo, planned.carried_gap_px, {}, ground_lines(planned.ground)};
  FingerprintOrigin key;  // the ground is that of the frame
  key.ground = origin.ground;
  if (planned.reuse)
    origin.reuse = {fingerprint_of(basis, alone(planned.reuse->key).request, planned.settings, 0, key),
                    planned.reuse->most_added_px, planned.reuse->margin_px};
  return fingerprint_of(basis, planned.request, planned.settings, planned.time_s, origin);
}

std::vector<FilmFrame> FilmPlan::frames(const FrameRange& range, std::int64_t begin, std::int64_t end) const {
  std::vector<FilmFrame> out;
  out.reserve(static_cast<std::size_t>(end - begin));
  for (std::int64_t n = begin; n < end; ++n) {
    const PlannedFrame planned = at(range.frame(n));
    FilmFrame frame;
    frame.index = range.frame(n);
    frame.time_s = planned.time_s;
    frame.fingerprint = fingerprint(planned);
    frame.ground = scripts::lines_of(planned.ground);
    out.push_back(std::move(frame));
  }
  return out;
}

}  // namespace vpe::app
