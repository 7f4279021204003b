// vpe match.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "panorama/match/fit_drawing.h"
#include "panorama/match/place_search.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/match/commands.h"
#include "vpe/app/match/planet_skyline.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

struct MatchArguments {
  std::string photo;
  std::string planet;
  std::string near;
  std::string latitude;
  double height_m = 2;
  std::optional<double> radius_m;
  std::optional<double> fov_deg;
  std::string projection = "perspective";
  std::optional<double> degrees_per_pixel;
  std::optional<double> horizon_row;
  double yaw_tolerance_deg = panorama::MatchOptions{}.yaw_tolerance_deg;
  double attitude_tolerance_deg = panorama::MatchOptions{}.attitude_tolerance_deg;
  std::string output;
};

constexpr double kFine_deg = 0.05;

void check(const MatchArguments& a) {
  (void)given_place("--near", a.near);
  const bool is_round = a.projection != "perspective";
  if (is_round && (!a.degrees_per_pixel || !a.horizon_row))
    throw UsageError(
        "--projection " + a.projection +
        " needs --degrees-per-pixel, and --horizon-row: the row of elevation 0, counted from the upper "
        "edge");
  if (is_round && a.fov_deg)
    throw UsageError("--fov is for perspective photographs; --degrees-per-pixel tells the field of a panorama");
  if (!is_round && (a.degrees_per_pixel || a.horizon_row))
    throw UsageError(
        "--degrees-per-pixel and --horizon-row are for panoramas; add --projection cylinder or equirectangular");
  check_outputs({{"-o", a.output, FileKind::kImage}}, {a.photo, a.planet});
  if (!a.output.empty()) check_image_output(a.output);
}

panorama::PhotoShape shape_of(const MatchArguments& a, const core::RgbImage& photo) {
  panorama::PhotoShape shape{photo.width, photo.height, {}};
  if (a.projection == "perspective") return shape;
  const double turn_px = 360 / *a.degrees_per_pixel;
  shape.map = a.projection == "cylinder"
                  ? panorama::cylinder_map(photo.width, photo.height, turn_px, 0, *a.horizon_row)
                  : panorama::equirectangular_map(photo.width, photo.height, turn_px, 0, *a.horizon_row);
  if (const std::string wrong = panorama::check(*shape.map); !wrong.empty())
    throw UsageError("the panorama " + a.photo + " cannot be described: " + wrong);
  return shape;
}

struct MatchResult {
  mars::Pose pose;
  double distance_m = 0;  // from --near
  panorama::PlaceMatch found;
};

bool has_pose(const panorama::SkylineMatch& match) { return !match.residuals_px.empty(); }

// --pose of vpe render.
std::string pose_text(const mars::Pose& p) {
  char text[200];
  std::snprintf(text, sizeof text, "%.7f,%.7f,%.2f,%.4f,%.4f,%.4f", p.lon_deg, p.lat_deg, p.alt_m, p.yaw_deg,
                p.pitch_deg, p.roll_deg);
  return text;
}

nlohmann::json match_json(const MatchArguments& a, const MatchResult& r, const panorama::SkyLine& line) {
  const panorama::SkylineMatch& m = r.found.match;
  nlohmann::json json{{"found", m.found()},
                      {"photo", a.photo},
                      {"columns", line.columns},
                      {"columns_with_skyline", line.points.size()},
                      {"relief_px", m.relief_px}};
  if (!m.found()) json["reason"] = {{"kind", to_string(m.failure)}, {"text", m.reason}};
  if (!has_pose(m)) return json;
  nlohmann::json pose{{"lon_deg", mars::normalize_lon_deg(r.pose.lon_deg)},
                      {"lat_deg", r.pose.lat_deg},
                      {"alt_m", r.pose.alt_m},
                      {"yaw_deg", r.pose.yaw_deg},
                      {"pitch_deg", r.pose.pitch_deg},
                      {"roll_deg", r.pose.roll_deg}};
  nlohmann::json sigma{
      {"yaw_deg", m.sigma.yaw_deg}, {"pitch_deg", m.sigma.pitch_deg}, {"roll_deg", m.sigma.roll_deg}};
  if (a.projection == "perspective") {
    pose["fov_deg"] = m.pose.fov_deg;
    sigma["fov_deg"] = m.sigma.fov_deg;
    json["render"] = {"--pose", pose_text(r.pose), "--fov", base::format_rounded(m.pose.fov_deg, 4)};
  }
  // A pose that is not sure has another name, so that no script takes it for an answer.
  json[m.found() ? "pose" : "best_pose"] = std::move(pose);
  json["sigma"] = std::move(sigma);
  json["residual_px"] = m.residual_px;
  json["residual_deg"] = m.residual_deg;
  json["within_3_residuals"] = m.within;
  json["likeness"] = m.likeness;
  json["lead"] = m.lead;
  if (a.radius_m) {
    json["place"] = {{"distance_m", r.distance_m}, {"spread_m", r.found.spread_m}, {"tried", r.found.places}};
  }
  return json;
}

void print_match(const MatchArguments& a, const MatchResult& r, const panorama::SkyLine& line) {
  const panorama::SkylineMatch& m = r.found.match;
  std::printf("yaw       %.3f +- %.3f degrees\n", r.pose.yaw_deg, m.sigma.yaw_deg);
  std::printf("pitch     %.3f +- %.3f degrees\n", r.pose.pitch_deg, m.sigma.pitch_deg);
  std::printf("roll      %.3f +- %.3f degrees\n", r.pose.roll_deg, m.sigma.roll_deg);
  if (a.projection == "perspective") {
    std::printf("fov       %.3f", m.pose.fov_deg);
    if (a.fov_deg)
      std::printf(" degrees, as given\n");
    else
      std::printf(" +- %.3f degrees\n", m.sigma.fov_deg);
  }
  if (a.radius_m)
    std::printf("place     %.6f, %.6f, %.0f m from --near; places up to %.0f m away are as good\n",
                r.pose.lon_deg, r.pose.lat_deg, r.distance_m, r.found.spread_m);
  std::printf("residual  %.2f pixels (%.3f degrees); %.0f %% of %zu columns within 3 of these\n", m.residual_px,
              m.residual_deg, 100 * m.within, line.points.size());
  if (a.projection == "perspective") {
    const std::string words = a.planet.empty() ? "vpe render" : "vpe render " + a.planet;
    std::printf("render    %s --pose %s --fov %.4f\n", words.c_str(), pose_text(r.pose).c_str(),
                m.pose.fov_deg);
  }
}

// Of the planet's skylines only those that are needed are computed.
MatchResult find(const MatchArguments& a, const panorama::SkyLine& line, const panorama::PhotoShape& shape,
                 const PlanetSkyline& skyline, ProgressLine& progress) {
  panorama::MatchOptions options;
  options.fov_deg = a.fov_deg.value_or(0);
  options.yaw_tolerance_deg = a.yaw_tolerance_deg;
  options.attitude_tolerance_deg = a.attitude_tolerance_deg;
  MatchResult out;
  if (a.radius_m) {
    out.found = panorama::search_place(
        line, shape, *a.radius_m,
        [&](const glm::dvec2& offset_m, double step_deg) { return skyline.profile(offset_m, step_deg); },
        options,
        [&](double share) {
          InterruptGuard::check();
          progress.show("places", share);
        });
  } else {
    progress.show("skyline", 0);
    const panorama::SkylineProfile profile = skyline.profile({0, 0}, kFine_deg);
    progress.show("attitudes", 0.5);
    out.found.places = 1;
    out.found.match = panorama::match_skyline(line, shape, profile, options);
  }
  out.pose = skyline.pose(out.found.offset_m);
  out.pose.yaw_deg = out.found.match.pose.yaw_deg;
  out.pose.pitch_deg = out.found.match.pose.pitch_deg;
  out.pose.roll_deg = out.found.match.pose.roll_deg;
  out.distance_m = std::hypot(out.found.offset_m.x, out.found.offset_m.y);
  return out;
}

void match(const MatchArguments& a, const Common& common) {
  const InterruptGuard guard;
  check(a);
  const core::RgbImage photo = core::read_image(a.photo);
  const panorama::PhotoShape shape = shape_of(a, photo);
  panorama::SkyLine line;
  try {
    line = panorama::find_sky_line(photo);
  } catch (const std::invalid_argument& e) {
    throw std::runtime_error("cannot match " + a.photo + ": " + e.what() + "; give a larger one");
  }
  const auto planet = open_planet(a.planet, common);
  note_illustration(planet->meta(), common.quiet);
  const paging::Surface surface(planet, memory_bytes(common));
  const mars::LonLat near =
      place_on(given_place("--near", a.near), "--near", a.latitude, planet->meta(), common.quiet);
  base::ThreadPool pool(common.threads);
  const PlanetSkyline skyline(surface, near, a.height_m, pool);
  MatchResult result;
  {
    ProgressLine progress(common.quiet);
    result = find(a, line, shape, skyline, progress);
    if (!a.output.empty()) {
      const core::RgbImage drawn = panorama::draw_fit(photo, shape, line, result.found.match,
                                                      skyline.profile(result.found.offset_m, kFine_deg));
      core::write_image(a.output, drawn.pixels, drawn.width, drawn.height);
    }
  }
  const panorama::SkylineMatch& found = result.found.match;
  if (common.json) print_json(match_json(a, result, line));
  if (!found.found())
    throw std::runtime_error(a.photo + ": not found: " + found.reason +
                             (a.output.empty() ? "; -o FIT.png shows the skylines" : ""));
  if (!common.json && !common.quiet) print_match(a, result, line);
}

}  // namespace

void add_match(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<MatchArguments>();
  CLI::App* command =
      add_command(program, "match", "Find how a photograph was taken, from its skyline", common, true);
  command->add_option("PHOTO", arguments->photo, "Photograph or mosaic (.png, .jpg)")->required();
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option("--near", arguments->near, "LON,LAT of the camera, degrees, or the name of its place")
      ->required();
  add_latitude_option(*command, arguments->latitude);
  command->add_option("--height", arguments->height_m, "Height of the camera above the ground, metres")
      ->check(number_within(0.001, 1e7))
      ->capture_default_str();
  command
      ->add_option("--radius", arguments->radius_m,
                   "Also find the place, within this distance of --near, metres")
      ->check(number_within(panorama::kLeastRadius_m, panorama::kMostRadius_m));
  command->add_option("--fov", arguments->fov_deg, "Vertical field of view, degrees (default: it is found)")
      ->check(number_within(1, 150));
  command
      ->add_option("--projection", arguments->projection,
                   "perspective, or of a panorama: cylinder, or equirectangular (what JPL calls CYLINDRICAL)")
      ->check(CLI::IsMember({"perspective", "cylinder", "equirectangular"}))
      ->capture_default_str();
  command
      ->add_option("--degrees-per-pixel", arguments->degrees_per_pixel,
                   "Degrees of azimuth to a column of a panorama")
      ->check(number_within(1e-4, 10));
  command
      ->add_option("--horizon-row", arguments->horizon_row,
                   "Row of elevation 0 of a panorama, from the upper edge, pixels")
      ->check(number_within(-1e6, 1e6));
  command
      ->add_option("--yaw-tolerance", arguments->yaw_tolerance_deg,
                   "Largest error of yaw that is accepted as found (2.5 standard deviations), degrees")
      ->check(number_within(1e-4, 10))
      ->capture_default_str();
  command
      ->add_option("--attitude-tolerance", arguments->attitude_tolerance_deg,
                   "The same for pitch and roll, degrees")
      ->check(number_within(1e-4, 10))
      ->capture_default_str();
  command->add_option(
      "-o,--output", arguments->output,
      "Picture of the fit (.png, .jpg): the photograph, its skyline in blue, the planet's in orange");
  add_examples(
      *command,
      {{"attitude and field of view", "vpe match photo.jpg gale.vpe --near 137.37024,-4.66798 -o fit.png"},
       {"with the place, within 200 m",
        "vpe match photo.jpg gale.vpe --near 137.37,-4.668 --radius 200 --fov 38 -o fit.png"},
       {"a rover's mosaic",
        "vpe match mosaic.jpg gale.vpe --near 137.37024,-4.66798 --height 1.97 --projection equirectangular "
        "--degrees-per-pixel 0.046777 --horizon-row 378.76 --json"}});
  command->callback([arguments, &common] { match(*arguments, common); });
}

}  // namespace vpe::app
