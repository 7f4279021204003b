#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "paging/surface/query.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/feature_output.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/commands.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/places/places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/explore/measure/profile.h"
#include "vpe/explore/measure/profile_plot.h"
#include "vpe/explore/results/path_results.h"
#include "vpe/report/plots/ground_plot.h"
#include "vpe/report/plots/svg.h"

namespace vpe::app {

namespace {

constexpr std::size_t kMostLimits = 3;

struct ProfileArguments {
  std::vector<std::string> places;
  std::string latitude;
  double step_m = 0;
  std::vector<double> limits_deg;
  std::string plot;
  std::string output;
};

// Writes the profile as SVG.
void write_plot(const explore::Profile& profile, const ProfileArguments& arguments,
                const paging::PlanetMeta& meta) {
  constexpr int kMostColumns = 800;
  const double length_m = profile.points.back().distance_m;
  const bool is_long = length_m >= 10'000;
  const double unit_m = is_long ? 1000 : 1;
  report::GroundPlot plot;
  plot.title = "Profile over " + base::format_significant(length_m / unit_m, 4) + (is_long ? " km" : " m");
  plot.x_label = std::string("distance along the path, ") + (is_long ? "km" : "m");
  plot.y_label = "elevation, m";
  plot.about = "The ground from " + base::format_significant(profile.lowest_m, 5) + " to " +
               base::format_significant(profile.highest_m, 5) + " m.";
  const int count = std::clamp(static_cast<int>(profile.points.size()) - 1, 1, kMostColumns);
  const std::vector<explore::PlotColumn> columns = explore::plot_columns(profile, count);
  for (std::size_t n = 0; n < columns.size(); ++n) {
    const explore::PlotColumn& column = columns[n];
    const double share = length_m / unit_m / static_cast<double>(columns.size());
    plot.columns.push_back({static_cast<double>(n) * share, static_cast<double>(n + 1) * share, column.begin_m,
                            column.end_m, column.low_m, column.high_m, 0, column.nodata});
  }
  for (const paging::ProfilePoint& point : profile.points) {
    const auto at = std::min(
        columns.size() - 1, static_cast<std::size_t>(point.distance_m / length_m * static_cast<double>(count)));
    plot.columns[at].steepness =
        std::max(plot.columns[at].steepness, explore::steepness(point, arguments.limits_deg));
    if (point.waypoint) plot.marks.push_back(point.distance_m / unit_m);
  }
  for (const double limit : arguments.limits_deg)
    plot.limits.push_back("steeper than " + base::format_number(limit) + " degrees");
  const report::PlotInside inside = report::inside_of(plot);
  const report::PlotRange range = report::range_of(plot);
  const double exaggeration = inside.height_px / (range.high - range.low) / (inside.width_px / length_m);
  plot.note = "Datum: " + paging::describe_datum(meta) + ". Vertical exaggeration " +
              base::format_significant(exaggeration, 3) + ". Points at most " +
              base::format_significant(profile.step_m, 3) + " m apart.";
  base::write_file(arguments.plot, report::svg_file(report::to_svg(plot)));
}

void run_profile(const ProfileArguments& arguments, const Common& common) {
  const auto [planet_name, given] = split_places(arguments.places);
  std::vector<mars::LonLat> places;
  if (given.empty()) places = read_places(std::cin).places;
  if (std::max(places.size(), given.size()) < 2)
    throw UsageError("a profile needs at least two places, LON,LAT in degrees");
  if (!std::ranges::is_sorted(arguments.limits_deg) || arguments.limits_deg.size() > kMostLimits)
    throw UsageError("--limit takes at most three slopes, in rising order");
  check_feature_output(arguments.output, planet_name);
  if (!arguments.plot.empty()) {
    if (std::filesystem::path(arguments.plot).extension() != ".svg")
      throw UsageError("--plot writes SVG: give a file that ends in .svg");
    check_outputs({{"--plot", arguments.plot, FileKind::kPlot}}, {planet_name});
  }
  const auto planet = open_planet(planet_name, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  if (given.empty())
    make_planetocentric(places, arguments.latitude, meta, common.quiet);
  else
    places = places_on(given, arguments.latitude, meta, common.quiet);
  const paging::Surface surface(planet, static_cast<std::size_t>(common.memory_mb) << 19);
  explore::Profile profile;
  try {
    profile = explore::make_profile(surface, places, {.step_m = arguments.step_m});
  } catch (const std::invalid_argument& e) {
    throw UsageError(e.what());
  }
  if (!arguments.plot.empty()) write_plot(profile, arguments, meta);
  if (common.json || !arguments.output.empty()) {
    const nlohmann::json result = explore::profile_json(
        profile, explore::ground_of_profile(surface, profile.points), meta, arguments.limits_deg);
    if (!arguments.output.empty())
      mars::write_features(arguments.output, explore::profile_layer(result, places),
                           explore::result_info("profile: the ground along great circles", meta));
    if (common.json) return print_json(result);
  }
  std::fputs(explore::profile_csv_header().c_str(), stdout);
  for (const paging::ProfilePoint& p : profile.points) std::fputs(explore::profile_csv_line(p).c_str(), stdout);
}

}  // namespace

void add_profile(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<ProfileArguments>();
  CLI::App* command =
      add_command(program, "profile", "Print heights, slopes and distances along great circles", common, true);
  command->add_option(
      "PLANET_AND_PLACES", arguments->places,
      "[PLANET] LON,LAT LON,LAT... (degrees east, north, or as 4.6S,222.6W, or names); without places, they are "
      "read from stdin");
  add_latitude_option(*command, arguments->latitude);
  command
      ->add_option("--step", arguments->step_m,
                   "Largest distance between points, metres (default: 1000 points along the profile)")
      ->check(number_within(0.001, 1e7));
  command
      ->add_option(
          "--limit", arguments->limits_deg,
          "Slopes in degrees, in rising order and separated by commas: tell where the ground is steeper")
      ->delimiter(',')
      ->check(number_within(0, 90));
  command->add_option("--plot", arguments->plot, "Also draw the profile (.svg)");
  add_feature_output(*command, arguments->output, "Also write path and points as features");
  add_examples(*command,
               {{"heights every 2 km along a great circle",
                 "vpe profile mars.vpe -70,-13 -60,-14 --step 2000 > profile.csv"},
                {"a way over three places", "vpe profile mars.vpe 137.30,-4.60 137.37,-4.67 137.45,-4.75"},
                {"a plot with the ground that is too steep for a rover",
                 "vpe profile mars.vpe 137.30,-4.60 137.45,-4.75 --limit 15,25 --plot way.svg > way.csv"},
                {"path and points for a geographic information system",
                 "vpe profile mars.vpe 137.30,-4.60 137.45,-4.75 -o way.gpkg > way.csv"}});
  command->callback([arguments, &common] { run_profile(*arguments, common); });
}

}  // namespace vpe::app
