#include "scripts/ground_tracks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <variant>

#include "mars/geodesy/sphere.h"
#include "relief/placed.h"
#include "relief/spec_line.h"
#include "scripts/flight_words.h"
#include "vpe/base/number.h"

namespace scripts {

using relief::ReliefSpec;
using vpe::base::format_number;
using vpe::core::NumberOrWord;

namespace {

// Posts of a relief that grows are at most this finer than its largest size needs.
constexpr double kFinerPosts = 4;

std::string at_time(const std::string& name, double time_s) {
  return "the relief \"" + name + "\" at " + format_number(time_s) + " s: ";
}

// Returns the number of a key that changes smoothly, or nullopt.
std::optional<double> number_of(std::size_t key, const ReliefSpec& spec) {
  const vpe::core::KeyValue value = relief::relief_keys().get(key, spec);
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* number = std::get_if<NumberOrWord>(&value)) return number->number;
  return std::nullopt;
}

void set_number(std::size_t key, double number, ReliefSpec& spec) {
  const auto& keys = relief::relief_keys();
  if (std::holds_alternative<NumberOrWord>(keys.get(key, spec))) {
    keys.set(key, spec, NumberOrWord(number));
  } else {
    keys.set(key, spec, number);
  }
}

bool is_angle(std::size_t key) {
  const std::string_view name = relief::relief_keys().infos()[key].name;
  return name == "lon" || name == "azimuth_deg";
}

// Returns the keys that a line gives.
std::vector<std::size_t> keys_of(const ReliefCommand& line) {
  std::vector<std::size_t> keys;
  std::string fault;
  for (const std::string& word : split_words(line.keys, fault)) {
    const auto pair = split_key_value(word);
    if (!pair) continue;
    if (const auto key = relief::find_line_key(pair->key)) keys.push_back(*key);
  }
  return keys;
}

// Adds a knot that holds the last value to the end, so that a change ends smoothly.
MonotoneSpline held_spline(std::vector<double> times_s, std::vector<double> values, double end_s) {
  if (times_s.back() < end_s) {
    times_s.push_back(end_s);
    values.push_back(values.back());
  }
  return {std::move(times_s), std::move(values)};
}

double spacing_of(const std::string& name, double time_s, const ReliefSpec& spec, double radius_m) {
  try {
    return relief::PlacedRelief(spec, radius_m).spacing_m();
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(at_time(name, time_s) + e.what());
  }
}

template <class Timed>
void sort_unique(std::vector<Timed>& all) {
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

}  // namespace

std::vector<std::string> lines_of(const GroundState& state) {
  std::vector<std::string> lines;
  for (const PatchState& patch : state.patches)
    lines.push_back("patch " + patch.file + " mix=" + format_number(patch.mix));
  for (const ReliefSpec& spec : state.reliefs)
    lines.push_back("relief " + spec.name + " " + relief::to_line(spec));
  return lines;
}

double GroundTracks::value_at(const Curve& curve, double time_s) {
  const auto after = std::lower_bound(curve.times_s.begin(), curve.times_s.end(), time_s);
  if (after == curve.times_s.end()) return curve.values.back();
  const auto i = static_cast<std::size_t>(after - curve.times_s.begin());
  if (*after == time_s || i == 0 || curve.values[i - 1] == curve.values[i]) return curve.values[i];
  const double value = curve.spline.at(time_s);
  return curve.is_angle ? mars::normalize_lon_deg(value) : value;
}

ReliefSpec GroundTracks::Life::at(double time_s) const {
  const auto next = std::upper_bound(times_s.begin(), times_s.end(), time_s);
  ReliefSpec spec = states[static_cast<std::size_t>(next - times_s.begin()) - 1];
  for (const Curve& curve : curves) set_number(curve.key, value_at(curve, time_s), spec);
  // A rise that a later line with another mode gives.
  if (spec.mode.value_or(relief::usual_mode(spec.kind)) == relief::Mode::kAdd) spec.rise_m = 0;
  spec.spacing_m = spacing_m;
  return spec;
}

void GroundTracks::add_line(const ReliefCommand& line, Track& track) {
  if (line.is_shown) track.showings.push_back({line.time_s, *line.is_shown});
  if (line.keys.empty()) return;
  const std::vector<std::size_t> keys = keys_of(line);
  const std::size_t kind = *relief::find_line_key("kind");
  const bool is_new = std::ranges::find(keys, kind) != keys.end();
  try {
    if (is_new) {
      track.lives.emplace_back();
      track.lives.back().states.push_back(relief::parse_relief_line(line.keys));
    } else if (track.lives.empty()) {
      throw std::invalid_argument("expected kind in its first line");
    } else {
      Life& life = track.lives.back();
      life.states.push_back(relief::changed_by_line(life.states.back(), line.keys));
    }
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error(at_time(line.name, line.time_s) + e.what());
  }
  track.lives.back().states.back().name = line.name;
  track.lives.back().times_s.push_back(line.time_s);
}

void GroundTracks::add_curves(const std::vector<const ReliefCommand*>& lines, double end_s, Life& life) {
  std::vector<std::vector<std::size_t>> given;
  for (const ReliefCommand* line : lines) given.push_back(keys_of(*line));
  for (std::size_t key = 0; key < relief::relief_keys().infos().size(); ++key) {
    if (relief::relief_keys().infos()[key].name == "spacing_m") continue;
    std::vector<double> times_s;
    std::vector<double> values;
    for (std::size_t n = 0; n < life.states.size(); ++n) {
      const std::optional<double> number = number_of(key, life.states[n]);
      if (!number || (n > 0 && std::ranges::find(given[n], key) == given[n].end())) continue;
      times_s.push_back(life.times_s[n]);
      values.push_back(*number);
    }
    if (values.empty() || std::ranges::all_of(values, [&](double v) { return v == values.front(); })) continue;
    std::vector<double> unwound = values;
    for (std::size_t n = 1; n < values.size() && is_angle(key); ++n)
      unwound[n] = unwound[n - 1] + std::remainder(values[n] - unwound[n - 1], 360.0);
    life.curves.push_back({key, times_s, values, held_spline(times_s, unwound, end_s), is_angle(key)});
  }
}

void GroundTracks::set_spacing(const std::string& name, double radius_m, Life& life) {
  double finest_m = std::numeric_limits<double>::infinity();
  double coarsest_m = 0;
  for (std::size_t n = 0; n < life.states.size(); ++n) {
    ReliefSpec spec = life.states[n];
    for (const Curve& curve : life.curves) set_number(curve.key, value_at(curve, life.times_s[n]), spec);
    const double spacing_m = spacing_of(name, life.times_s[n], spec, radius_m);
    finest_m = std::min(finest_m, spacing_m);
    coarsest_m = std::max(coarsest_m, spacing_m);
  }
  life.spacing_m = std::max(finest_m, coarsest_m / kFinerPosts);
}

GroundTracks::GroundTracks(const Flight& flight, double radius_m) {
  const double end_s = duration_s(flight);
  std::map<std::string, std::size_t> numbers;
  std::vector<std::vector<const ReliefCommand*>> lines;
  for (const ReliefCommand& line : flight.reliefs) {
    times_s_.push_back(line.time_s);
    const auto [at, is_first] = numbers.emplace(line.name, reliefs_.size());
    if (is_first) reliefs_.push_back({line.name, {}, {}});
    lines.resize(reliefs_.size());
    add_line(line, reliefs_[at->second]);
    if (!line.keys.empty()) lines[at->second].push_back(&line);
  }
  for (std::size_t n = 0; n < reliefs_.size(); ++n) {
    auto begin = lines[n].begin();
    for (Life& life : reliefs_[n].lives) {
      const auto end = begin + static_cast<std::ptrdiff_t>(life.states.size());
      add_curves({begin, end}, end_s, life);
      set_spacing(reliefs_[n].name, radius_m, life);
      begin = end;
    }
  }
  std::vector<std::string> files;
  std::map<std::string, std::pair<std::vector<double>, std::vector<double>>> mixes;
  for (const PatchCommand& line : flight.patches) {
    times_s_.push_back(line.time_s);
    if (!mixes.contains(line.file)) files.push_back(line.file);
    mixes[line.file].first.push_back(line.time_s);
    mixes[line.file].second.push_back(line.mix);
  }
  for (const std::string& file : files) {
    auto& [times_s, values] = mixes[file];
    patches_.push_back({file, times_s.front(), held_spline(times_s, values, end_s)});
  }
  sort_unique(times_s_);
  if (empty()) return;
  text_ = format_number(radius_m) + end_line(end_s);
  for (const ReliefCommand& line : flight.reliefs) text_ += to_line(line);
  for (const PatchCommand& line : flight.patches) text_ += to_line(line);
}

GroundState GroundTracks::at(double time_s) const {
  GroundState state;
  for (const Patch& patch : patches_) {
    if (time_s < patch.begin_s) continue;
    if (const double mix = patch.mix.at(time_s); mix > 0) state.patches.push_back({patch.file, mix});
  }
  for (const Track& track : reliefs_) {
    bool is_shown = true;
    for (const Showing& change : track.showings)
      if (change.time_s <= time_s) is_shown = change.is_shown;
    const auto next = std::upper_bound(track.lives.begin(), track.lives.end(), time_s,
                                       [](double t, const Life& life) { return t < life.times_s.front(); });
    if (!is_shown || next == track.lives.begin()) continue;
    ReliefSpec spec = std::prev(next)->at(time_s);
    if (spec.strength > 0) state.reliefs.push_back(std::move(spec));
  }
  return state;
}

std::vector<std::string> GroundTracks::files() const {
  std::vector<std::string> files;
  for (const Patch& patch : patches_) files.push_back(patch.file);
  return files;
}

std::vector<std::string> GroundTracks::names() const {
  std::vector<std::string> names;
  for (const Patch& patch : patches_) names.push_back("patch " + patch.file);
  for (const Track& track : reliefs_) names.push_back("relief " + track.name);
  return names;
}

}  // namespace scripts
