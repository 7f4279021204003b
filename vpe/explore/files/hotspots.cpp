#include "vpe/explore/files/hotspots.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/base/file.h"
#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

constexpr std::uintmax_t kLargestFile = 16 << 20;

// What is wrong in `fault`.
Spot read_spot(const std::vector<std::string>& words, std::string& fault) {
  Spot spot;
  if (words[0] != "spot") {
    fault = "a spot, found " + found_text(words[0]);
  } else if (words.size() != 6) {
    fault = "spot NAME LON LAT HEIGHT PANORAMA, found " + std::to_string(words.size()) +
            (words.size() == 1 ? " word" : " words") + "; a name or path with blanks stands in double quotes";
  } else if (words[1].empty() || !is_one_line(words[1])) {
    fault = "a name of at least one character and no control characters, found " + found_text(words[1]);
  } else if (words[5].empty()) {
    fault = "the path of a panorama, found an empty word";
  }
  if (!fault.empty()) return spot;
  const auto lon = number_word(words[2], "a longitude", -360, 360, fault);
  const auto lat = lon ? number_word(words[3], "a latitude", -90, 90, fault) : lon;
  const auto height = lat ? number_word(words[4], "a height above the ground in metres", 0,
                                        scripts::FlightLimits::kMaxAlt_m, fault)
                          : lat;
  if (height) spot = {words[1], {*lon, *lat}, *height, words[5]};
  return spot;
}

}  // namespace

ParsedSpots parse_spots(std::string_view text, const std::filesystem::path& file) {
  ParsedSpots parsed;
  std::vector<int> lines;  // of the spots
  int number = 0;
  for (const std::string_view line : lines_of(text)) {
    ++number;
    std::string fault;
    const std::vector<std::string> words = split_words(line, fault);
    if (words.empty() && fault.empty()) continue;
    Spot spot = fault.empty() ? read_spot(words, fault) : Spot();
    if (fault.empty()) {
      const auto twin = std::find_if(parsed.spots.begin(), parsed.spots.end(),
                                     [&](const Spot& other) { return other.name == spot.name; });
      if (twin != parsed.spots.end()) {
        fault = "a name of its own, found " + found_text(spot.name) + " again after line " +
                std::to_string(lines[static_cast<std::size_t>(twin - parsed.spots.begin())]);
      }
    }
    if (fault.empty()) {
      // An absolute path stays as it is.
      spot.panorama = (file.parent_path() / spot.panorama).lexically_normal();
      parsed.spots.push_back(std::move(spot));
      lines.push_back(number);
    } else if (parsed.errors.size() < ParsedSpots::kMaxErrors) {
      parsed.errors.push_back({file.string(), number, "expected " + fault});
    }
  }
  if (!parsed.errors.empty()) parsed.spots.clear();
  return parsed;
}

ParsedSpots load_spots(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = base::read_file(file, kLargestFile);
  return parse_spots({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
}

std::string to_line(const Spot& spot) {
  return "spot " + as_word(spot.name) + " " + base::format_number(spot.place.lon_deg) + " " +
         base::format_number(spot.place.lat_deg) + " " + base::format_number(spot.height_m) + " " +
         as_word(spot.panorama.string()) + "\n";
}

std::vector<glm::dvec3> spot_eyes(std::span<const Spot> spots, double radius_m,
                                  const scripts::TerrainHeight& terrain_height_m, double exaggeration) {
  std::vector<glm::dvec3> eyes;
  eyes.reserve(spots.size());
  for (const Spot& spot : spots) {
    const double terrain_m = terrain_height_m ? terrain_height_m(spot.place, exaggeration) : std::nan("");
    eyes.push_back((radius_m + terrain_m + spot.height_m) * mars::direction(spot.place));
  }
  return eyes;
}

std::optional<NearSpot> nearest_spot(std::span<const glm::dvec3> eyes_m, const glm::dvec3& eye_m,
                                     double within_m) {
  std::optional<NearSpot> nearest;
  for (std::size_t n = 0; n < eyes_m.size(); ++n) {
    const double distance_m = glm::length(eyes_m[n] - eye_m);
    if (distance_m <= within_m && (!nearest || distance_m < nearest->distance_m))
      nearest = NearSpot{n, distance_m};
  }
  return nearest;
}

SpotTracker::SpotTracker(std::vector<glm::dvec3> eyes_m, const SpotTrackerOptions& options)
    : eyes_m_(std::move(eyes_m)), options_(options) {}

SpotTracker::State SpotTracker::update(const glm::dvec3& eye_m) {
  const auto nearest = nearest_spot(eyes_m_, eye_m, options_.approach_m);
  State next;
  double reach_m = options_.reach_m;
  if (state_.stage != SpotStage::kFar) {
    const double distance_m = glm::length(eyes_m_[state_.spot.index] - eye_m);
    const bool keeps = distance_m <= options_.leave * options_.approach_m;
    const bool other = nearest && nearest->index != state_.spot.index &&
                       (!keeps || nearest->distance_m < options_.swap * distance_m);
    if (keeps && !other) {
      next = {SpotStage::kApproaching, {state_.spot.index, distance_m}};
      if (state_.stage == SpotStage::kWithinReach) reach_m *= options_.leave;
    }
  }
  if (next.stage == SpotStage::kFar && nearest) next = {SpotStage::kApproaching, *nearest};
  if (next.stage == SpotStage::kApproaching && next.spot.distance_m <= reach_m)
    next.stage = SpotStage::kWithinReach;
  return state_ = next;
}

}  // namespace vpe::explore
