// vpe panorama.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "mars/sources/synthetic.h"
#include "paging/surface/surface.h"
#include "panorama/metadata/sidecar.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/panorama/commands.h"
#include "vpe/app/panorama/panorama_files.h"
#include "vpe/app/panorama/panorama_maker.h"
#include "vpe/app/panorama/panorama_page.h"
#include "vpe/app/panorama/panorama_plan.h"
#include "vpe/app/panorama/panorama_request.h"
#include "vpe/app/panorama/panorama_scene.h"
#include "vpe/app/panorama/panorama_stereo.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/layer_check.h"
#include "vpe/app/picture/sun_statement.h"
#include "vpe/app/picture/view_palette.h"
#include "vpe/app/places/named_places.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/number.h"
#include "vpe/core/json_text.h"

namespace vpe::app {

namespace {

using SteadyClock = std::chrono::steady_clock;

double elapsed_s(SteadyClock::time_point start) {
  return std::chrono::duration<double>(SteadyClock::now() - start).count();
}

// Lower, the facet below the camera fills the image.
constexpr double kLeastPanoramaHeight_m = 0.01;
// Memory of a surface that answers a few questions.
constexpr std::size_t kSmallSurfaceBytes = std::size_t{8} << 20;

// Elevation below the camera, above the sphere.
struct Ground {
  double drawn_m = 0;   // with exaggeration
  double height_m = 0;  // without
};

Ground ground_below(const std::shared_ptr<const paging::PlanetFile>& planet, const PanoramaRequest& request) {
  const paging::Surface surface(planet, kSmallSurfaceBytes);
  const glm::dvec3 direction = mars::direction({request.camera.lon_deg, request.camera.lat_deg});
  return {surface.at(direction, request.settings.values().exaggeration).height_m,
          surface.at(direction).height_m};
}

void check_identity(const PanoramaRequest& request, const std::string& identity) {
  if (request.from_sidecar.empty() || request.identity == identity) return;
  throw std::runtime_error(request.from_sidecar + ": was made from a planet of identity " + request.identity +
                           ", but " +
                           (request.planet.empty() ? std::string("the embedded Mars") : request.planet) +
                           " has " + identity + "; name the right planet file as PLANET");
}

void place_camera(PanoramaRequest& request, const Ground& ground) {
  double& alt_m = request.camera.alt_m;
  if (request.height_m) alt_m = ground.drawn_m + *request.height_m;
  const double height_m = alt_m - ground.drawn_m;
  if (height_m >= kLeastPanoramaHeight_m) return;
  throw std::runtime_error("the camera is " + base::format_rounded(height_m, 2) +
                           " m above the ground, which lies " + base::format_rounded(ground.drawn_m, 2) +
                           " m above the sphere there; put it at least " +
                           base::format_number(kLeastPanoramaHeight_m) + " m above (--height, --altitude)");
}

core::DrawRequest draw_request_for(const PanoramaRequest& request) {
  core::DrawRequest out;
  out.settings = request.settings.values();
  out.sun = sun_for(out.settings, request.camera);
  const RenderOptions options = render_options(request);
  out.interest = parse_interest(options);
  out.paging.timeout_s = options.wait_s;
  return out;
}

// Takes the ends of the palette from all that the panorama shows, if the settings say so. The recipe has the
// numbers.
void take_palette_of_panorama(PanoramaRequest& request, const std::shared_ptr<const paging::PlanetFile>& planet,
                              const Common& common) {
  constexpr std::int64_t kWidest_px = 960;
  if (!needs_view_palette(request.settings.values(), *planet)) return;
  panorama::PlanOptions options = request.map;
  options.degrees_per_pixel.reset();
  options.width_px = std::min(kWidest_px, panorama::plan_panorama(request.map).map.width_px);
  const panorama::PanoramaMap map = panorama::plan_panorama(options).map;
  const panorama::Viewpoint viewpoint = panorama::viewpoint_of(request.camera, planet->radius_m());
  core::DrawRequest sample;
  sample.settings = request.settings.values();
  ViewPalette view(planet, common);
  for (const panorama::Strip& strip : panorama::strips_of(map)) {
    for (const panorama::Piece& piece : panorama::pieces_of(map, viewpoint, strip, 0)) {
      sample.view = piece.view;
      view.add(sample);
    }
  }
  take_ends(request.settings, view.ends());
  if (!common.quiet) std::fprintf(stderr, "vpe: %s\n", palette_text(request.settings.values()).c_str());
}

std::string sidecar_text(const PanoramaRequest& request, const PanoramaPlan& plan,
                         const paging::PlanetMeta& meta, const Ground& ground, const PanoramaFigures& figures,
                         const Common& common) {
  panorama::Sidecar sidecar;
  sidecar.image = request.output.filename().string();
  sidecar.map = plan.map;
  const mars::Pose& camera = request.camera;
  sidecar.viewpoint =
      panorama::RecordedViewpoint{mars::normalize_lon_deg(camera.lon_deg), camera.lat_deg,  camera.alt_m,
                                  camera.alt_m - ground.drawn_m,           ground.height_m, meta.datum};
  auto json = panorama::to_json(sidecar);
  if (const auto& eyes = request.stereo) {
    if (!plan.is_red_cyan) json["stereo"] = core::to_string(eyes->layout);
    json["eye_base_m"] = eyes->base_m;
  }
  json["radius_m"] = meta.radius_m;
  json["illustration"] = meta.illustration;
  json["synthetic"] = mars::synthetic_statement(meta.sources);
  for (const panorama::Plane layer : request.layers) {
    const panorama::PlaneInfo& info = panorama::info_of(layer);
    json["planes"][std::string(info.name)] = {{"file", layer_file(request.output, layer).filename().string()},
                                              {"unit", info.unit},
                                              {"meaning", info.meaning}};
  }
  json["error"] = {{"tile_error_m", figures.geometric_error_m},
                   {"shift_bound_px", figures.shift_bound_px},
                   {"tiles_missing", figures.tiles_missing}};
  json["vpe"] = {{"version", version()}, {"command", common.words}, {"recipe", recipe_json(request)}};
  return core::json_text(json, 1) + "\n";
}

nlohmann::json report_json(const PanoramaRequest& request, const PanoramaPlan& plan, const PanoramaMaker& maker,
                           const PanoramaTimes& times, double total_s) {
  nlohmann::json layers = nlohmann::json::object();
  for (const panorama::Plane layer : request.layers)
    layers[std::string(panorama::info_of(layer).name)] = layer_file(request.output, layer).string();
  nlohmann::json seconds{{"start", times.start},   {"casting", times.casting},   {"shading", times.shading},
                         {"planes", times.layers}, {"encoding", times.encoding}, {"total", total_s}};
  // Rays load tiles while they cast and shade.
  seconds["paging"] =
      request.backend == core::Backend::kPolygon ? nlohmann::json(times.paging) : nlohmann::json();
  nlohmann::json report{{"output", request.output.string()},
                        {"sidecar", sidecar_file(request.output).string()},
                        {"planes", layers},
                        {"projection", panorama::to_string(plan.map.kind)},
                        {"width", plan.size.width_px},
                        {"height", plan.size.height_px},
                        {"rounded", plan.rounded},
                        {"strips_made", maker.made()},
                        {"strips_kept", maker.kept()},
                        {"shift_bound_px", maker.figures().shift_bound_px},
                        {"seconds", seconds}};
  if (request.stereo) report["eye_base_m"] = request.stereo->base_m;
  return report;
}

void print_summary(const PanoramaRequest& request, const PanoramaPlan& plan, double shift_bound_px,
                   double total_s) {
  std::printf("%s: %s of %lldx%lld pixels in %.1f s, geometry within %s px\n", request.output.c_str(),
              panorama::to_string(plan.map.kind), static_cast<long long>(plan.size.width_px),
              static_cast<long long>(plan.size.height_px), total_s,
              base::format_significant(shift_bound_px, 2).c_str());
  if (request.stereo) std::printf("eyes %s apart\n", length_text(request.stereo->base_m).c_str());
}

// Makes renderers of the request's backend. One that measured the eyes is used again, as it has terrain
// already.
class RendererSource {
 public:
  RendererSource(const PanoramaRequest& request, const Common& common,
                 std::shared_ptr<const paging::PlanetFile> planet)
      : options_(render_options(request)), common_(common), planet_(std::move(planet)) {}

  std::unique_ptr<core::Renderer> make(int memory_mb) {
    if (warm_) return std::move(warm_);
    Common share = common_;
    share.memory_mb = memory_mb;
    return make_renderer(options_, share, planet_);
  }

  core::Renderer& make_warm(int memory_mb) {
    warm_ = make(memory_mb);
    return *warm_;
  }

 private:
  RenderOptions options_;
  const Common& common_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  std::unique_ptr<core::Renderer> warm_;
};

// Chooses the base of a new pair; that of a sidecar is known. Then checks that both eyes are above the terrain.
void resolve_eyes(PanoramaRequest& request, const PanoramaPlan& plan,
                  const std::shared_ptr<const paging::PlanetFile>& planet,
                  const core::DrawRequest& draw_request, RendererSource& renderers, int memory_mb) {
  if (!request.stereo) return;
  if (request.from_sidecar.empty()) {
    core::Renderer& renderer = renderers.make_warm(renderer_memory_mb(request, plan, memory_mb));
    request.stereo = measure_eyes(request, planet->radius_m(), draw_request, renderer);
  }
  require_eyes_above_ground(request, paging::Surface(planet, kSmallSurfaceBytes), kLeastPanoramaHeight_m);
}

// Returns the names of the image for its web page.
std::vector<panorama::PageName> page_names(PanoramaOverlays& overlays) {
  overlays.prepare();
  std::vector<panorama::PageName> names;
  for (const overlay::PanoramaName& name : overlays.names())
    names.push_back({name.name, {name.azimuth_deg, name.elevation_deg}, name.distance_m});
  return names;
}

void make_panorama(const PanoramaArguments& arguments, const Common& common) {
  const auto start = SteadyClock::now();
  PanoramaRequest request = parse_panorama(arguments, common);
  const PanoramaPlan plan = plan_panorama(request);
  resolve_overlays(request);
  resolve_scene(request);
  check_stereo_panorama(request);
  check_files(request, plan, common.memory_mb);
  check_page(arguments.page);

  const InterruptGuard guard;
  const auto planet = open_planet(request.planet, common);
  const paging::PlanetMeta& meta = planet->meta();
  check_identity(request, meta.identity);
  request.identity = meta.identity;
  note_illustration(meta, common.quiet);
  require_layers(request.settings.values(), *planet);
  if (!common.quiet) {
    for (const std::string& text : plan.rounded) std::fprintf(stderr, "vpe: %s\n", text.c_str());
  }
  mars::Pose& camera = request.camera;
  camera.lat_deg = place_on({{camera.lon_deg, camera.lat_deg}, request.place_name, 0}, "--at", request.latitude,
                            meta, common.quiet)
                       .lat_deg;
  make_interest_planetocentric(request.interest, request.latitude, meta);
  const Ground ground = ground_below(planet, request);
  place_camera(request, ground);
  require_known_sun(request.settings.values(), meta.body);
  take_palette_of_panorama(request, planet, common);
  const core::DrawRequest draw_request = draw_request_for(request);
  const auto sun = sun_statement(draw_request.settings, {request.camera.lon_deg, request.camera.lat_deg});
  if (!common.quiet) print_sun(sun);

  remove_stale_files(request.output);
  base::ThreadPool pool(common.threads);
  PanoramaTimes times;
  const int memory_mb = request.memory_mb > 0 ? request.memory_mb : common.memory_mb;
  RendererSource renderers(request, common, planet);
  resolve_eyes(request, plan, planet, draw_request, renderers, memory_mb);
  times.start = elapsed_s(start);
  PanoramaOverlays overlays(request, plan.map, planet, pool, static_cast<std::size_t>(memory_mb) << 19);
  PanoramaMaker maker(request, plan,
                      {draw_request, fingerprint_of(request, plan, draw_request, planet->radius_m()), planet,
                       [&](int share_mb) { return renderers.make(share_mb); }, memory_mb},
                      overlays, pool);
  {
    ProgressLine line(common.quiet);
    const auto strips = maker.run(line, times);
    const auto joining = SteadyClock::now();
    const std::string sidecar = sidecar_text(request, plan, meta, ground, maker.figures(), common);
    join_strips(request, plan, sidecar, strips, pool, [&](double part) {
      InterruptGuard::check();
      line.show("joining", 0.95 + 0.05 * part);
    });
    remove_strips(request.output);
    times.encoding += elapsed_s(joining);
  }
  nlohmann::json page;
  if (!arguments.page.folder.empty())
    page = write_page_of(arguments.page, {request.output.string(), "", {}}, page_names(overlays), common);
  if (!common.quiet) print_failures(maker.failures());
  if (common.json) {
    nlohmann::json report = report_json(request, plan, maker, times, elapsed_s(start));
    report["sun"] = to_json(sun);
    if (!page.is_null()) report["page"] = page;
    print_json(report);
  } else if (!common.quiet) {
    print_summary(request, plan, maker.figures().shift_bound_px, elapsed_s(start));
  }
}

}  // namespace

void add_panorama(CLI::App& program, Common& common) {
  using Limits = panorama::PlanLimits;
  auto arguments = std::make_shared<PanoramaArguments>();
  CLI::App* command = add_command(
      program, "panorama", "Draw a panorama; an interrupted run continues where it was stopped", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option("--at", arguments->at, "LON,LAT of the camera, degrees, or the name of its place");
  add_latitude_option(*command, arguments->latitude);
  command->add_option("--height", arguments->height_m, "Height of the camera above the ground, metres")
      ->check(number_within(0, 1e10));
  command->add_option("--altitude", arguments->altitude_m, "Altitude of the camera above the sphere, metres")
      ->check(number_within(-1e6, 1e10));
  command->add_option("-o,--output", arguments->output,
                      "Image (.tif of any size, .png, .jpg); its sidecar gets the same name with .json");
  command->add_option("--projection", arguments->projection,
                      "facets, cylinder or equirectangular (default: cylinder for rays, facets for triangles)");
  CLI::Option* facets =
      command->add_option("--facets", arguments->facets, "Number of planes to the full circle, 3 to 64")
          ->capture_default_str();
  const auto is_yaw = number_within(-Limits::kMaxYaw_deg, Limits::kMaxYaw_deg);
  CLI::Option* yaw =
      command->add_option("--yaw", arguments->yaw_deg,
                          "Azimuth of the middle of facet 0, or of the left edge of a full circle, degrees");
  yaw->check(is_yaw)->capture_default_str();
  command->add_option("--from", arguments->from_deg, "Azimuth of the left edge, degrees")->check(is_yaw);
  command->add_option("--to", arguments->to_deg, "Azimuth of the right edge, degrees")->check(is_yaw);
  command->add_option("--elevation", arguments->elevation,
                      "MIN,MAX elevation, degrees (default: -45,45; equirectangular: -90,90)");
  CLI::Option* width =
      command->add_option("--width", arguments->width_px, "Columns of the image (default: 4096)");
  command->add_option("--degrees-per-pixel", arguments->degrees_per_pixel, "Degrees of azimuth a column")
      ->excludes(width);
  command->add_option("--aux-layers", arguments->aux_layers,
                      "Also write rasters: any of range,lonlat,elevation,slope,incidence (.tif)");
  command->add_option("--from-sidecar", arguments->from_sidecar,
                      "PANO.json: make the same image again from its recipe; takes PLANET and -o only");
  arguments->render.backend = core::Backend::kRay;
  add_render_options(*command, arguments->render);
  add_eye_options(*command, arguments->stereo);
  add_method_options(*command, arguments->stereo.method);
  add_page_options(*command, arguments->page);
  add_examples(
      *command,
      {{"the full circle from eye height",
        "vpe panorama mars.vpe --at -59.2,-13.7 --height 2 -o rim.png --width 6000"},
       {"the south, finely, with marks of azimuth",
        "vpe panorama mars.vpe --at -59.2,-13.7 --height 2 --from 150 --to 210 --elevation=-10,15 --degrees-per-pixel 0.01 --set overlay.compass=on -o south.tif"},
       {"with a web page, in a folder",
        "vpe panorama mars.vpe --at -59.2,-13.7 --height 2 --aux-layers range,lonlat,elevation -o rim.png --html rim-page"},
       {"the same image again", "vpe panorama --from-sidecar rim.json -o same.png"}});
  command->callback([arguments, facets, yaw, &common] {
    arguments->has_facets = facets->count() > 0;
    arguments->has_yaw = yaw->count() > 0;
    make_panorama(*arguments, common);
  });
}

}  // namespace vpe::app
