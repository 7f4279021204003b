#include "vpe/app/panorama/commands.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "paging/surface/surface.h"
#include "panorama/metadata/sidecar.h"
#include "vpe/app/cli/digest.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/panorama/panorama_files.h"
#include "vpe/app/panorama/panorama_maker.h"
#include "vpe/app/panorama/panorama_request.h"
#include "vpe/app/panorama/panorama_stereo.h"
#include "vpe/app/picture/fingerprint.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

using Clock = std::chrono::steady_clock;

// Lower, and the camera's own facet fills the image.
constexpr double kLeastHeight_m = 0.01;

void require_drawable(PanoramaRecipe& recipe) {
  if (recipe.backend != "voxel" && recipe.backend != "polygon")
    throw UsageError("backend '" + recipe.backend + "' is not known");
  settle_overlays(recipe);
}

// Elevation of the ground as drawn, and as it is.
struct TerrainQuery {
  double drawn_m = 0;
  double height_m = 0;
};

TerrainQuery ground_below(const std::shared_ptr<const paging::PlanetFile>& planet,
                          const PanoramaRecipe& recipe) {
  const paging::Surface surface(planet, std::size_t{8} << 20);
  const glm::dvec3 direction = mars::direction({recipe.camera.lon_deg, recipe.camera.lat_deg});
  return {surface.at(direction, recipe.settings.values().exaggeration).height_m,
          surface.at(direction).height_m};
}

void place_camera(PanoramaOrder& order, const TerrainQuery& ground) {
  double& alt_m = order.recipe.camera.alt_m;
  if (order.height_m) alt_m = ground.drawn_m + *order.height_m;
  if (alt_m - ground.drawn_m >= kLeastHeight_m) return;
  throw std::runtime_error(
      "the eye is " + base::format_number(std::round(100 * (alt_m - ground.drawn_m)) / 100) +
      " m above the ground, which lies " + base::format_number(std::round(100 * ground.drawn_m) / 100) +
      " m above the sphere there; put it at least " + base::format_number(kLeastHeight_m) +
      " m above (--height, --altitude)");
}

std::string sidecar_text(const PanoramaOrder& order, const PanoramaJob& job, const paging::PlanetMeta& meta,
                         const TerrainQuery& ground, const PanoramaFigures& figures, const Common& common) {
  panorama::Sidecar sidecar;
  sidecar.image = job.output.filename().string();
  sidecar.map = job.map;
  const mars::Pose& camera = order.recipe.camera;
  sidecar.viewpoint =
      panorama::Viewpoint{mars::normalize_lon_deg(camera.lon_deg), camera.lat_deg,  camera.alt_m,
                          camera.alt_m - ground.drawn_m,           ground.height_m, meta.datum};
  auto json = nlohmann::ordered_json::parse(panorama::to_json(sidecar));
  if (const auto& eyes = order.recipe.stereo) {
    if (eyes->layout != core::StereoLayout::kAnaglyph) json["stereo"] = core::to_string(eyes->layout);
    json["eye_base_m"] = eyes->base_m;
  }
  json["radius_m"] = meta.radius_m;
  json["illustration"] = meta.illustration;
  for (const panorama::Plane plane : job.planes) {
    const panorama::PlaneInfo& info = panorama::info_of(plane);
    json["planes"][std::string(info.name)] = {{"file", plane_file(job.output, plane).filename().string()},
                                              {"unit", info.unit},
                                              {"meaning", info.meaning}};
  }
  json["error"] = {{"tile_error_m", figures.geometric_error_m},
                   {"shift_bound_px", figures.shift_bound_px},
                   {"tiles_missing", figures.tiles_missing}};
  json["vpe"] = {{"version", version()}, {"command", common.words}, {"recipe", to_json(order.recipe)}};
  return json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string fingerprint(const PanoramaOrder& order, const PanoramaJob& job, const core::DrawRequest& request,
                        double radius_m) {
  const PanoramaRecipe& recipe = order.recipe;
  core::DrawRequest first = request;
  first.view = panorama::pieces_of(job.map, {recipe.camera, radius_m}, job.strips.front(), 0).front().view;
  Digest digest;
  digest.add(
      fingerprint_of({version(), recipe.identity, recipe.backend, recipe.memory_mb}, first, recipe.settings));
  digest.add(panorama::to_json(panorama::Sidecar{"", job.map, std::nullopt}));
  digest.add(static_cast<std::int64_t>(job.format == PanoramaFormat::kTiff));
  for (const panorama::Plane plane : job.planes) digest.add(panorama::info_of(plane).name);
  if (recipe.stereo) digest.add(to_json(recipe)["stereo"].dump());
  return digest.hex();
}

nlohmann::json report_json(const PanoramaJob& job, const PanoramaMaker& maker, const PanoramaTimes& times,
                           double total_s, const panorama::PanoramaPlan& plan, const std::string& backend) {
  nlohmann::json planes = nlohmann::json::object();
  for (const panorama::Plane plane : job.planes)
    planes[std::string(panorama::info_of(plane).name)] = plane_file(job.output, plane).string();
  nlohmann::json seconds{{"start", times.start},   {"casting", times.casting},   {"shading", times.shading},
                         {"planes", times.planes}, {"encoding", times.encoding}, {"total", total_s}};
  // Rays load tiles in the midst of casting and shading.
  seconds["paging"] = backend == "polygon" ? nlohmann::json(times.paging) : nlohmann::json();
  return {{"output", job.output.string()},
          {"sidecar", sidecar_file(job.output).string()},
          {"planes", planes},
          {"projection", panorama::to_string(job.map.kind)},
          {"width", job.size.width_px},
          {"height", job.size.height_px},
          {"rounded", plan.rounded},
          {"strips_made", maker.made()},
          {"strips_kept", maker.kept()},
          {"shift_bound_px", maker.figures().shift_bound_px},
          {"seconds", seconds}};
}

void make_panorama(const PanoramaArguments& arguments, const Common& common) {
  const auto start = Clock::now();
  const auto seconds = [start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  PanoramaOrder order;
  panorama::PanoramaPlan plan;
  PanoramaJob job;
  try {
    order = arguments.again.empty() ? new_order(arguments, common) : order_again(arguments, common);
    plan = panorama::plan_panorama(order.recipe.plan);
  } catch (const panorama::PlanError& e) {
    throw UsageError(e.what());
  }
  PanoramaRecipe& recipe = order.recipe;
  require_drawable(recipe);
  check_stereo_panorama(order.stereo, recipe);
  std::optional<core::StereoLayout> layout = core::parse_stereo(order.stereo.layout);
  if (recipe.stereo) layout = recipe.stereo->layout;
  // What cannot be written is told before any work.
  job.output = order.output;
  job.format = panorama_format(job.output);
  job.map = plan.map;
  job.planes = recipe.planes;
  job.software = std::string("vpe ") + version();
  job.size = layout ? panorama::size_of_pair(job.map, *layout)
                    : panorama::ImageSize{job.map.width_px, job.map.height_px};
  job.is_red_cyan = layout == core::StereoLayout::kAnaglyph;
  // GPano knows of one image.
  job.has_gpano = job.map.kind != panorama::MapKind::kFacets && (!layout || job.is_red_cyan);
  job.strips = panorama::strips_of(job.size.width_px, job.size.height_px);
  check_panorama_size(job.output, job.size, common.memory_mb);
  for (const panorama::Plane plane : job.planes) check_output(plane_file(job.output, plane));
  check_sidecar(job.output);

  const InterruptGuard guard;
  const auto planet = open_planet(recipe.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  if (!order.again.empty() && recipe.identity != meta.identity) {
    throw std::runtime_error(order.again + ": was made from a planet of identity " + recipe.identity +
                             ", but " +
                             (recipe.planet.empty() ? std::string("the embedded Mars") : recipe.planet) +
                             " has " + meta.identity + "; name the right planet file as PLANET");
  }
  recipe.identity = meta.identity;
  note_illustration(meta, common.quiet);
  if (!common.quiet) {
    for (const std::string& text : plan.rounded) std::fprintf(stderr, "vpe: %s\n", text.c_str());
  }
  const TerrainQuery ground = ground_below(planet, recipe);
  place_camera(order, ground);

  core::DrawRequest request;
  request.settings = recipe.settings.values();
  request.sun = sun_for(request.settings, recipe.camera);
  RenderOptions options = arguments.panorama_image;
  options.backend = recipe.backend;
  options.interest = recipe.interest;
  request.interest = parse_interest(options);
  request.paging.timeout_s = options.wait_s;

  remove_stale_files(job.output);
  base::ThreadPool pool(common.threads);
  PanoramaTimes times;
  const int memory_mb = recipe.memory_mb > 0 ? recipe.memory_mb : common.memory_mb;
  std::unique_ptr<core::Renderer> warm;  // has the ground of the middle already
  const auto renderer = [&](int share_mb) {
    if (warm) return std::move(warm);
    Common share = common;
    share.memory_mb = share_mb;
    return make_renderer(options, share, planet);
  };
  if (layout && !recipe.stereo) {
    warm = renderer(renderer_memory_mb(job, memory_mb));
    recipe.stereo = measure_eyes(order.stereo, recipe, planet->radius_m(), request, *warm);
  }
  if (recipe.stereo) {
    const paging::Surface surface(planet, std::size_t{8} << 20);
    require_eyes_above_ground(recipe, surface, kLeastHeight_m);
  }
  times.start = seconds();
  PanoramaOverlays overlays(recipe, job.map, planet, pool, memory_bytes(common) / 2);
  PanoramaMaker maker(job, recipe, request, fingerprint(order, job, request, planet->radius_m()), planet,
                      renderer, overlays, pool, memory_mb);
  {
    ProgressLine line(common.quiet);
    const auto strips = maker.run(line, times);
    const auto joining = Clock::now();
    job.sidecar = sidecar_text(order, job, meta, ground, maker.figures(), common);
    join_strips(job, strips, pool, [&](double part) {
      InterruptGuard::check();
      line.show("joining", 0.95 + 0.05 * part);
    });
    std::error_code ignored;
    fs::remove_all(strips_folder(job.output), ignored);
    times.encoding += std::chrono::duration<double>(Clock::now() - joining).count();
  }
  if (!common.quiet) warn_of(maker.failures());
  if (common.json) {
    auto report = report_json(job, maker, times, seconds(), plan, recipe.backend);
    if (recipe.stereo) report["eye_base_m"] = recipe.stereo->base_m;
    print_json(report);
  } else if (!common.quiet) {
    std::printf("%s: %s of %lldx%lld pixels in %.1f s, geometry within %.2g px\n", job.output.c_str(),
                panorama::to_string(job.map.kind), static_cast<long long>(job.size.width_px),
                static_cast<long long>(job.size.height_px), seconds(), maker.figures().shift_bound_px);
    if (recipe.stereo) std::printf("eyes %.4g m apart\n", recipe.stereo->base_m);
  }
}

}  // namespace

void add_panorama(CLI::App& program, Common& common) {
  using Limits = panorama::PlanLimits;
  auto arguments = std::make_shared<PanoramaArguments>();
  CLI::App* command = add_command(program, "panorama",
                                  "Draw a panorama; what an interrupted run has drawn is kept", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM; the embedded Mars when left out");
  command->add_option("--at", arguments->at, "LON,LAT of the eye, degrees");
  command->add_option("--height", arguments->height_m, "Of the eye above the ground, metres")
      ->check(number_within(0, 1e10));
  command->add_option("--altitude", arguments->altitude_m, "Of the eye above the sphere, metres")
      ->check(number_within(-1e6, 1e10));
  command->add_option(
      "-o,--output", arguments->output,
      "Picture (.tif of any size, .png, .jpg); its description goes to the same name with .json");
  command->add_option(
      "--projection", arguments->projection,
      "facets, cylinder or equirectangular; cylinder for rays, facets for triangles when left out");
  CLI::Option* facets =
      command->add_option("--facets", arguments->facets, "Planes to the turn, 3 to 64")->capture_default_str();
  const auto is_yaw = number_within(-Limits::kMaxYaw_deg, Limits::kMaxYaw_deg);
  CLI::Option* yaw = command->add_option(
      "--yaw", arguments->yaw_deg, "Azimuth of facet 0's middle, or of a whole turn's left edge, degrees");
  yaw->check(is_yaw)->capture_default_str();
  command->add_option("--from", arguments->from_deg, "Azimuth of the left edge, degrees")->check(is_yaw);
  command->add_option("--to", arguments->to_deg, "Azimuth of the right edge, degrees")->check(is_yaw);
  command->add_option("--elevation", arguments->elevation,
                      "MIN,MAX elevation, degrees; -45,45 or, equirectangular, -90,90 when left out");
  CLI::Option* width =
      command->add_option("--width", arguments->width_px, "Columns of the picture; 4096 when left out");
  command->add_option("--degrees-per-pixel", arguments->degrees_per_pixel, "Degrees of azimuth a column")
      ->excludes(width);
  command->add_option("--planes", arguments->planes,
                      "Also write rasters: any of range,lonlat,elevation,slope,incidence (.tif)");
  command->add_option("--again", arguments->again,
                      "PANO.json: make the same picture again, as it says; goes with PLANET and -o only");
  arguments->panorama_image.backend = kRayBackend;
  add_render_options(*command, arguments->panorama_image);
  add_eye_options(*command, arguments->stereo);
  command->callback([arguments, facets, yaw, &common] {
    arguments->has_facets = facets->count() > 0;
    arguments->has_yaw = yaw->count() > 0;
    make_panorama(*arguments, common);
  });
}

}  // namespace vpe::app
