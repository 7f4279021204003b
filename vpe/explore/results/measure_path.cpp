#include "vpe/explore/results/measure_path.h"

#include <utility>

namespace vpe::explore {

namespace {

constexpr std::size_t kStateBytes = 128;  // of a state beside its places

mars::LonLat in_range(mars::LonLat place) { return {mars::normalize_lon_deg(place.lon_deg), place.lat_deg}; }

}  // namespace

void MeasurePath::edit_path(PathState next, const std::string& what) {
  const std::size_t bytes = kStateBytes + state().places.size() * sizeof(mars::LonLat);
  edit(std::move(next), bytes, what);
}

void MeasurePath::add(mars::LonLat place) {
  if (!mars::is_valid(place)) return;
  PathState next = state();
  next.places.push_back(in_range(place));
  edit_path(std::move(next), "measure point " + path_point_name(state().places.size()));
}

void MeasurePath::erase(std::size_t index) {
  if (index >= state().places.size()) return;
  PathState next = state();
  next.places.erase(next.places.begin() + static_cast<std::ptrdiff_t>(index));
  edit_path(std::move(next), "remove point " + path_point_name(index));
}

void MeasurePath::clear() {
  if (state().places.empty()) return;
  PathState next = state();
  next.places.clear();
  edit_path(std::move(next), "clear the path");
}

void MeasurePath::begin_at(mars::LonLat place) {
  if (!mars::is_valid(place)) return;
  PathState next = state();
  next.places = {in_range(place)};
  edit_path(std::move(next), "measure from here");
}

void MeasurePath::go_on_to(mars::LonLat place, mars::LonLat begin) {
  if (!mars::is_valid(place)) return;
  PathState next = state();
  if (next.places.empty()) {
    if (!mars::is_valid(begin)) return;
    next.places.push_back(in_range(begin));
  }
  next.places.push_back(in_range(place));
  edit_path(std::move(next), "profile to here");
}

void MeasurePath::set_heights(double from_height_m, double to_height_m) {
  PathState next = state();
  if (next.from_height_m == from_height_m && next.to_height_m == to_height_m) return;
  next.from_height_m = from_height_m;
  next.to_height_m = to_height_m;
  edit_path(std::move(next), "heights of the line of sight");
}

std::string path_point_name(std::size_t index) {
  std::string name;
  for (std::size_t n = index + 1; n > 0; n = (n - 1) / 26)
    name.insert(name.begin(), static_cast<char>('A' + static_cast<char>((n - 1) % 26)));
  return name;
}

}  // namespace vpe::explore
