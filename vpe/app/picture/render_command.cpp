#include "vpe/app/picture/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "paging/surface/surface.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/picture/backend_choice.h"
#include "vpe/app/picture/explain_lod.h"
#include "vpe/app/picture/frame_overlays.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/stereo_render.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/inspect.h"
#include "vpe/core/image/image.h"
#include "vpe/gl/context.h"

namespace vpe::app {

namespace {

struct RenderArguments {
  std::string planet;
  std::string pose;
  std::optional<std::string> cull_from;
  double height_m = 0;
  bool has_height = false;
  std::string output;
  std::string range;
  std::string certificate;
  std::string explain_lod;
  std::string overlay_layer;
  std::string size = "1280x720";
  double fov_deg = 60;
  RenderOptions drawn;
  StereoArguments stereo;
};

mars::Pose parse_pose(const RenderArguments& arguments, const std::function<double(mars::LonLat)>& terrain) {
  const auto n = parse_numbers(arguments.pose);
  const std::size_t angles = arguments.has_height ? 2 : 3;  // numbers before yaw
  const bool has_alt_too = arguments.has_height && n && n->size() == 6;
  const std::size_t skip = has_alt_too ? 3 : angles;
  if (!n || n->size() < angles || n->size() > skip + 3) {
    throw UsageError("--pose '" + arguments.pose + "': expected LON,LAT," +
                     (arguments.has_height ? "" : "ALT,") +
                     "YAW,PITCH,ROLL (degrees, metres above the sphere; --height M replaces ALT)");
  }
  const auto angle = [&](std::size_t k) { return skip + k < n->size() ? (*n)[skip + k] : 0.0; };
  mars::Pose pose{(*n)[0], (*n)[1], 0, angle(0), angle(1), angle(2)};
  if (!mars::is_valid({pose.lon_deg, pose.lat_deg})) {
    throw UsageError("--pose '" + arguments.pose + "': latitude must be within -90..90");
  }
  pose.alt_m = arguments.has_height ? terrain({pose.lon_deg, pose.lat_deg}) + arguments.height_m : (*n)[2];
  return pose;
}

// The view whose tiles are drawn, when it is another.
std::optional<core::View> cull_view(const std::optional<std::string>& text, const core::View& view,
                                    double radius_m) {
  if (!text) return std::nullopt;
  auto n = parse_numbers(*text);
  if (!n || n->size() < 3 || n->size() > 6 || !mars::is_valid({(*n)[0], (*n)[1]})) {
    throw UsageError(
        "--cull-from '" + *text +
        "': expected LON,LAT,ALT,YAW,PITCH,ROLL (degrees, latitude within -90..90; metres above the sphere)");
  }
  n->resize(6, 0.0);
  core::View other = view;
  other.camera = mars::to_camera(mars::Pose{(*n)[0], (*n)[1], (*n)[2], (*n)[3], (*n)[4], (*n)[5]}, radius_m);
  return other;
}

void require_valid(const core::View& view) {
  if (const std::string trouble = core::check(view); !trouble.empty()) throw UsageError(trouble);
}

// What the colours of inspect=levels mean.
void print_levels(const core::FrameStats& stats, const paging::PlanetFile& planet) {
  for (std::size_t n = 0; n < stats.tiles_by_level.size(); ++n) {
    if (stats.tiles_by_level[n] == 0) continue;
    const int level = static_cast<int>(n);
    const double spacing_m = lod::post_spacing_m(level, planet.meta().tile.intervals(), planet.radius_m());
    std::printf("  %.*s: level %d, posts of %.*f m, %d tiles\n",
                static_cast<int>(core::level_colour(level).name.size()), core::level_colour(level).name.data(),
                core::shown_level(level), spacing_m < 10.0 ? 2 : 0, spacing_m, stats.tiles_by_level[n]);
  }
}

void check_overlay_layer(const std::string& path, const core::Overlays& overlays) {
  if (path.empty()) return;
  check_image_output(path);
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  if (extension != ".png")
    throw UsageError("--overlay-layer " + path + ": a layer has alpha; let the name end in .png");
  if (!overlay::any(overlays)) {
    throw UsageError("--overlay-layer " + path +
                     ": no overlay is set; for one, add --set overlay.graticule=on");
  }
}

// Files that say something of one eye.
void check_stereo_outputs(const RenderArguments& arguments) {
  check_stereo(arguments.stereo);
  if (arguments.stereo.layout.empty()) return;
  if (!arguments.range.empty() || !arguments.explain_lod.empty() || !arguments.overlay_layer.empty()) {
    throw UsageError(
        "--range, --explain-lod and --overlay-layer are of one eye; leave out --stereo, or render each eye by "
        "itself");
  }
}

void render_stereo(const RenderArguments& arguments, const Common& common, const core::DrawRequest& request,
                   const std::function<core::DrawResult(const core::DrawRequest&)>& draw) {
  const StereoImage drawn = draw_stereo(arguments.stereo, request, draw);
  core::write_image(arguments.output, drawn.image.pixels, drawn.image.width, drawn.image.height);
  const nlohmann::json certificates{{"left", nlohmann::json::parse(core::to_json(drawn.left.certificate))},
                                    {"right", nlohmann::json::parse(core::to_json(drawn.right.certificate))}};
  if (!arguments.certificate.empty()) base::write_file(arguments.certificate, certificates.dump(1) + "\n");
  if (common.json) {
    print_json({{"output", arguments.output},
                {"backend", arguments.drawn.backend},
                {"eye_base_m", drawn.eye_base_m},
                {"certificate", certificates},
                {"stats", {{"left", stats_json(drawn.left.stats)}, {"right", stats_json(drawn.right.stats)}}}});
  } else if (!common.quiet) {
    std::printf("%s: eyes %.4g m apart, geometry within %.2f px\n", arguments.output.c_str(), drawn.eye_base_m,
                std::max(drawn.left.certificate.shift_bound_px, drawn.right.certificate.shift_bound_px));
  }
}

// Of the image, unless it is named; what --explain-lod tells of are triangles.
void choose_backend_of(RenderArguments& arguments, core::DrawRequest& request, double radius_m) {
  RenderOptions& drawn = arguments.drawn;
  if (drawn.backend == kAutoBackend && !arguments.explain_lod.empty()) drawn.backend = kPolygonBackend;
  const BackendChoice chosen =
      choose_backend(drawn, make_settings(drawn), {&request, 1}, radius_m, gl::has_gpu());
  drawn.backend = chosen.backend;
  request.settings = chosen.settings.values();
}

void print_summary(const RenderArguments& arguments, const core::DrawRequest& request,
                   const core::DrawResult& result) {
  std::string what = base::format_number(static_cast<double>(result.stats.triangles)) + " triangles";
  if (arguments.drawn.backend == kRayBackend) {
    const glm::ivec2 size = core::drawn_size(request.view);
    what = base::format_number(static_cast<double>(size.x) * size.y * request.settings.samples) + " rays";
  }
  std::printf("%s: %s in %d tiles, geometry within %.2f px (%.3g m)\n", arguments.output.c_str(), what.c_str(),
              result.stats.tiles_drawn, result.certificate.shift_bound_px,
              result.certificate.geometric_error_m);
}

void render(RenderArguments& arguments, const Common& common) {
  const core::Settings settings = make_settings(arguments.drawn);
  const Size size = parse_size(arguments.size);
  // Wrong usage and what cannot be written are told before any work.
  core::DrawRequest request;
  request.view.width = size.width;
  request.view.height = size.height;
  request.view.fov_deg = arguments.fov_deg;
  request.interest = parse_interest(arguments.drawn);
  request.view.camera =
      mars::to_camera(parse_pose(arguments, [](mars::LonLat) { return 0.0; }), mars::kMarsRadius_m);
  require_valid(request.view);
  if (const auto other = cull_view(arguments.cull_from, request.view, mars::kMarsRadius_m))
    require_valid(*other);
  check_image_output(arguments.output);
  if (!arguments.range.empty()) check_range_output(arguments.range);
  if (!arguments.certificate.empty()) check_output(arguments.certificate);
  if (!arguments.explain_lod.empty()) check_output(arguments.explain_lod);
  check_overlay_layer(arguments.overlay_layer, settings.values());
  check_stereo_outputs(arguments);

  // Read now for what may be wrong with it.
  if (!settings.values().names.empty()) (void)core::read_gazetteer(settings.values().names);

  const auto planet = open_planet(arguments.planet, common);
  note_illustration(planet->meta(), common.quiet);
  const mars::Pose pose = parse_pose(arguments, [&](mars::LonLat place) {
    return paging::Surface(planet, std::size_t{8} << 20)
        .at(mars::direction(place), settings.values().exaggeration)
        .height_m;
  });
  request.view.camera = mars::to_camera(pose, planet->radius_m());
  request.settings = settings.values();
  request.sun = sun_for(request.settings, pose);
  request.want_range =
      !arguments.range.empty() || !arguments.certificate.empty() || overlay::needs_range(request.settings);
  require_valid(request.view);
  request.cull_view = cull_view(arguments.cull_from, request.view, planet->radius_m());
  choose_backend_of(arguments, request, planet->radius_m());
  const auto renderer = make_renderer(arguments.drawn, common, planet);
  request.paging.timeout_s = arguments.drawn.wait_s;
  // A finished image of one eye.
  const auto draw = [&](const core::DrawRequest& camera) {
    core::DrawResult result = renderer->draw(camera);
    require_complete(arguments.drawn, result);
    if (!common.quiet) warn_of(result.failures);
    if (!overlay::any(camera.settings)) return result;
    const overlay::Layer layer = FrameOverlays(planet).layer(camera, result.frame, result.certificate, 0);
    if (arguments.overlay_layer.empty()) {
      overlay::composite(layer, result.frame.colour);
    } else {
      core::write_image(arguments.overlay_layer, layer.pixels, layer.width, layer.height);
    }
    return result;
  };
  if (!arguments.stereo.layout.empty()) return render_stereo(arguments, common, request, draw);
  const core::DrawResult result = draw(request);
  core::write_image(arguments.output, result.frame.colour, result.frame.width, result.frame.height);
  if (!arguments.range.empty()) {
    core::write_tiff(arguments.range, result.frame.range_m, result.frame.width, result.frame.height);
  }
  if (!arguments.certificate.empty())
    base::write_file(arguments.certificate, core::to_json(result.certificate) + "\n");
  if (!arguments.explain_lod.empty()) {
    const nlohmann::json levels = explain_lod(request, *planet, memory_bytes(common));
    base::write_file(arguments.explain_lod, levels.dump(2) + "\n");
  }
  if (common.json) {
    nlohmann::json json{{"output", arguments.output},
                        {"backend", arguments.drawn.backend},
                        {"certificate", nlohmann::json::parse(core::to_json(result.certificate))},
                        {"stats", stats_json(result.stats)}};
    print_json(json);
  } else if (!common.quiet) {
    print_summary(arguments, request, result);
    if (settings.values().inspect == core::Inspect::kLevels) print_levels(result.stats, *planet);
  }
}

}  // namespace

void add_render(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = add_command(program, "render", "Draw one picture", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM; the embedded Mars when left out");
  command->add_option("--pose", arguments->pose, "LON,LAT,ALT,YAW,PITCH,ROLL: degrees, metres above the sphere")
      ->required();
  CLI::Option* height =
      command->add_option("--height", arguments->height_m, "Metres above the terrain, instead of ALT")
          ->check(number_within(-1e7, 1e10));
  command->add_option("--cull-from", arguments->cull_from,
                      "LON,LAT,ALT,YAW,PITCH,ROLL: draw the tiles chosen for this pose, as seen from --pose");
  command->add_option("-o,--output", arguments->output, "Picture to write (.png, .jpg)")->required();
  command->add_option("--range", arguments->range, "Also write the range of every pixel, metres (.tif)");
  command->add_option("--certificate", arguments->certificate,
                      "Also write what the picture's error is (.json)");
  command->add_option("--explain-lod", arguments->explain_lod,
                      "Also write why every drawn tile has its level of detail (.json)");
  command->add_option("--overlay-layer", arguments->overlay_layer,
                      "Write the overlays alone, with alpha (.png), and leave them out of the picture");
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT, pixels")->capture_default_str();
  command->add_option("--fov", arguments->fov_deg, "Vertical field of view, degrees")
      ->check(number_within(core::ViewLimits::kMinFov_deg, core::ViewLimits::kMaxFov_deg))
      ->capture_default_str();
  add_stereo_options(*command, arguments->stereo);
  add_render_options(*command, arguments->drawn);
  command->callback([arguments, height, &common] {
    arguments->has_height = height->count() > 0;
    render(*arguments, common);
  });
}

}  // namespace vpe::app
