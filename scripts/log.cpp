#include "scripts/log.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace scripts {

LineFile::LineFile(std::filesystem::path path, Mode mode)
    : path_(std::move(path)), live_(nullptr, &std::fclose) {
  if (mode == Mode::kWhole) {
    whole_ = std::make_unique<vpe::base::OutputFile>(path_);
    return;
  }
  live_.reset(std::fopen(path_.c_str(), "wb"));
  if (live_ == nullptr) fail("open for writing");
}

void LineFile::write(std::string_view lines) {
  if (whole_ != nullptr) {
    whole_->write({reinterpret_cast<const std::uint8_t*>(lines.data()), lines.size()});
  } else if (std::fwrite(lines.data(), 1, lines.size(), live_.get()) != lines.size() ||
             std::fflush(live_.get()) != 0) {
    fail("write");
  }
}

void LineFile::close() {
  if (whole_ != nullptr) {
    whole_->commit();
    whole_.reset();
  } else if (live_ != nullptr && std::fclose(live_.release()) != 0) {
    fail("close");
  }
}

void LineFile::fail(const char* operation) const {
  throw std::runtime_error(path_.string() + ": cannot " + operation + ": " + std::strerror(errno) +
                           "; check the folder, its permissions and the space left");
}

FlightLog::FlightLog(const std::filesystem::path& path, const FlightView& view, LineFile::Mode mode,
                     FlightVersion version)
    : file_(path, mode), version_(version) {
  file_.write(version_line(version) + "# log of vpe\n" + to_line(view));
}

// Returns the lines for a view: what has changed, and always the field of view. Playback interpolates between fields
// of view, so one that changes is first held up to the last frame.
std::string FlightLog::view_lines(double time_s, const ViewState& view) {
  ViewState changed;
  const auto take = [](const auto& seen, auto& written, auto& to) {
    if (!seen || seen == written) return;
    to = written = seen;
  };
  const std::optional<double> before_deg = view_.view.fov_deg;
  take(view.fov_deg, view_.view.fov_deg, changed.fov_deg);
  take(view.size, view_.view.size, changed.size);
  take(view.backend, view_.view.backend, changed.backend);
  take(view.eyes, view_.view.eyes, changed.eyes);
  take(view.eye_base_m, view_.view.eye_base_m, changed.eye_base_m);
  take(view.convergence_m, view_.view.convergence_m, changed.convergence_m);
  if (changed == ViewState{}) return {};
  if (version_ == FlightVersion::k1) throw std::logic_error("a log of version 1 has no views");
  std::string lines;
  if (changed.fov_deg && before_deg && view_.time_s != *last_frame_s_) {
    ViewState held;
    held.fov_deg = before_deg;
    lines = to_line(ViewCommand{*last_frame_s_, held});
  }
  changed.fov_deg = view_.view.fov_deg;
  view_.time_s = last_frame_s_ ? time_s : 0;
  return lines + to_line(ViewCommand{view_.time_s, changed});
}

void FlightLog::frame(double time_s, const mars::Pose& pose, const mars::HeadAngles& head,
                      const vpe::core::Settings& settings, std::span<const vpe::core::InterestRegion> interest,
                      const ViewState& view) {
  const HeadCommand turned{time_s, head.yaw_deg, head.pitch_deg, head.roll_deg};
  const bool moved =
      head.yaw_deg != head_.yaw_deg || head.pitch_deg != head_.pitch_deg || head.roll_deg != head_.roll_deg;
  std::string lines;
  if (moved && last_frame_s_ && head_.time_s != *last_frame_s_) {
    // Playback interpolates between look lines: hold the head still up to the frame before it moved.
    head_.time_s = *last_frame_s_;
    lines += to_line(head_);
  }
  lines += waiting_lines(time_s);
  lines += view_lines(time_s, view);
  lines += to_line(Waypoint{.time_s = time_s,
                            .lon_deg = pose.lon_deg,
                            .lat_deg = pose.lat_deg,
                            .up_m = pose.alt_m,
                            .yaw_deg = pose.yaw_deg,
                            .pitch_deg = pose.pitch_deg,
                            .roll_deg = pose.roll_deg});
  if (moved) {
    head_ = turned;
    lines += to_line(head_);
  }
  if (settings != settings_) {
    for (const vpe::core::SettingInfo& info : vpe::core::Settings::list()) {
      const std::string text = *settings.get(info.key);
      if (text != settings_.get(info.key)) lines += to_line(SetCommand{time_s, std::string(info.key), text});
    }
    settings_ = settings;
  }
  for (; regions_ < interest.size(); ++regions_) {
    lines += to_line(InterestCommand{time_s, interest[regions_]});
  }
  file_.write(lines);
  last_frame_s_ = time_s;
}

void FlightLog::objects(std::span<const ObjectCommand> commands) {
  if (!commands.empty() && version_ < FlightVersion::k1_2)
    throw std::logic_error("a log of this version has no objects");
  objects_.assign(commands.begin(), commands.end());
}

void FlightLog::ground(std::span<const ReliefCommand> reliefs, std::span<const PatchCommand> patches) {
  if (!(reliefs.empty() && patches.empty()) && version_ < FlightVersion::k1_3)
    throw std::logic_error("a log of this version has ground that stays");
  reliefs_.assign(reliefs.begin(), reliefs.end());
  patches_.assign(patches.begin(), patches.end());
}

// Returns the lines up to a time of what the flight itself moves or changes, in ascending order of time.
std::string FlightLog::waiting_lines(double time_s) {
  std::vector<std::pair<double, std::string>> lines;
  const auto take = [&](auto& waiting) {
    for (; !waiting.empty() && waiting.front().time_s <= time_s; waiting.pop_front())
      lines.emplace_back(waiting.front().time_s, to_line(waiting.front()));
  };
  take(objects_);
  take(reliefs_);
  take(patches_);
  std::ranges::stable_sort(lines, {}, [](const auto& line) { return line.first; });
  std::string text;
  for (const auto& line : lines) text += line.second;
  return text;
}

void FlightLog::note(std::string_view text) {
  std::string line = "# " + std::string(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  file_.write(line + "\n");
}

void FlightLog::end(double time_s) {
  file_.write(waiting_lines(time_s) + end_line(time_s));
  file_.close();
}

}  // namespace scripts
