// vpe horizon.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/panorama/commands.h"
#include "vpe/app/panorama/horizon_files.h"
#include "vpe/app/panorama/horizon_objects.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/scene/scene_library.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/gazetteer.h"
#include "vpe/voxel/cast/range_caster.h"

namespace vpe::app {

namespace {

struct HorizonArguments {
  std::string planet;
  std::string at;
  std::string latitude;
  std::optional<double> height_m;
  std::optional<double> altitude_m;
  double from_deg = 0;
  double to_deg = 360;
  double step_deg = 0.1;
  std::string output;
  std::string names;
  std::string features;
  double within_m = 0;  // 0: as far as terrain can be visible at all
  std::string landscape;
  std::string scene;
};

constexpr double kLeastStep_deg = 0.0001;
// Well above rounding errors.
constexpr double kLeastHeight_m = 0.001;
// Limits of the range image that brackets the skyline; within them it has a column for each azimuth.
constexpr double kLeastColumns = 720;
constexpr double kMostColumns = 14400;
constexpr int kRows = 1800;          // a tenth of a degree each
constexpr double kImageShare = 0.3;  // of the progress

bool is_full_turn(const HorizonArguments& a) { return a.to_deg - a.from_deg >= 360.0; }

std::vector<double> azimuths_of(const HorizonArguments& a) {
  const double span = is_full_turn(a) ? 360.0 : a.to_deg - a.from_deg;
  // An azimuth that misses the end by rounding only is the end.
  auto count = static_cast<std::size_t>(std::floor(span / a.step_deg * (1 + 1e-12))) + 1;
  if (is_full_turn(a) && span - static_cast<double>(count - 1) * a.step_deg < 1e-9 * a.step_deg * 360) --count;
  std::vector<double> out(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double azimuth = a.from_deg + static_cast<double>(k) * a.step_deg;
    // Decimal steps give decimal azimuths.
    out[k] = std::round(1e9 * (azimuth - 360.0 * std::floor(azimuth / 360.0))) / 1e9;
    if (out[k] >= 360.0) out[k] = 0;
  }
  return out;
}

void check(const HorizonArguments& a) {
  (void)given_place("--at", a.at);
  if (a.height_m.has_value() == a.altitude_m.has_value())
    throw UsageError("give either --height (metres above the ground) or --altitude (metres above the sphere)");
  if (!(a.to_deg > a.from_deg))
    throw UsageError("--to must be larger than --from; across north: --from -20 --to 20");
  if (!a.landscape.empty() && !is_full_turn(a))
    throw UsageError("--landscape needs the full circle; leave out --from and --to");
  if (!a.features.empty() && a.names.empty()) throw UsageError("--features requires --names FILE");
  if (a.output.empty() && a.features.empty() && a.landscape.empty())
    throw UsageError("nothing to write; give -o SKYLINE.csv");
  std::vector<Output> outputs{{"-o", a.output, FileKind::kSkyline},
                              {"--features", a.features, FileKind::kLandmarks}};
  if (!a.landscape.empty()) {
    make_folder(a.landscape);
    const auto files = landscape_files(a.landscape);
    outputs.insert(outputs.end(), files.begin(), files.end());
  }
  check_outputs(outputs, {a.planet, a.names, a.scene});
}

// Ranges of the arc, with a column more on each side.
struct RangeView {
  core::View view;
  std::vector<float> range_m;
};

RangeView cast_ranges(const voxel::RangeCaster& caster, const HorizonArguments& a, const mars::Pose& pose,
                      base::ThreadPool& pool) {
  RangeView out;
  core::View& view = out.view;
  view.projection = core::Projection::kEquirectangular;
  view.fov_deg = 180;
  view.width = static_cast<int>(std::clamp(std::ceil(360.0 / a.step_deg), kLeastColumns, kMostColumns));
  view.height = kRows;
  mars::Pose middle = pose;
  middle.yaw_deg = 0.5 * (a.from_deg + a.to_deg);
  view.camera = mars::to_camera(middle, caster.surface().planet_radius_m());
  if (!is_full_turn(a)) {
    const double columns = view.width * (a.to_deg - a.from_deg) / 360.0;
    const int half = std::min(view.width / 2, static_cast<int>(std::ceil(0.5 * columns)) + 1);
    view.part = {view.width / 2 - half, 0, 2 * half, kRows};
  }
  const glm::ivec2 size = core::drawn_size(view);
  out.range_m.resize(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  voxel::SectorCaster sectors;
  caster.cast(view, {}, pool, out.range_m, sectors);
  return out;
}

std::vector<panorama::GroundPoint> trace(const panorama::Viewpoint& camera, const std::vector<double>& azimuths,
                                         const panorama::RangeImage& image, const panorama::GroundRange& range,
                                         base::ThreadPool& pool, ProgressLine& progress) {
  constexpr std::size_t kPieces = 50;
  const std::size_t piece = std::max<std::size_t>(64, azimuths.size() / kPieces);
  const auto first = panorama::first_brackets(image, azimuths);
  std::vector<panorama::GroundPoint> out;
  for (std::size_t begin = 0; begin < azimuths.size(); begin += piece) {
    InterruptGuard::check();
    const double done = static_cast<double>(begin) / static_cast<double>(azimuths.size());
    progress.show("skyline", kImageShare + (1 - kImageShare) * done);
    const std::size_t count = std::min(piece, azimuths.size() - begin);
    const auto points = panorama::skyline(camera, std::span(azimuths).subspan(begin, count), range, pool,
                                          std::span(first).subspan(begin, count));
    out.insert(out.end(), points.begin(), points.end());
  }
  return out;
}

// Returns a length in metres for people, to a centimetre.
std::string short_length(double metres) { return base::format_rounded(metres, 2); }

std::string describe(const panorama::GroundPoint& p) {
  char text[160];
  std::snprintf(text, sizeof text, "azimuth %.2f, elevation %.2f, at %.2f km (%.5f, %.5f, %.0f m)",
                p.direction.azimuth_deg, p.direction.elevation_deg, p.range_m / 1000, p.place.lon_deg,
                p.place.lat_deg, p.elevation_m);
  return text;
}

struct Camera {
  mars::Pose pose;
  double height_m = 0;  // above the ground
};

Camera camera_of(const HorizonArguments& a, const paging::Surface& surface, const paging::PlanetMeta& meta,
                 bool quiet) {
  const mars::LonLat place = place_on(given_place("--at", a.at), "--at", a.latitude, meta, quiet);
  const double ground_m = surface.at(mars::direction(place)).height_m;
  Camera camera{{place.lon_deg, place.lat_deg, 0, 0, 0, 0},
                a.height_m ? *a.height_m : *a.altitude_m - ground_m};
  camera.pose.alt_m = a.altitude_m ? *a.altitude_m : ground_m + camera.height_m;
  if (camera.height_m < kLeastHeight_m) {
    throw std::runtime_error(
        "the camera at " + a.at + " is " + short_length(camera.height_m) + " m above the ground, which lies " +
        short_length(ground_m) + " m above the sphere there; put it at least " +
        base::format_number(kLeastHeight_m) + " m above the ground (--height, --altitude)");
  }
  return camera;
}

struct HorizonResult {
  mars::Pose pose;
  double height_m = 0;  // of the camera above the ground
  std::vector<panorama::GroundPoint> points;
  std::vector<panorama::Landmark> landmarks;
  panorama::GroundPoint farthest;
  std::vector<std::string> objects;  // of the points, "" for ground; empty: there is no scene

  std::int64_t visible() const {
    return std::count_if(landmarks.begin(), landmarks.end(), [](const auto& l) { return !l.hidden_by; });
  }
  std::int64_t hidden() const { return static_cast<std::int64_t>(landmarks.size()) - visible(); }
  std::pair<panorama::GroundPoint, panorama::GroundPoint> lowest_and_highest() const {
    const auto by_elevation = [](const auto& p, const auto& q) {
      return p.direction.elevation_deg < q.direction.elevation_deg;
    };
    const auto [lowest, highest] = std::minmax_element(points.begin(), points.end(), by_elevation);
    return {*lowest, *highest};
  }
};

void write_results(const HorizonArguments& a, const paging::PlanetMeta& meta, const HorizonResult& result) {
  if (!a.output.empty()) base::write_file(a.output, skyline_csv(result.points, result.objects));
  if (!a.features.empty()) base::write_file(a.features, landmarks_csv(result.landmarks));
  if (a.landscape.empty()) return;
  const mars::LonLat place{result.pose.lon_deg, result.pose.lat_deg};
  const std::string name = base::format_number(place.lon_deg) + ", " + base::format_number(place.lat_deg);
  write_landscape(a.landscape, {"Horizon at " + name, meta.body, place, result.pose.alt_m}, result.points);
}

nlohmann::json summary_json(const HorizonArguments& a, const paging::PlanetMeta& meta,
                            const paging::Surface& surface, const HorizonResult& result) {
  const auto nodata = std::count_if(result.points.begin(), result.points.end(),
                                    [&](const auto& p) { return surface.at(mars::direction(p.place)).nodata; });
  const auto of_objects = std::count_if(result.objects.begin(), result.objects.end(),
                                        [](const std::string& name) { return !name.empty(); });
  const auto [lowest, highest] = result.lowest_and_highest();
  nlohmann::json json{{"eye",
                       {{"lon_deg", mars::normalize_lon_deg(result.pose.lon_deg)},
                        {"lat_deg", result.pose.lat_deg},
                        {"alt_m", result.pose.alt_m},
                        {"height_m", result.height_m}}},
                      {"datum", to_string(meta.datum)},
                      {"radius_m", meta.radius_m},
                      {"illustration", meta.illustration},
                      {"azimuths", result.points.size()},
                      {"azimuths_over_ground_without_data", nodata},
                      {"highest", point_json(highest)},
                      {"lowest", point_json(lowest)},
                      {"farthest", point_json(result.farthest)}};
  if (!a.scene.empty()) json["azimuths_of_objects"] = of_objects;
  if (!a.names.empty()) {
    nlohmann::json list = nlohmann::json::array();
    for (const panorama::Landmark& l : result.landmarks) list.push_back(landmark_json(l));
    json["features_visible"] = result.visible();
    json["features_hidden"] = result.hidden();
    json["features"] = std::move(list);
  }
  return json;
}

void print_summary(const HorizonArguments& a, const HorizonResult& result) {
  const auto [lowest, highest] = result.lowest_and_highest();
  std::printf("%zu azimuths from %s m above the ground\n", result.points.size(),
              short_length(result.height_m).c_str());
  std::printf("highest   %s\n", describe(highest).c_str());
  std::printf("lowest    %s\n", describe(lowest).c_str());
  std::printf("farthest  %s\n", describe(result.farthest).c_str());
  if (!a.names.empty()) {
    std::printf("features  %lld visible, %lld hidden\n", static_cast<long long>(result.visible()),
                static_cast<long long>(result.hidden()));
  }
}

void horizon(const HorizonArguments& a, const Common& common) {
  const InterruptGuard guard;
  check(a);
  std::vector<core::Place> names;
  if (!a.names.empty()) names = core::read_gazetteer(a.names);
  const auto planet = open_planet(a.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  note_illustration(meta, common.quiet);
  const voxel::RangeCaster caster(planet, memory_bytes(common));
  const paging::Surface& surface = caster.surface();
  const auto [pose, height_m] = camera_of(a, surface, planet->meta(), common.quiet);
  const mars::LonLat place{pose.lon_deg, pose.lat_deg};
  const panorama::Viewpoint camera = panorama::viewpoint_at(place, pose.alt_m, planet->radius_m());
  const panorama::GroundRange range = [&](const glm::dvec3& ray) {
    return surface.cast(camera.position_m, ray);
  };
  std::optional<HorizonObjects> things;
  if (!a.scene.empty()) {
    SceneLibrary library(surface);
    things = HorizonObjects{library.scene(a.scene, 1, 0).scene, camera};
    if (!common.quiet) {
      for (const std::string& note : library.take_notes())
        std::fprintf(stderr, "vpe: note: %s\n", note.c_str());
    }
  }
  base::ThreadPool pool(common.threads);

  std::vector<panorama::GroundPoint> points;
  std::vector<panorama::Landmark> seen;
  panorama::GroundPoint farthest;
  std::vector<std::string> of_objects;
  {
    ProgressLine progress(common.quiet);
    progress.show("ranges", 0);
    const RangeView image = cast_ranges(caster, a, pose, pool);
    const panorama::RangeImage ranges{panorama::map_of(image.view), image.range_m};
    points = trace(camera, azimuths_of(a), ranges, range, pool, progress);
    InterruptGuard::check();
    farthest = panorama::farthest_ground(camera, ranges, points, range, pool);
    InterruptGuard::check();
    if (!names.empty()) {
      const double within_m = a.within_m > 0 ? a.within_m
                                             : panorama::farthest_sight_m(planet->radius_m() + pose.alt_m,
                                                                          planet->tree().lowest_radius_m(1.0),
                                                                          meta.highest_radius_m);
      seen = panorama::landmarks(
          camera, names, within_m, [&](const glm::dvec3& d) { return surface.at(d).radius_m; },
          [&](const glm::dvec3& ray) { return things ? things->range_m(ray, range(ray)) : range(ray); }, pool);
      InterruptGuard::check();
      if (things) things->name_hiders(seen);
    }
    if (things) of_objects = things->raise(points, pool);
    progress.show("skyline", 1);
  }

  const HorizonResult result{
      pose, height_m, std::move(points), std::move(seen), farthest, std::move(of_objects)};
  write_results(a, meta, result);
  if (common.json) {
    print_json(summary_json(a, meta, surface, result));
  } else if (!common.quiet) {
    print_summary(a, result);
  }
}

}  // namespace

void add_horizon(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<HorizonArguments>();
  CLI::App* command = add_command(
      program, "horizon", "Compute the skyline, the farthest visible ground and hidden features of a place",
      common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option("--at", arguments->at, "LON,LAT of the camera, degrees, or the name of its place")
      ->required();
  add_latitude_option(*command, arguments->latitude);
  command->add_option("--height", arguments->height_m, "Height of the camera above the ground, metres")
      ->check(number_within(0, 1e10));
  command->add_option("--altitude", arguments->altitude_m, "Altitude of the camera above the sphere, metres")
      ->check(number_within(-1e6, 1e10));
  command->add_option(
      "-o,--output", arguments->output,
      "Skyline to write (.csv): azimuth, elevation, range, longitude, latitude, elevation of the ground");
  command->add_option("--from", arguments->from_deg, "First azimuth, degrees clockwise from north")
      ->check(number_within(-360, 720))
      ->capture_default_str();
  command->add_option("--to", arguments->to_deg, "Last azimuth, degrees; a full circle ends before it")
      ->check(number_within(-360, 720))
      ->capture_default_str();
  command->add_option("--step", arguments->step_deg, "Step between azimuths, degrees")
      ->check(number_within(kLeastStep_deg, 90))
      ->capture_default_str();
  command->add_option(
      "--names", arguments->names,
      "Named features (.csv: name, lon, lat, diameter_km) to find visible, or hidden and by what");
  command->add_option("--features", arguments->features,
                      "Table to write (.csv): which features of --names are visible");
  command
      ->add_option("--within", arguments->within_m,
                   "Take features at most this far away, metres (default: as far as ground can be visible)")
      ->check(number_within(1, 1e11));
  command->add_option("--landscape", arguments->landscape,
                      "Folder to make: the skyline as a Stellarium landscape");
  command->add_option(
      "--scene", arguments->scene,
      "Objects on the ground (*.scene.toml or GeoJSON) that rise above the skyline and hide features");
  add_examples(
      *command,
      {{"the skyline from eye height", "vpe horizon mars.vpe --at -59.2,-13.7 --height 2 -o skyline.csv"},
       {"an arc across north, finely",
        "vpe horizon mars.vpe --at -59.2,-13.7 --height 2 --from -20 --to 20 --step 0.01 -o north.csv"},
       {"which named features can be seen, and what hides the others",
        "vpe horizon mars.vpe --at -59.2,-13.7 --height 2 --names names.csv --features seen.csv"},
       {"with the objects of a scene",
        "vpe horizon mars.vpe --at 137.4418,-4.5895 --height 2 --scene gale.scene.toml -o skyline.csv"}});
  command->callback([arguments, &common] { horizon(*arguments, common); });
}

}  // namespace vpe::app
