#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
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
#include "vpe/app/contour/commands.h"
#include "vpe/app/contour/grid_report.h"
#include "vpe/app/map/box_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/number.h"
#include "vpe/map/clip_lines.h"
#include "vpe/map/contour/contour.h"

namespace vpe::app {

namespace {

constexpr double kLeastInterval_m = 1e-6;
constexpr double kMostLength_m = 1e7;

// Chosen grids have at most this many posts.
constexpr double kChosenPosts = 16e6;

// Lines straight in degrees follow those of the map within this share of the grid's spacing.
constexpr double kStraightShare = 0.02;

struct ContourArguments {
  std::string planet;
  std::string box;
  double interval_m = 0;
  double base_m = 0;
  std::optional<double> spacing_m;
  double simplify_m = 0;
  std::string output;
};

// Returns directions along the edges of a box: what a local map of it must hold.
std::vector<glm::dvec3> edge_of_box(const map::PlaceBox& box) {
  constexpr int kSteps = 2048;
  std::vector<glm::dvec3> directions;
  const bool is_all_around = box.east_deg - box.west_deg >= 360;
  for (int n = 0; n < kSteps + (is_all_around ? 0 : 1); ++n) {
    const double share = static_cast<double>(n) / kSteps;
    const double lon_deg = box.west_deg + share * (box.east_deg - box.west_deg);
    const double lat_deg = std::min(box.south_deg + share * (box.north_deg - box.south_deg), box.north_deg);
    for (const double edge_deg : {box.south_deg, box.north_deg})
      directions.push_back(mars::direction({lon_deg, edge_deg}));
    if (is_all_around) continue;
    for (const double edge_deg : {box.west_deg, box.east_deg})
      directions.push_back(mars::direction({edge_deg, lat_deg}));
  }
  return directions;
}

double chosen_spacing_m(const paging::PlanetFile& planet, const paging::Surface& surface,
                        const map::PlaceBox& box, const std::vector<glm::dvec3>& edge) {
  const mars::LonLat middle{mars::normalize_lon_deg((box.west_deg + box.east_deg) / 2),
                            (box.south_deg + box.north_deg) / 2};
  const double spacing_m = paging::query(surface, middle).spacing_m;
  const double posts = map::posts_around(edge, spacing_m, spacing_m, planet.radius_m());
  return posts > kChosenPosts ? spacing_m * std::sqrt(posts / kChosenPosts) * 1.001 : spacing_m;
}

struct ContourFile {
  mars::FeatureLayer layer;
  std::int64_t points = 0;
  std::int64_t closed = 0;
  double length_m = 0;
  double lowest_m = 0;
  double highest_m = 0;
};

ContourFile features_of(const std::vector<map::ContourLine>& lines, const map::GridFrame& frame,
                        const map::PlaceBox& box) {
  ContourFile file;
  file.layer.name = "contours";
  file.layer.fields = {"elevation_m"};
  for (const map::ContourLine& line : lines) {
    const std::vector<glm::dvec2> places =
        map::places_of_line(frame, line.points, line.is_closed, kStraightShare * frame.spacing_m);
    for (std::vector<glm::dvec2>& part : map::clip_line(places, box)) {
      mars::Feature feature;
      feature.number = static_cast<std::int64_t>(file.layer.features.size()) + 1;
      feature.values = {line.level_m};
      file.points += static_cast<std::int64_t>(part.size());
      file.closed += part.size() > 2 && part.front() == part.back() ? 1 : 0;
      for (std::size_t n = 1; n < part.size(); ++n)
        file.length_m +=
            frame.map.radius_m() * mars::distance_rad({part[n - 1].x, part[n - 1].y}, {part[n].x, part[n].y});
      if (file.layer.features.empty()) file.lowest_m = line.level_m;
      file.highest_m = line.level_m;
      feature.shapes.push_back({mars::ShapeKind::line, {std::move(part)}});
      file.layer.features.push_back(std::move(feature));
    }
  }
  return file;
}

void report_contours(const ContourFile& file, const map::GridFrame& frame, const map::MapGround& ground,
                     const paging::PlanetMeta& meta, const ContourArguments& a, const Common& common) {
  const std::size_t count = file.layer.features.size();
  if (common.json) {
    nlohmann::json json = grid_json(frame, ground, meta);
    json.update({{"file", a.output},
                 {"interval_m", a.interval_m},
                 {"base_m", a.base_m},
                 {"simplify_m", a.simplify_m},
                 {"lines", count},
                 {"closed_lines", file.closed},
                 {"points", file.points},
                 {"length_m", file.length_m},
                 {"lowest_level_m", count > 0 ? nlohmann::json(file.lowest_m) : nlohmann::json()},
                 {"highest_level_m", count > 0 ? nlohmann::json(file.highest_m) : nlohmann::json()}});
    print_json(json);
    return;
  }
  std::printf("contours:        %s, %zu lines, %lld of them closed, %lld points, %s km\n",
              on_one_line(a.output).c_str(), count, static_cast<long long>(file.closed),
              static_cast<long long>(file.points), base::format_significant(file.length_m / 1000, 6).c_str());
  if (count > 0) {
    std::printf("levels:          %s to %s m, every %s m\n", base::format_number(file.lowest_m).c_str(),
                base::format_number(file.highest_m).c_str(), base::format_number(a.interval_m).c_str());
  }
  std::fputs(grid_text(frame, ground, meta).c_str(), stdout);
}

void run_contour(const ContourArguments& a, const Common& common) {
  const map::PlaceBox box = parse_box(a.box);
  check_feature_output(a.output, a.planet);
  const auto planet = open_planet(a.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  require_planet_of_box(a.box, meta);
  note_illustration(meta, common.quiet);
  const std::vector<glm::dvec3> edge = edge_of_box(box);
  const double spacing_m =
      a.spacing_m ? *a.spacing_m : chosen_spacing_m(*planet, paging::Surface(planet, 16 << 20), box, edge);
  std::optional<map::GridFrame> frame;
  try {
    frame = map::frame_around(edge, spacing_m, spacing_m, meta.radius_m);
  } catch (const std::invalid_argument& e) {
    throw UsageError(std::string("vpe contour: ") + e.what() + "; take a larger --spacing or a smaller --box");
  }
  const InterruptGuard guard;
  ProgressLine line(common.quiet);
  const map::GroundGrid grid = sample_with_progress(planet, *frame, common, line);
  map::ContourOptions options;
  options.interval_m = a.interval_m;
  options.base_m = a.base_m;
  options.tolerance_m = a.simplify_m;
  std::vector<map::ContourLine> lines;
  try {
    lines = map::contours(grid.heights, options, common.threads);
  } catch (const std::logic_error& e) {
    throw std::runtime_error(std::string(e.what()) + " (--interval, --spacing)");
  }
  InterruptGuard::check();
  const ContourFile file = features_of(lines, *frame, box);
  std::string what = "contour: lines of equal height every " + base::format_number(a.interval_m) + " m from " +
                     base::format_number(a.base_m) + " m, higher ground on the right";
  if (a.simplify_m > 0) what += ", simplified within " + base::format_number(a.simplify_m) + " m";
  mars::write_features(a.output, file.layer, feature_info(what, *frame, grid.ground, meta));
  report_contours(file, *frame, grid.ground, meta, a, common);
}

}  // namespace

void add_contour(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<ContourArguments>();
  CLI::App* command =
      add_command(program, "contour", "Write lines of equal height as GeoJSON or GeoPackage", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command
      ->add_option("--box", arguments->box,
                   "WEST,SOUTH,EAST,NORTH, degrees, planetocentric, or the name of a feature")
      ->required();
  command->add_option("--interval", arguments->interval_m, "Metres between levels")
      ->required()
      ->check(number_within(kLeastInterval_m, kMostLength_m));
  command->add_option("--base", arguments->base_m, "A level, metres; the others are whole intervals from it")
      ->check(number_within(-kMostLength_m, kMostLength_m))
      ->capture_default_str();
  command
      ->add_option(
          "--spacing", arguments->spacing_m,
          "Metres between the posts that lines are drawn through (default: that of the planet's posts in the "
          "middle of the box, or more for at most 16 million)")
      ->check(number_within(1e-3, kMostLength_m));
  command
      ->add_option("--simplify", arguments->simplify_m,
                   "Leave out points, but stay within this distance, metres; 0: keep all")
      ->check(number_within(0, kMostLength_m))
      ->capture_default_str();
  add_feature_output(*command, arguments->output)->required();
  add_examples(
      *command,
      {{"lines every 100 m in Gale, for a geographic information system",
        "vpe contour gale.vpe --box 137,-5.5,138.2,-4.3 --interval 100 -o gale.gpkg"},
       {"smoothed lines of a large area, with a summary for programs",
        "vpe contour mars.vpe --box 220,10,235,25 --interval 500 --spacing 2000 --simplify 500 --json -o "
        "olympus.geojson"}});
  command->callback([arguments, &common] { run_contour(*arguments, common); });
}

}  // namespace vpe::app
