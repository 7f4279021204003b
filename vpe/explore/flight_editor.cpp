#include "vpe/explore/flight_editor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "vpe/base/number.h"

namespace vpe::explore {

using base::format_number;
using scripts::Flight;
using scripts::Waypoint;

namespace {

constexpr double kOppositePoses_rad = 1e-6;  // as scripts::Path
constexpr double kStanding_m = 1;

mars::LonLat place_of(const Waypoint& w) { return {w.lon_deg, w.lat_deg}; }

std::string pose_name(std::size_t index) { return "pose " + std::to_string(index + 1); }

// Returns what the flight format expects instead of the first error, or "".
std::string expected_by(const scripts::ParsedFlight& parsed) {
  constexpr std::string_view kExpected = "expected ";
  if (parsed.errors.empty()) return "";
  const std::string& text = parsed.errors.front().expected;
  return text.starts_with(kExpected) ? text.substr(kExpected.size()) : text;
}

std::string problem_in(const std::string& lines) { return expected_by(scripts::parse_flight(lines, "")); }

std::string first_line() { return scripts::version_line(scripts::FlightVersion::k1); }

std::string problem_of(const Waypoint& w) { return problem_in(first_line() + scripts::to_line(w)); }

std::string problem_of_speed(double speed_m_per_s) {
  return speed_m_per_s > 0 && std::isfinite(speed_m_per_s) ? "" : "a speed must be above 0 m/s";
}

std::size_t bytes_of(const Flight& f) {
  std::size_t bytes =
      sizeof f + f.waypoints.size() * sizeof(Waypoint) + f.heads.size() * sizeof(scripts::HeadCommand) +
      f.interests.size() * sizeof(scripts::InterestCommand) + f.views.size() * sizeof(scripts::ViewCommand) +
      f.objects.size() * sizeof(scripts::ObjectCommand) + f.reliefs.size() * sizeof(scripts::ReliefCommand) +
      f.patches.size() * sizeof(scripts::PatchCommand);
  for (const scripts::SetCommand& set : f.sets) bytes += sizeof set + set.key.size() + set.text.size();
  return bytes;
}

}  // namespace

FlightEditor::FlightEditor(Flight flight, double radius_m) : radius_m_(radius_m) {
  flight_.waypoints.emplace_back();
  if (const Problem problem = replace_all(std::move(flight), ""); !problem.empty()) {
    throw std::invalid_argument(problem);
  }
  undo_.clear();
  made_ = 0;
  saved_ = flight_;
}

double FlightEditor::leg_m(const Waypoint& a, const Waypoint& b) const {
  return mars::distance_rad(place_of(a), place_of(b)) * radius_m_;
}

double FlightEditor::length_m() const {
  double length_m = 0;
  for (std::size_t i = 1; i < flight_.waypoints.size(); ++i) {
    length_m += leg_m(flight_.waypoints[i - 1], flight_.waypoints[i]);
  }
  return length_m;
}

std::size_t FlightEditor::nearest(mars::LonLat place) const {
  const auto distance = [&](const Waypoint& w) { return mars::distance_rad(place_of(w), place); };
  const auto& all = flight_.waypoints;
  const auto found = std::min_element(
      all.begin(), all.end(), [&](const Waypoint& a, const Waypoint& b) { return distance(a) < distance(b); });
  return static_cast<std::size_t>(found - all.begin());
}

FlightEditor::Problem FlightEditor::no_pose(std::size_t index) const {
  if (index < flight_.waypoints.size()) return "";
  return "there is no " + pose_name(index) + ": the flight has " + std::to_string(flight_.waypoints.size());
}

// Checks a pose's numbers, its time between those of its neighbours, and the paths to them.
FlightEditor::Problem FlightEditor::check_neighbours(const Flight& flight, std::size_t index) const {
  const Waypoint& w = flight.waypoints[index];
  if (Problem problem = problem_of(w); !problem.empty()) return "a pose needs " + problem;
  if (!w.above_terrain && !(radius_m_ + w.up_m > 0)) {
    return "alt must be above " + format_number(-radius_m_) + " m, the planet's centre";
  }
  const auto beside = [&](std::size_t other, bool is_before) -> Problem {
    const Waypoint& o = flight.waypoints[other];
    if (is_before ? !(o.time_s < w.time_s) : !(w.time_s < o.time_s)) {
      return "the time must be " + std::string(is_before ? "after " : "before ") + format_number(o.time_s) +
             " s, the time of the neighbouring pose, not " + format_number(w.time_s);
    }
    if (mars::distance_rad(place_of(o), place_of(w)) > mars::kPi - kOppositePoses_rad) {
      return "consecutive poses may not be on opposite sides of the planet: place one between them";
    }
    return "";
  };
  Problem problem = index > 0 ? beside(index - 1, true) : "";
  if (problem.empty() && index + 1 < flight.waypoints.size()) problem = beside(index + 1, false);
  return problem;
}

FlightEditor::Problem FlightEditor::change(Flight next, std::string what, bool merges) {
  if (next.end_s) {
    std::optional<double> end_s = std::exchange(next.end_s, std::nullopt);
    next.end_s = std::max(*end_s, scripts::duration_s(next));
  }
  drag_.clear();
  if (next == flight_) return "";
  redo_.clear();
  if (!merges) {
    undo_.push_back({std::move(flight_), std::move(what)});
    ++made_;
  }
  flight_ = std::move(next);
  ++revision_;
  forget_old_steps();
  return "";
}

void FlightEditor::forget_old_steps() {
  std::size_t bytes = 0;
  for (auto step = undo_.rbegin(); step != undo_.rend(); ++step) {
    bytes += bytes_of(step->flight);
    if (bytes <= FlightEditorLimits::kUndoBytes || step == undo_.rbegin()) continue;
    dropped_ += static_cast<std::uint64_t>(step.base() - undo_.begin());
    undo_.erase(undo_.begin(), step.base());
    return;
  }
}

FlightEditor::Problem FlightEditor::insert_at(std::size_t index, const Waypoint& waypoint, std::string what) {
  Flight next = flight_;
  next.waypoints.insert(next.waypoints.begin() + static_cast<std::ptrdiff_t>(index), waypoint);
  if (Problem problem = check_neighbours(next, index); !problem.empty()) return problem;
  return change(std::move(next), std::move(what));
}

FlightEditor::Problem FlightEditor::insert(const Waypoint& waypoint) {
  const auto& all = flight_.waypoints;
  const auto after = std::lower_bound(all.begin(), all.end(), waypoint.time_s,
                                      [](const Waypoint& w, double t) { return w.time_s < t; });
  if (after != all.end() && after->time_s == waypoint.time_s) {
    return "there is a pose at " + format_number(waypoint.time_s) + " s already: choose another time";
  }
  const auto index = static_cast<std::size_t>(after - all.begin());
  return insert_at(index, waypoint, "insert " + pose_name(index));
}

FlightEditor::Problem FlightEditor::insert_after(std::size_t index, const Waypoint& waypoint,
                                                 double speed_m_per_s) {
  if (Problem problem = no_pose(index); !problem.empty()) return problem;
  if (index + 1 == flight_.waypoints.size()) return append(waypoint, speed_m_per_s);
  const Waypoint& a = flight_.waypoints[index];
  const Waypoint& b = flight_.waypoints[index + 1];
  const double before_m = leg_m(a, waypoint);
  const double after_m = leg_m(waypoint, b);
  // Not so close to either time that the flight would jump.
  constexpr double kLeastShare = 0.01;
  const double share = before_m + after_m > 0 ? before_m / (before_m + after_m) : 0.5;
  Waypoint placed = waypoint;
  placed.time_s = a.time_s + std::clamp(share, kLeastShare, 1 - kLeastShare) * (b.time_s - a.time_s);
  return insert_at(index + 1, placed, "insert " + pose_name(index + 1));
}

FlightEditor::Problem FlightEditor::append(const Waypoint& waypoint, double speed_m_per_s) {
  if (Problem problem = problem_of_speed(speed_m_per_s); !problem.empty()) return problem;
  const Waypoint& last = flight_.waypoints.back();
  const double path_m = leg_m(last, waypoint);
  Waypoint placed = waypoint;
  placed.time_s =
      last.time_s + (path_m < kStanding_m ? FlightEditorLimits::kStandingLeg_s : path_m / speed_m_per_s);
  const std::size_t index = flight_.waypoints.size();
  return insert_at(index, placed, "append " + pose_name(index));
}

FlightEditor::Problem FlightEditor::move(std::size_t index, mars::LonLat place, bool continues) {
  if (Problem problem = no_pose(index); !problem.empty()) return problem;
  Flight next = flight_;
  Waypoint& w = next.waypoints[index];
  w.lon_deg = place.lon_deg;
  w.lat_deg = place.lat_deg;
  if (Problem problem = check_neighbours(next, index); !problem.empty()) return problem;
  const std::string what = "move " + pose_name(index);
  const bool merges = continues && drag_ == what;
  if (!merges) drag_.clear();
  if (next == flight_) return "";
  Problem problem = change(std::move(next), what, merges);
  drag_ = what;
  return problem;
}

FlightEditor::Problem FlightEditor::replace(std::size_t index, const Waypoint& waypoint) {
  if (Problem problem = no_pose(index); !problem.empty()) return problem;
  Flight next = flight_;
  next.waypoints[index] = waypoint;
  if (Problem problem = check_neighbours(next, index); !problem.empty()) return problem;
  return change(std::move(next), "edit " + pose_name(index));
}

FlightEditor::Problem FlightEditor::remove(std::size_t index) {
  if (Problem problem = no_pose(index); !problem.empty()) return problem;
  if (flight_.waypoints.size() == 1) return "a flight needs at least one pose: move this one instead";
  Flight next = flight_;
  next.waypoints.erase(next.waypoints.begin() + static_cast<std::ptrdiff_t>(index));
  if (index > 0 && index < next.waypoints.size()) {
    if (Problem problem = check_neighbours(next, index); !problem.empty()) return problem;
  }
  return change(std::move(next), "delete " + pose_name(index));
}

FlightEditor::Problem FlightEditor::retime(const std::function<double(double)>& time_s, std::string what) {
  Flight next = flight_;
  const double end_s = time_s(scripts::duration_s(next));
  if (!(end_s <= scripts::FlightLimits::kMaxTime_s)) {
    return "the flight would be longer than " + format_number(scripts::FlightLimits::kMaxTime_s) + " s";
  }
  const auto all = [&](auto& commands) {
    for (auto& command : commands) command.time_s = time_s(command.time_s);
  };
  all(next.waypoints);
  all(next.heads);
  all(next.sets);
  all(next.interests);
  all(next.views);
  all(next.objects);
  all(next.reliefs);
  all(next.patches);
  if (next.end_s) next.end_s = time_s(*next.end_s);
  const auto ascend = [](const auto& commands) {
    for (std::size_t i = 1; i < commands.size(); ++i) {
      if (!(commands[i - 1].time_s < commands[i].time_s)) return false;
    }
    return true;
  };
  // Of lists that may have several lines at a time.
  const auto stay_apart = [](const auto& before, const auto& after) {
    for (std::size_t i = 1; i < after.size(); ++i) {
      if (before[i - 1].time_s < before[i].time_s && !(after[i - 1].time_s < after[i].time_s)) return false;
    }
    return true;
  };
  const bool is_apart = stay_apart(flight_.objects, next.objects) &&
                        stay_apart(flight_.reliefs, next.reliefs) && stay_apart(flight_.patches, next.patches);
  if (!is_apart || !ascend(next.waypoints) || !ascend(next.heads) || !ascend(next.views)) {
    return "the times would be too close together to tell them apart";
  }
  return change(std::move(next), std::move(what));
}

FlightEditor::Problem FlightEditor::scale_times(double factor) {
  if (!(factor > 0) || !std::isfinite(factor)) return "the factor of times must be above 0";
  return retime([&](double t) { return factor * t; }, "scale times");
}

FlightEditor::Problem FlightEditor::keep_speed(double speed_m_per_s) {
  if (Problem problem = problem_of_speed(speed_m_per_s); !problem.empty()) return problem;
  const auto& all = flight_.waypoints;
  std::vector<double> times_s{all.front().time_s};
  for (std::size_t i = 1; i < all.size(); ++i) {
    const double path_m = leg_m(all[i - 1], all[i]);
    const double old_s = all[i].time_s - all[i - 1].time_s;
    times_s.push_back(times_s.back() + (path_m < kStanding_m ? old_s : path_m / speed_m_per_s));
  }
  const auto time_s = [&](double t) {
    if (t <= all.front().time_s) return t;
    const auto after = std::lower_bound(all.begin(), all.end(), t,
                                        [](const Waypoint& w, double time) { return w.time_s < time; });
    const auto i = static_cast<std::size_t>(after - all.begin());
    if (after == all.end()) return times_s.back() + (t - all.back().time_s);
    if (after->time_s == t) return times_s[i];
    const double share = (t - all[i - 1].time_s) / (all[i].time_s - all[i - 1].time_s);
    return std::clamp(times_s[i - 1] + share * (times_s[i] - times_s[i - 1]), times_s[i - 1], times_s[i]);
  };
  return retime(time_s, "set speed");
}

FlightEditor::Problem FlightEditor::set_view(const scripts::FlightView& view) {
  Flight next = flight_;
  next.view = view;
  if (Problem problem = problem_in(first_line() + scripts::to_line(view) + scripts::to_line(Waypoint()));
      !problem.empty()) {
    return "a view needs " + problem;
  }
  return change(std::move(next), "edit the view");
}

FlightEditor::Problem FlightEditor::set_end(std::optional<double> end_s) {
  Flight next = flight_;
  next.end_s.reset();
  const double last_s = scripts::duration_s(next);
  if (end_s && !(*end_s >= last_s && *end_s <= scripts::FlightLimits::kMaxTime_s)) {
    return "the end must be from " + format_number(last_s) + " s, the last time in the flight, to " +
           format_number(scripts::FlightLimits::kMaxTime_s) + " s, not " + format_number(*end_s);
  }
  next.end_s = end_s;
  return change(std::move(next), "set the end");
}

FlightEditor::Problem FlightEditor::replace_all(Flight flight, const std::string& what) {
  const scripts::ParsedFlight parsed = scripts::parse_flight(scripts::to_text(flight), "");
  if (!parsed.flight) return "a flight needs " + expected_by(parsed);
  if (!(*parsed.flight == flight)) return "the flight's commands must be in the order of their times";
  for (std::size_t i = 0; i < flight.waypoints.size(); ++i) {
    if (Problem problem = check_neighbours(flight, i); !problem.empty()) return problem;
  }
  return change(std::move(flight), what);
}

std::string FlightEditor::undo_text() const { return undo_.empty() ? "" : undo_.back().what; }
std::string FlightEditor::redo_text() const { return redo_.empty() ? "" : redo_.back().what; }

bool FlightEditor::undo() {
  if (undo_.empty()) return false;
  redo_.push_back({std::move(flight_), undo_.back().what});
  flight_ = std::move(undo_.back().flight);
  ++revision_;
  undo_.pop_back();
  drag_.clear();
  return true;
}

bool FlightEditor::redo() {
  if (redo_.empty()) return false;
  undo_.push_back({std::move(flight_), redo_.back().what});
  flight_ = std::move(redo_.back().flight);
  ++revision_;
  redo_.pop_back();
  drag_.clear();
  return true;
}

}  // namespace vpe::explore
