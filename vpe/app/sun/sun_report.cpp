#include "vpe/app/sun/sun_report.h"

#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "mars/geodesy/place_text.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

using base::format_display;
using nlohmann::json;

constexpr const char* kClockSource = "Mars24 (Allison and McEwen 2000)";

// Local clocks of a place.
struct LocalClock {
  double mean_h = 0;
  double true_h = 0;
};
LocalClock local_clock(mars::UnixSeconds time_s, mars::LonLat place) {
  const mars::MarsTime time = mars::mars_time(time_s);
  return {mars::local_mean_time_h(time, place.lon_deg), mars::local_true_time_h(time, place.lon_deg)};
}

std::string report_line(const char* name, const std::string& value) {
  char head[32];
  std::snprintf(head, sizeof head, "%-9s", name);
  return head + value + "\n";
}

std::string hours_text(double seconds) {
  const auto minutes = static_cast<std::int64_t>(std::floor(seconds / 60));
  return std::to_string(minutes / 60) + " h " + std::to_string(minutes % 60) + " min " +
         format_display(seconds - 60.0 * static_cast<double>(minutes), 1) + " s";
}

std::string sky_text(const SunReport& r) {
  if (r.is_seen) return "seen";
  return r.sun.elevation_deg < 0 ? "night: below the horizontal" : "hidden: below the skyline";
}

std::string error_text(const SunReport& r) {
  const auto ground_off_m = ground_error_m(r.ground);
  return (ground_off_m ? "error at most " + format_display(*ground_off_m, 2) + " m"
                       : std::string("error not known")) +
         " against " + (r.source.empty() ? std::string("its source") : on_one_line(r.source));
}

std::string crossing_text(const SunCrossing& c, mars::LonLat place) {
  const LocalClock clock = local_clock(c.time_s, place);
  std::string text = date_text(c.time_s, 1) + ", LMST " + hour_text(clock.mean_h) + ", LTST " +
                     hour_text(clock.true_h) + ", azimuth " + format_display(c.sun.azimuth_deg, 2) +
                     ", elevation " + format_display(c.sun.elevation_deg, 3);
  if (!c.ridge) return text;
  text += ", over ground " + format_display(c.ridge->range_m / 1000, 2) + " km away";
  return text + (c.ridge->error_s ? ", error at most " + format_display(*c.ridge->error_s, 1) + " s"
                                  : ", error not known");
}

std::string periods_text(const SunReport& r) {
  if (r.periods.empty()) return report_line("Rise", "none: the sun is not seen in this sol");
  std::string text;
  for (const SunOutlook& p : r.periods) {
    text += report_line("Rise", p.rise ? crossing_text(*p.rise, r.place) : "before the sol begins");
    text += report_line("Set", p.set ? crossing_text(*p.set, r.place) : "after the sol ends");
  }
  return text;
}

std::string table_text(const SunReport& r) {
  std::string text = "\ndate,lmst,ltst,azimuth_deg,elevation_deg,skyline_deg,seen\n";
  for (const SunRow& row : r.table) {
    const LocalClock clock = local_clock(row.time_s, r.place);
    text += date_text(row.time_s, 0) + "," + hour_text(clock.mean_h) + "," + hour_text(clock.true_h) + "," +
            format_display(row.sun.azimuth_deg, 3) + "," + format_display(row.sun.elevation_deg, 3) + "," +
            format_display(row.skyline_deg, 3) + "," + (row.is_seen ? "1" : "0") + "\n";
  }
  return text;
}

const char* limb_name(const SunReport& r) { return r.is_upper_limb ? "upper" : "centre"; }

std::string method_text(const SunReport& r) {
  return std::string(r.is_upper_limb ? "upper limb of the disc (radius " : "centre of the disc (radius ") +
         format_display(r.disc_radius_deg, 4) + " degrees), no refraction, clock of " + kClockSource;
}

json crossing_json(const std::optional<SunCrossing>& c, mars::LonLat place) {
  if (!c) return nullptr;
  const LocalClock clock = local_clock(c->time_s, place);
  json out{{"date", date_text(c->time_s, 2)},
           {"unix_s", c->time_s},
           {"lmst_h", clock.mean_h},
           {"ltst_h", clock.true_h},
           {"azimuth_deg", c->sun.azimuth_deg},
           {"elevation_deg", c->sun.elevation_deg},
           {"skyline", nullptr}};
  if (c->ridge) {
    out["skyline"] = {{"elevation_deg", c->ridge->elevation_deg},
                      {"range_m", c->ridge->range_m},
                      {"lon_deg", c->ridge->place.lon_deg},
                      {"lat_deg", c->ridge->place.lat_deg},
                      {"ground_error_m", c->ridge->ground_error_m ? json(*c->ridge->ground_error_m) : json()},
                      {"error_s", c->ridge->error_s ? json(*c->ridge->error_s) : json()}};
  }
  return out;
}

json row_json(const SunRow& row, mars::LonLat place) {
  const LocalClock clock = local_clock(row.time_s, place);
  return {{"date", date_text(row.time_s, 2)},
          {"lmst_h", clock.mean_h},
          {"ltst_h", clock.true_h},
          {"azimuth_deg", row.sun.azimuth_deg},
          {"elevation_deg", row.sun.elevation_deg},
          {"skyline_deg", row.skyline_deg},
          {"seen", row.is_seen}};
}

}  // namespace

std::string date_text(mars::UnixSeconds time_s, int decimals) {
  const double unit = std::pow(10.0, decimals);
  // Rounded before it is split, so that no field can become 60.
  const auto units = static_cast<std::int64_t>(std::llround(time_s * unit));
  const auto per_day = static_cast<std::int64_t>(std::llround(86400 * unit));
  std::int64_t day = units / per_day;
  std::int64_t rest = units % per_day;
  if (rest < 0) {
    rest += per_day;
    --day;
  }
  const std::chrono::year_month_day date{std::chrono::sys_days(std::chrono::days(day))};
  const auto whole_unit = static_cast<std::int64_t>(std::llround(unit));
  const std::int64_t seconds = rest / whole_unit;
  char text[64];
  std::snprintf(text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02d", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                static_cast<int>(seconds / 3600), static_cast<int>(seconds / 60 % 60),
                static_cast<int>(seconds % 60));
  std::string out = text;
  if (decimals > 0) {
    std::snprintf(text, sizeof text, ".%0*d", decimals, static_cast<int>(rest % whole_unit));
    out += text;
  }
  return out + "Z";
}

std::string hour_text(double hours) {
  constexpr std::int64_t kDay_s = 24 * 3600;
  const std::int64_t seconds = ((std::llround(hours * 3600) % kDay_s) + kDay_s) % kDay_s;
  char text[32];
  std::snprintf(text, sizeof text, "%02d:%02d:%02d", static_cast<int>(seconds / 3600),
                static_cast<int>(seconds / 60 % 60), static_cast<int>(seconds % 60));
  return text;
}

std::string to_text(const SunReport& r) {
  const mars::MarsTime time = mars::mars_time(r.date_s);
  const LocalClock clock = local_clock(r.date_s, r.place);
  std::string text = report_line("Place", mars::place_text(r.place));
  text += report_line("Ground", (r.ground.nodata ? "no data; drawn at " : "") +
                                    format_display(r.ground.elevation_m, 1) + " m (datum " + r.datum +
                                    "), posts " + format_display(r.ground.spacing_m, 1) + " m, " +
                                    error_text(r) + "; eye " + format_display(r.height_m, 2) + " m above it");
  text += report_line("Date", date_text(r.date_s, 0) + ", MSD " + format_display(time.sol_date, 5));
  text += report_line("Ls", format_display(time.solar_longitude_deg, 3) + " degrees");
  text += report_line("MTC", hour_text(time.coordinated_time_h));
  text += report_line("LMST", hour_text(clock.mean_h));
  text += report_line("LTST", hour_text(clock.true_h));
  text += report_line("Sun", "azimuth " + format_display(r.sun.azimuth_deg, 3) + ", elevation " +
                                 format_display(r.sun.elevation_deg, 3) + ", skyline there " +
                                 format_display(r.skyline_deg, 3) + " degrees; " + sky_text(r));
  text += report_line("Sol", std::to_string(r.sol.number) + ", from " + date_text(r.sol.begin_s, 0) +
                                 " (LMST 00:00) to " + date_text(r.sol.end_s, 0));
  text += periods_text(r);
  text += report_line("Seen", hours_text(r.seen_s) + " of the sol");
  text += report_line(
      "Horizon", r.horizon == SunHorizon::kFlat ? "flat: the horizontal plane, without terrain" : "terrain");
  text += report_line("Method", method_text(r));
  return r.table.empty() ? text : text + table_text(r);
}

json to_json(const SunReport& r) {
  const mars::MarsTime time = mars::mars_time(r.date_s);
  const LocalClock clock = local_clock(r.date_s, r.place);
  json periods = json::array();
  for (const SunOutlook& p : r.periods)
    periods.push_back({{"rise", crossing_json(p.rise, r.place)}, {"set", crossing_json(p.set, r.place)}});
  json table = json::array();
  for (const SunRow& row : r.table) table.push_back(row_json(row, r.place));
  const auto ground_off_m = ground_error_m(r.ground);
  return {{"place",
           {{"lon_deg", r.place.lon_deg},
            {"lat_deg", r.place.lat_deg},
            {"height_m", r.height_m},
            {"elevation_m", r.ground.nodata ? json() : json(r.ground.elevation_m)},
            {"datum", r.datum},
            {"post_spacing_m", r.ground.spacing_m},
            {"ground_error_m", ground_off_m ? json(*ground_off_m) : json()},
            {"source", r.source.empty() ? json() : json(r.source)}}},
          {"date", date_text(r.date_s, 2)},
          {"unix_s", r.date_s},
          {"solar_longitude_deg", time.solar_longitude_deg},
          {"msd", time.sol_date},
          {"mtc_h", time.coordinated_time_h},
          {"lmst_h", clock.mean_h},
          {"ltst_h", clock.true_h},
          {"equation_of_time_deg", time.equation_of_time_deg},
          {"distance_au", time.distance_au},
          {"subsolar", {{"lon_deg", time.subsolar_lon_deg}, {"lat_deg", time.subsolar_lat_deg}}},
          {"sun",
           {{"azimuth_deg", r.sun.azimuth_deg},
            {"elevation_deg", r.sun.elevation_deg},
            {"skyline_deg", r.skyline_deg},
            {"seen", r.is_seen},
            {"night", r.sun.elevation_deg < 0}}},
          {"sol",
           {{"number", r.sol.number},
            {"begin", date_text(r.sol.begin_s, 2)},
            {"end", date_text(r.sol.end_s, 2)},
            {"seen_s", r.seen_s}}},
          {"periods", std::move(periods)},
          {"horizon", r.horizon == SunHorizon::kFlat ? "flat" : "terrain"},
          {"limb", limb_name(r)},
          {"disc_radius_deg", r.disc_radius_deg},
          {"refraction", false},
          {"clock", kClockSource},
          {"table", std::move(table)}};
}

}  // namespace vpe::app
