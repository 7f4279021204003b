#include "vpe/app/picture/sun_statement.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "mars/geodesy/mars_time.h"
#include "vpe/app/cli/program.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

mars::SunSpec spec_of(const core::SettingsValues& settings) {
  return mars::parse_sun(settings.sun).value_or(mars::LocalSun{});
}

// Returns "00:12" for hours, rounded to the minute.
std::string clock_text(double hours) {
  const auto minutes = static_cast<int>(std::lround(hours * 60)) % (24 * 60);
  char text[16];
  std::snprintf(text, sizeof text, "%02d:%02d", minutes / 60, minutes % 60);
  return text;
}

}  // namespace

std::optional<SunStatement> sun_statement(const core::SettingsValues& settings, mars::LonLat place) {
  const mars::SunSpec spec = spec_of(settings);
  const auto direction = mars::sun_direction(spec, place);
  if (!direction) return std::nullopt;
  SunStatement out;
  out.position = mars::sun_position(place, *direction);
  if (const auto* date = std::get_if<mars::SunDate>(&spec)) {
    const mars::MarsTime time = mars::mars_time(date->time_s);
    out.solar_longitude_deg = time.solar_longitude_deg;
    out.true_solar_time_h = mars::local_true_time_h(time, place.lon_deg);
  } else if (const auto* season = std::get_if<mars::SunSeason>(&spec)) {
    out.solar_longitude_deg = season->solar_longitude_deg;
    out.true_solar_time_h = season->true_time_h;
  }
  return out;
}

std::string to_text(const SunStatement& sun) {
  return "Ls " + base::format_display(sun.solar_longitude_deg, 1) + ", LTST " +
         clock_text(sun.true_solar_time_h) + ", azimuth " + base::format_display(sun.position.azimuth_deg, 1) +
         ", elevation " + base::format_display(sun.position.elevation_deg, 1) + " degrees";
}

nlohmann::json to_json(const std::optional<SunStatement>& sun) {
  if (!sun) return nullptr;
  return {{"solar_longitude_deg", sun->solar_longitude_deg},
          {"true_solar_time_h", sun->true_solar_time_h},
          {"azimuth_deg", sun->position.azimuth_deg},
          {"elevation_deg", sun->position.elevation_deg},
          {"night", sun->is_night()}};
}

void print_sun(const std::optional<SunStatement>& sun) {
  if (!sun) return;
  std::fprintf(stderr, "Sun: %s%s.\n", to_text(*sun).c_str(),
               sun->is_night() ? ". It is night there: the ground gets no direct light" : "");
}

void require_known_sun(const core::SettingsValues& settings, const std::string& body) {
  if (body == "Mars" || std::holds_alternative<mars::LocalSun>(spec_of(settings))) return;
  throw UsageError("sun '" + settings.sun + "': dates and seasons are known for Mars only, and this is " +
                   body + "; set sun.azimuth and sun.elevation");
}

}  // namespace vpe::app
