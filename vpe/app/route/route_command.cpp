#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <stdexcept>

#include "paging/surface/query.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/feature_output.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/contour/grid_report.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/route/commands.h"
#include "vpe/base/number.h"
#include "vpe/map/route/route.h"

namespace vpe::app {

namespace {

using map::RouteLimits;

constexpr double kMostMargin_m = 1e7;

// Grids whose spacing is not given have at most this many posts.
constexpr double kChosenRoutePosts = 16e6;

// The default margin is this share of the longest leg, but at least so many posts.
constexpr double kMarginShare = 0.5;
constexpr double kLeastMarginPosts = 20;

// Lines straight in degrees follow those of the map within this share of the grid's spacing.
constexpr double kWayStraightShare = 0.02;

struct RouteArguments {
  std::string planet;
  std::string from;
  std::string to;
  std::vector<std::string> via;
  std::string latitude;
  double max_slope_deg = 0;
  std::optional<double> max_cross_slope_deg;
  double slope_weight = map::RouteOptions{}.slope_weight;
  std::optional<double> spacing_m;
  std::optional<double> margin_m;
  std::string output;
};

// Holds the given places in their order, and how messages name them.
struct GivenPlaces {
  std::vector<mars::LonLat> places;
  std::vector<std::string> names;
  std::vector<glm::dvec3> directions;

  std::string name_with_place(std::size_t n) const {
    return names[n] + " (" + base::format_number(places[n].lon_deg) + "," +
           base::format_number(places[n].lat_deg) + ")";
  }
};

GivenPlaces given_places(const RouteArguments& a, const paging::PlanetMeta& meta, bool quiet) {
  GivenPlaces given;
  const auto add = [&](const std::string& text, const std::string& option) {
    given.places.push_back(
        place_on(given_place(option, text), option, a.latitude, meta, quiet || !given.places.empty()));
    given.names.push_back(option);
    given.directions.push_back(mars::direction(given.places.back()));
  };
  add(a.from, "--from");
  for (const std::string& via : a.via) add(via, "--via");
  add(a.to, "--to");
  return given;
}

map::GridFrame frame_of_route(const GivenPlaces& given, const RouteArguments& a,
                              const std::shared_ptr<const paging::PlanetFile>& planet) {
  const double radius_m = planet->radius_m();
  double longest_m = 0;
  for (std::size_t n = 1; n < given.places.size(); ++n)
    longest_m = std::max(longest_m, radius_m * mars::distance_rad(given.places[n - 1], given.places[n]));
  const auto margin_m = [&](double spacing_m) {
    return a.margin_m.value_or(std::max(kMarginShare * longest_m, kLeastMarginPosts * spacing_m));
  };
  double spacing_m = a.spacing_m.value_or(0);
  if (!a.spacing_m) {
    const paging::Surface surface(planet, 16 << 20);
    spacing_m = paging::query(surface, given.places[0]).spacing_m;
    for (const mars::LonLat& place : given.places)
      spacing_m = std::min(spacing_m, paging::query(surface, place).spacing_m);
    const double posts = map::posts_around(given.directions, spacing_m, margin_m(spacing_m), radius_m);
    if (posts > kChosenRoutePosts) spacing_m *= std::sqrt(posts / kChosenRoutePosts) * 1.001;
  }
  try {
    return map::frame_around(given.directions, spacing_m, margin_m(spacing_m), radius_m);
  } catch (const std::invalid_argument& e) {
    throw UsageError(std::string("vpe route: ") + e.what() + "; take a larger --spacing or a smaller --margin");
  }
}

// Returns why there is no way, and what to do.
std::string why_no_way(const map::Route& route, const GivenPlaces& given, const RouteArguments& a) {
  const std::string limit = base::format_number(a.max_slope_deg) + " degrees";
  const std::string name = given.name_with_place(route.at);
  switch (route.outcome) {
    case map::RouteOutcome::no_ground: return "there is no way: at " + name + " is nodata; take another place";
    case map::RouteOutcome::too_steep:
      return "there is no way: the ground at " + name + " is " +
             base::format_fixed(route.steepest_ground_deg, 1) + " degrees steep, and the limit is " + limit +
             "; take another place or a larger --max-slope";
    case map::RouteOutcome::not_connected:
      return "there is no way from " + name + " to " + given.name_with_place(route.at + 1) + " within " +
             limit + ": the ground that can be reached is " +
             base::format_significant(route.reached_m2 / 1e6, 4) +
             " square kilometres large; take a larger --margin or a larger --max-slope";
    case map::RouteOutcome::found: break;
  }
  return {};
}

mars::FeatureLayer route_layer(const map::Route& route, const map::GridFrame& frame) {
  const map::RouteFigures& figures = route.figures;
  std::vector<glm::dvec2> corners(route.posts.begin(), route.posts.end());
  if (corners.size() == 1) corners.push_back(corners[0]);
  mars::FeatureLayer layer;
  layer.name = "route";
  layer.fields = {"length_m", "climb_m", "descent_m", "steepest_deg", "map_length_m", "steepest_ground_deg",
                  "cost_m"};
  mars::Feature feature;
  feature.number = 1;
  feature.values = {figures.length_m,     figures.climb_m,           figures.descent_m, figures.steepest_deg,
                    figures.map_length_m, route.steepest_ground_deg, figures.cost_m};
  feature.shapes.push_back({mars::ShapeKind::line,
                            {map::places_of_line(frame, corners, false, kWayStraightShare * frame.spacing_m)}});
  layer.features.push_back(std::move(feature));
  return layer;
}

void report_route(const map::Route& route, double ends_off_m, const map::GridFrame& frame,
                  const map::MapGround& ground, const paging::PlanetMeta& meta, const RouteArguments& a,
                  const Common& common) {
  const map::RouteFigures& figures = route.figures;
  if (common.json) {
    nlohmann::json json = grid_json(frame, ground, meta);
    nlohmann::json corners = nlohmann::json::array();
    for (const glm::ivec2& post : route.posts) {
      const mars::LonLat place = frame.to_place(post);
      corners.push_back({place.lon_deg, place.lat_deg});
    }
    json.update({{"file", a.output},
                 {"max_slope_deg", a.max_slope_deg},
                 {"max_cross_slope_deg",
                  a.max_cross_slope_deg ? nlohmann::json(*a.max_cross_slope_deg) : nlohmann::json()},
                 {"slope_weight", a.slope_weight},
                 {"length_m", figures.length_m},
                 {"map_length_m", figures.map_length_m},
                 {"climb_m", figures.climb_m},
                 {"descent_m", figures.descent_m},
                 {"steepest_deg", figures.steepest_deg},
                 {"steepest_ground_deg", route.steepest_ground_deg},
                 {"cost_m", figures.cost_m},
                 {"corners", std::move(corners)},
                 {"places_off_m", ends_off_m}});
    print_json(json);
    return;
  }
  const auto metres = [](double value_m) { return base::format_fixed(value_m, 1); };
  std::printf("way:             %s, %zu corners\n", on_one_line(a.output).c_str(), route.posts.size());
  std::printf("length:          %s m over the ground, %s m on the map\n", metres(figures.length_m).c_str(),
              metres(figures.map_length_m).c_str());
  std::printf("climb:           %s m up, %s m down\n", metres(figures.climb_m).c_str(),
              metres(figures.descent_m).c_str());
  std::printf("slope:           at most %s degrees along the way, %s degrees of the ground at corners\n",
              base::format_fixed(figures.steepest_deg, 2).c_str(),
              base::format_fixed(route.steepest_ground_deg, 2).c_str());
  std::printf("cost:            %s m of level ground\n", metres(figures.cost_m).c_str());
  std::printf("places:          the way passes the given ones within %s m\n",
              base::format_significant(ends_off_m, 3).c_str());
  std::fputs(grid_text(frame, ground, meta).c_str(), stdout);
}

void run_route(const RouteArguments& a, const Common& common) {
  check_feature_output(a.output, a.planet);
  (void)given_place("--from", a.from);
  (void)given_place("--to", a.to);
  const auto planet = open_planet(a.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  const GivenPlaces given = given_places(a, meta, common.quiet);
  const map::GridFrame frame = frame_of_route(given, a, planet);
  std::vector<glm::ivec2> posts;
  double off_m = 0;
  for (const mars::LonLat& place : given.places) {
    const glm::dvec2 at = frame.to_grid(place);
    const glm::dvec2 post(std::clamp(std::round(at.x), 0.0, frame.columns - 1.0),
                          std::clamp(std::round(at.y), 0.0, frame.rows - 1.0));
    posts.emplace_back(post);
    off_m = std::max(off_m, glm::length(at - post) * frame.spacing_m);
  }
  const InterruptGuard guard;
  ProgressLine line(common.quiet);
  const map::GroundGrid grid = sample_with_progress(planet, frame, common, line);
  map::RouteOptions options;
  options.max_slope_deg = a.max_slope_deg;
  options.max_cross_slope_deg = a.max_cross_slope_deg;
  options.slope_weight = a.slope_weight;
  const map::Route route =
      map::find_route(grid.heights, posts, options, common.threads, [] { InterruptGuard::check(); });
  if (route.outcome != map::RouteOutcome::found) throw std::runtime_error(why_no_way(route, given, a));
  const std::string what = "route: the way of least cost on slopes up to " +
                           base::format_number(a.max_slope_deg) + " degrees; a metre at that limit costs " +
                           base::format_number(1 + a.slope_weight) + " metres of level ground";
  mars::write_features(a.output, route_layer(route, frame), feature_info(what, frame, grid.ground, meta));
  report_route(route, off_m, frame, grid.ground, meta, a, common);
}

}  // namespace

void add_route(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<RouteArguments>();
  CLI::App* command =
      add_command(program, "route", "Find the way between places that keeps to a slope limit", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command
      ->add_option("--from", arguments->from, "LON,LAT where the way begins, degrees, or the name of the place")
      ->required();
  command->add_option("--to", arguments->to, "LON,LAT where it ends, degrees, or the name of the place")
      ->required();
  command->add_option(
      "--via", arguments->via,
      "LON,LAT or the name of a place to pass on the way; may be given several times, in order");
  command
      ->add_option("--max-slope", arguments->max_slope_deg,
                   "Largest slope along the way and of the ground, degrees")
      ->required()
      ->check(number_within(RouteLimits::kLeastSlope_deg, RouteLimits::kMostSlope_deg));
  command
      ->add_option("--max-cross-slope", arguments->max_cross_slope_deg,
                   "Largest slope across the way, degrees (default: no limit of its own)")
      ->check(number_within(RouteLimits::kLeastSlope_deg, RouteLimits::kMostSlope_deg));
  command
      ->add_option("--slope-weight", arguments->slope_weight,
                   "What a metre at the slope limit costs beyond one on level ground; 0: the shortest way")
      ->check(number_within(0, RouteLimits::kMostWeight))
      ->capture_default_str();
  command
      ->add_option(
          "--spacing", arguments->spacing_m,
          "Metres between the posts that the way is found on (default: that of the planet's posts at the "
          "places, or more for at most 16 million)")
      ->check(number_within(1e-3, kMostMargin_m));
  command
      ->add_option("--margin", arguments->margin_m,
                   "How far beside the places the way may go, metres (default: half of the longest leg)")
      ->check(number_within(0, kMostMargin_m));
  add_latitude_option(*command, arguments->latitude);
  add_feature_output(*command, arguments->output)->required();
  add_examples(
      *command,
      {{"a rover's way on slopes up to 12 degrees",
        "vpe route gale.vpe --from 137.4417,-4.5895 --to 137.40,-4.65 --max-slope 12 -o way.geojson"},
       {"past a place, leaning at most 6 degrees, with its figures for a program",
        "vpe route gale.vpe --from 137.4417,-4.5895 --via 137.43,-4.62 --to 137.40,-4.65 --max-slope 12 "
        "--max-cross-slope 6 --json -o way.gpkg"}});
  command->callback([arguments, &common] { run_route(*arguments, common); });
}

}  // namespace vpe::app
