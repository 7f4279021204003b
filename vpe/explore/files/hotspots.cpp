#include "vpe/explore/files/hotspots.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/base/quote.h"

namespace vpe::explore {

namespace {

constexpr std::uintmax_t kLargestHotspotsFile = 16 << 20;

// Parses a hotspot; sets `fault` to what was expected if it is wrong.
Hotspot read_hotspot(const std::vector<std::string>& words, std::string& fault) {
  Hotspot hotspot;
  if (words[0] != "spot") {
    fault = "a line that begins with spot, found " + base::quote_text(words[0]);
  } else if (words.size() != 6) {
    fault = "spot NAME LON LAT HEIGHT PANORAMA, found " + std::to_string(words.size()) +
            (words.size() == 1 ? " word" : " words") + "; a name or path with blanks needs double quotes";
  } else if (words[1].empty() || !is_one_line(words[1])) {
    fault = "a name of at least one character and no control characters, found " + base::quote_text(words[1]);
  } else if (words[5].empty()) {
    fault = "the path of a panorama, found an empty word";
  }
  if (!fault.empty()) return hotspot;
  const auto lon = number_word(words[2], "a longitude", -360, 360, fault);
  const auto lat = lon ? number_word(words[3], "a latitude", -90, 90, fault) : lon;
  const auto height = lat ? number_word(words[4], "a height above the ground in metres", 0,
                                        scripts::FlightLimits::kMaxAlt_m, fault)
                          : lat;
  if (height) hotspot = {words[1], {*lon, *lat}, *height, words[5]};
  return hotspot;
}

}  // namespace

ParsedHotspots parse_hotspots(std::string_view text, const std::filesystem::path& file) {
  ParsedHotspots parsed;
  std::vector<int> lines;  // of the hotspots
  int number = 0;
  for (const std::string_view line : lines_of(text)) {
    ++number;
    std::string fault;
    const std::vector<std::string> words = split_words(line, fault);
    if (words.empty() && fault.empty()) continue;
    Hotspot hotspot = fault.empty() ? read_hotspot(words, fault) : Hotspot();
    if (fault.empty()) {
      const auto twin = std::find_if(parsed.hotspots.begin(), parsed.hotspots.end(),
                                     [&](const Hotspot& other) { return other.name == hotspot.name; });
      if (twin != parsed.hotspots.end()) {
        fault = "a unique name, found " + base::quote_text(hotspot.name) + " again after line " +
                std::to_string(lines[static_cast<std::size_t>(twin - parsed.hotspots.begin())]);
      }
    }
    if (fault.empty()) {
      // An absolute path stays as it is.
      hotspot.panorama = (file.parent_path() / hotspot.panorama).lexically_normal();
      parsed.hotspots.push_back(std::move(hotspot));
      lines.push_back(number);
    } else if (parsed.errors.size() < ParsedHotspots::kMaxErrors) {
      parsed.errors.push_back({file.string(), number, "expected " + fault});
    }
  }
  if (!parsed.errors.empty()) parsed.hotspots.clear();
  return parsed;
}

ParsedHotspots load_hotspots(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = base::read_file(file, kLargestHotspotsFile);
  return parse_hotspots({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
}

std::string to_line(const Hotspot& hotspot) {
  return "spot " + as_word(hotspot.name) + " " + base::format_number(hotspot.place.lon_deg) + " " +
         base::format_number(hotspot.place.lat_deg) + " " + base::format_number(hotspot.height_m) + " " +
         as_word(hotspot.panorama.string()) + "\n";
}

std::vector<glm::dvec3> hotspot_positions(std::span<const Hotspot> hotspots, double radius_m,
                                          const scripts::TerrainHeight& terrain_height_m, double exaggeration) {
  std::vector<glm::dvec3> positions;
  positions.reserve(hotspots.size());
  for (const Hotspot& hotspot : hotspots) {
    const double terrain_m = terrain_height_m ? terrain_height_m(hotspot.place, exaggeration) : std::nan("");
    positions.push_back((radius_m + terrain_m + hotspot.height_m) * mars::direction(hotspot.place));
  }
  return positions;
}

std::optional<NearHotspot> nearest_hotspot(std::span<const glm::dvec3> positions_m, const glm::dvec3& camera_m,
                                           double within_m) {
  std::optional<NearHotspot> nearest;
  for (std::size_t n = 0; n < positions_m.size(); ++n) {
    const double distance_m = glm::length(positions_m[n] - camera_m);
    if (distance_m <= within_m && (!nearest || distance_m < nearest->distance_m))
      nearest = NearHotspot{n, distance_m};
  }
  return nearest;
}

HotspotTracker::HotspotTracker(std::vector<glm::dvec3> positions_m, const HotspotTrackerOptions& options)
    : positions_m_(std::move(positions_m)), options_(options) {}

HotspotTracker::State HotspotTracker::update(const glm::dvec3& camera_m) {
  const auto nearest = nearest_hotspot(positions_m_, camera_m, options_.approach_m);
  State next;
  double reach_m = options_.reach_m;
  if (state_.stage != HotspotStage::kFar) {
    const double distance_m = glm::length(positions_m_[state_.hotspot.index] - camera_m);
    const bool keeps = distance_m <= options_.leave_factor * options_.approach_m;
    const bool other = nearest && nearest->index != state_.hotspot.index &&
                       (!keeps || nearest->distance_m < options_.switch_share * distance_m);
    if (keeps && !other) {
      next = {HotspotStage::kApproaching, {state_.hotspot.index, distance_m}};
      if (state_.stage == HotspotStage::kWithinReach) reach_m *= options_.leave_factor;
    }
  }
  if (next.stage == HotspotStage::kFar && nearest) next = {HotspotStage::kApproaching, *nearest};
  if (next.stage == HotspotStage::kApproaching && next.hotspot.distance_m <= reach_m)
    next.stage = HotspotStage::kWithinReach;
  return state_ = next;
}

}  // namespace vpe::explore
