// vpe sun.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <variant>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/measured_part.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/sun/commands.h"
#include "vpe/app/sun/sun_report.h"

namespace vpe::app {

namespace {

struct SunArguments {
  std::string planet;
  std::string at;
  std::string latitude;
  std::string date;
  double height_m = 2;
  std::string horizon = "terrain";
  std::string limb = "centre";
  std::optional<double> table_min;
};

constexpr double kLeastEye_m = 0.001;
constexpr double kLeastTable_min = 0.1;
constexpr double kMostTable_min = 1440;

mars::UnixSeconds date_of(const SunArguments& a) {
  const auto spec = mars::parse_sun(a.date);
  if (!spec) throw UsageError("--date '" + a.date + "': " + mars::sun_problem(a.date));
  const auto* date = std::get_if<mars::SunDate>(&*spec);
  if (date == nullptr) throw UsageError("--date '" + a.date + "': expected a date, as 2026-11-27T12:00Z");
  return date->time_s;
}

SunCrossing crossing(mars::UnixSeconds time_s, mars::LonLat place, const SunSky& sky) {
  return {time_s, mars::sun_at(time_s, place), sky.ridge(time_s)};
}

std::vector<SunOutlook> outlooks(const std::vector<mars::SunPeriod>& periods, mars::LonLat place,
                                 const SunSky& sky) {
  std::vector<SunOutlook> out;
  for (const mars::SunPeriod& p : periods) {
    SunOutlook& outlook = out.emplace_back();
    if (p.rises) outlook.rise = crossing(p.rise_s, place, sky);
    if (p.sets) outlook.set = crossing(p.set_s, place, sky);
  }
  return out;
}

std::vector<SunRow> table_of(double step_min, const mars::Sol& sol, mars::LonLat place, const SunSky& sky) {
  std::vector<SunRow> out;
  for (int n = 0;; ++n) {
    InterruptGuard::check();
    const mars::UnixSeconds time_s = sol.begin_s + n * 60 * step_min;
    if (!(time_s <= sol.end_s)) return out;
    const mars::SunPosition sun = mars::sun_at(time_s, place);
    out.push_back({time_s, sun, sky.skyline_deg(sun.azimuth_deg), sky.is_seen(sun)});
  }
}

SunReport report_of(const SunArguments& a, mars::UnixSeconds date_s, mars::LonLat place,
                    const paging::Surface& surface) {
  const paging::PlanetMeta& meta = surface.planet().meta();
  SunReport r;
  r.place = place;
  r.height_m = a.height_m;
  r.ground = paging::query(surface, place);
  r.datum = to_string(meta.datum);
  if (const mars::SourceInfo* source = source_of(r.ground, meta)) r.source = source->name;
  r.horizon = a.horizon == "flat" ? SunHorizon::kFlat : SunHorizon::kTerrain;
  r.is_upper_limb = a.limb == "upper";
  r.date_s = date_s;
  r.disc_radius_deg = mars::sun_radius_deg(mars::mars_time(date_s).distance_au);
  const double alt_m = surface.at(mars::direction(place)).height_m + a.height_m;
  const SunSky sky(surface, panorama::viewpoint_at(place, alt_m, surface.planet_radius_m()), r.horizon,
                   r.is_upper_limb ? r.disc_radius_deg : 0);
  r.sun = mars::sun_at(date_s, place);
  r.skyline_deg = sky.skyline_deg(r.sun.azimuth_deg);
  r.is_seen = sky.is_seen(r.sun);
  r.sol = mars::local_sol(date_s, place.lon_deg);
  const auto seen = [&](const mars::SunPosition& sun) {
    InterruptGuard::check();
    return sky.is_seen(sun);
  };
  const auto periods = mars::sun_periods(place, r.sol.begin_s, r.sol.end_s, seen);
  r.seen_s = mars::seen_s(periods);
  r.periods = outlooks(periods, place, sky);
  if (a.table_min) r.table = table_of(*a.table_min, r.sol, place, sky);
  return r;
}

void sun(const SunArguments& a, const Common& common) {
  const InterruptGuard guard;
  const mars::UnixSeconds date_s = date_of(a);
  const GivenPlace given = given_place("--at", a.at);
  const auto planet = open_planet(a.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  if (meta.body != "Mars")
    throw UsageError("vpe sun: the clock and the sun's place are known for Mars only, and this is " +
                     meta.body);
  note_illustration(meta, common.quiet);
  const mars::LonLat place = place_on(given, "--at", a.latitude, meta, common.quiet);
  const paging::Surface surface(planet, static_cast<std::size_t>(common.memory_mb) << 19);
  const SunReport report = report_of(a, date_s, place, surface);
  if (common.json) {
    print_json(to_json(report));
  } else {
    std::fputs(to_text(report).c_str(), stdout);
  }
}

}  // namespace

void add_sun(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<SunArguments>();
  CLI::App* command = add_command(
      program, "sun", "Print clock, sun, rise and set over the skyline of a place on Mars", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option("--at", arguments->at, "LON,LAT of the place, degrees, or its name")->required();
  command->add_option("--date", arguments->date, "Date, as 2026-11-27T12:00Z; the answer is about its sol")
      ->required();
  add_latitude_option(*command, arguments->latitude);
  command->add_option("--height", arguments->height_m, "Height of the eye above the ground, metres")
      ->check(number_within(kLeastEye_m, 1e10))
      ->capture_default_str();
  command
      ->add_option("--horizon", arguments->horizon,
                   "What hides the sun: terrain, or flat for the horizontal plane")
      ->check(CLI::IsMember({"terrain", "flat"}))
      ->capture_default_str();
  command->add_option("--limb", arguments->limb, "Point of the disc that rises and sets: centre or upper")
      ->check(CLI::IsMember({"centre", "upper"}))
      ->capture_default_str();
  command
      ->add_option("--table", arguments->table_min,
                   "Print a table of the sol, from LMST 00:00, with a row each so many minutes of 60 s")
      ->check(number_within(kLeastTable_min, kMostTable_min));
  add_examples(*command,
               {{"the sun in Gale", "vpe sun mars.vpe --at 137.44,-4.59 --date 2026-11-27T12:00Z"},
                {"a table of the sol, every half hour",
                 "vpe sun mars.vpe --at 137.44,-4.59 --date 2026-11-27 --table 30"},
                {"without terrain, for the upper limb",
                 "vpe sun mars.vpe --at 137.44,-4.59 --date 2026-11-27 --horizon flat --limb upper"}});
  command->callback([arguments, &common] { sun(*arguments, common); });
}

}  // namespace vpe::app
