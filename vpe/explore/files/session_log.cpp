#include "vpe/explore/files/session_log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vpe/base/number.h"
#include "vpe/core/view.h"
#include "vpe/explore/files/text_lines.h"

namespace vpe::explore {

namespace {

constexpr double kOpposite_rad = 1e-6;  // as scripts::Path

bool in_full_circle(double angle_deg) { return std::abs(angle_deg) <= 360; }  // false for NaN

// Leaves angles that the format can hold unchanged, so that they replay bit by bit.
double angle(double angle_deg) {
  return in_full_circle(angle_deg) ? angle_deg : mars::normalize_lon_deg(angle_deg);
}

bool fits(const scripts::ViewState& view) {
  using Limits = core::ViewLimits;
  const auto side_fits = [](int side) { return side >= 1 && side <= Limits::kMaxSide_px; };
  return (!view.fov_deg || (*view.fov_deg >= Limits::kMinFov_deg && *view.fov_deg <= Limits::kMaxFov_deg)) &&
         (!view.size || (side_fits(view.size->width) && side_fits(view.size->height))) &&
         (!view.eye_base_m ||
          (*view.eye_base_m >= 0 && *view.eye_base_m <= scripts::FlightLimits::kMaxEyeBase_m)) &&
         (!view.convergence_m ||
          (*view.convergence_m >= 0 && *view.convergence_m <= scripts::FlightLimits::kMaxConvergence_m));
}

bool fits(const SessionLog::Frame& f) {
  using Limits = scripts::FlightLimits;
  return f.time_s >= 0 && f.time_s <= Limits::kMaxTime_s && in_full_circle(f.pose.lon_deg) &&
         std::abs(f.pose.lat_deg) <= 90 && f.pose.alt_m >= Limits::kMinAlt_m &&
         f.pose.alt_m <= Limits::kMaxAlt_m && in_full_circle(f.pose.yaw_deg) &&
         std::abs(f.pose.pitch_deg) <= 90 && in_full_circle(f.pose.roll_deg) &&
         in_full_circle(f.look.yaw_deg) && std::abs(f.look.pitch_deg) <= 90 &&
         in_full_circle(f.look.roll_deg) && fits(f.view);
}

// Compares what playback interpolates.
bool same_view(const SessionLog::Frame& a, const SessionLog::Frame& b) {
  const auto pose = [](const mars::Pose& p) {
    return std::array{p.lon_deg, p.lat_deg, p.alt_m, p.yaw_deg, p.pitch_deg, p.roll_deg};
  };
  const auto look = [](const mars::HeadAngles& l) { return std::array{l.yaw_deg, l.pitch_deg, l.roll_deg}; };
  return pose(a.pose) == pose(b.pose) && look(a.look) == look(b.look) && a.view.fov_deg == b.view.fov_deg;
}

// Fills members without a value from the view before.
void continue_view(scripts::ViewState& view, const scripts::ViewState& before) {
  const auto take = [](auto& now, const auto& old) {
    if (!now) now = old;
  };
  take(view.fov_deg, before.fov_deg);
  take(view.size, before.size);
  take(view.backend, before.backend);
  take(view.eyes, before.eyes);
  take(view.eye_base_m, before.eye_base_m);
  take(view.convergence_m, before.convergence_m);
}

double just_after(double time_s) { return std::nextafter(time_s, std::numeric_limits<double>::infinity()); }

}  // namespace

SessionLog::SessionLog(const std::filesystem::path& path, const scripts::FlightView& view, double radius_m,
                       const SessionLogOptions& options)
    : log_(path, view, scripts::LineFile::Mode::kLive, scripts::FlightVersion::k1_1),
      radius_m_(radius_m),
      options_(options) {}

// Flights add regions and cannot remove them, so a removed region is cancelled by its opposite.
void SessionLog::update_regions(std::span<const core::InterestRegion> regions) {
  std::vector<core::InterestRegion> fresh;
  std::vector<core::InterestRegion> gone = active_;
  for (core::InterestRegion region : regions) {
    if (!in_full_circle(region.lon_deg)) region.lon_deg = mars::normalize_lon_deg(region.lon_deg);
    const auto known = std::find(gone.begin(), gone.end(), region);
    if (known == gone.end()) {
      fresh.push_back(region);
    } else {
      gone.erase(known);
    }
  }
  for (core::InterestRegion& region : gone) {
    active_.erase(std::find(active_.begin(), active_.end(), region));
    region.levels = -region.levels;
    written_.push_back(region);
  }
  active_.insert(active_.end(), fresh.begin(), fresh.end());
  written_.insert(written_.end(), fresh.begin(), fresh.end());
}

void SessionLog::write(const Frame& frame, const core::Settings& settings) {
  log_.frame(frame.time_s, frame.pose, frame.look, settings, written_, frame.view);
  last_ = frame;
  settings_ = settings;
}

std::optional<double> SessionLog::frame(const Frame& seen, const core::Settings& settings,
                                        std::span<const core::InterestRegion> regions) {
  Frame frame = seen;
  for (double* value : {&frame.pose.lon_deg, &frame.pose.yaw_deg, &frame.pose.roll_deg, &frame.look.yaw_deg,
                        &frame.look.roll_deg}) {
    *value = angle(*value);
  }
  if (last_) {
    frame.time_s = std::max(frame.time_s, just_after(last_->time_s));
    continue_view(frame.view, last_->view);
  }
  if (!fits(frame) || !(radius_m_ + frame.pose.alt_m > 0)) return std::nullopt;
  if (last_ && frame.time_s - last_->time_s > options_.gap_s && !same_view(*last_, frame)) {
    Frame hold = *last_;
    hold.time_s = std::max(frame.time_s - options_.lead_s, just_after(last_->time_s));
    write(hold, settings_);
  }
  if (last_) {
    const mars::LonLat from{last_->pose.lon_deg, last_->pose.lat_deg};
    const mars::LonLat to{frame.pose.lon_deg, frame.pose.lat_deg};
    if (mars::distance_rad(from, to) > mars::kPi - kOpposite_rad) {
      // No unique great circle leads to the other side of the planet, so a place between defines one.
      Frame between = *last_;
      between.time_s = std::max(0.5 * (last_->time_s + frame.time_s), just_after(last_->time_s));
      frame.time_s = std::max(frame.time_s, just_after(between.time_s));
      const mars::LonLat place = mars::destination(from, 90, 0.5 * mars::kPi);
      between.pose.lon_deg = place.lon_deg;
      between.pose.lat_deg = place.lat_deg;
      write(between, settings_);
    }
  }
  update_regions(regions);
  write(frame, settings);
  return frame.time_s;
}

void SessionLog::enter_overlook(double time_s, const std::string& hotspot,
                                const std::filesystem::path& panorama) {
  note(time_s, "overlook in " + as_word(hotspot) + " " + as_word(panorama.string()));
}

void SessionLog::leave_overlook(double time_s) { note(time_s, "overlook out"); }

void SessionLog::note(double time_s, std::string_view text) {
  log_.note("at " + base::format_number(time_s) + " " + std::string(text));
}

void SessionLog::end(double time_s) {
  const double last_s = last_ ? last_->time_s : 0;
  log_.end(std::clamp(time_s, last_s, std::max(last_s, scripts::FlightLimits::kMaxTime_s)));
}

std::vector<OverlookStep> overlook_steps(std::string_view log) {
  std::vector<OverlookStep> steps;
  for (const std::string_view line : lines_of(log)) {
    if (!line.starts_with("# at ")) continue;
    std::string fault;
    const std::vector<std::string> words = split_words(line.substr(2), fault);
    if (words.size() < 4 || words[2] != "overlook") continue;
    const std::optional<double> time_s = base::parse_number(words[1]);
    if (!time_s) continue;
    if (words[3] == "out" && words.size() == 4) steps.push_back({*time_s, false, "", ""});
    if (words[3] == "in" && words.size() == 6) steps.push_back({*time_s, true, words[4], words[5]});
  }
  return steps;
}

}  // namespace vpe::explore
