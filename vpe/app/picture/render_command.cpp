#include "vpe/app/picture/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "paging/surface/surface.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/picture/backend_choice.h"
#include "vpe/app/picture/carried_drawer.h"
#include "vpe/app/picture/comparison.h"
#include "vpe/app/picture/contour_ranges.h"
#include "vpe/app/picture/explain_lod.h"
#include "vpe/app/picture/frame_overlays.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/layer_check.h"
#include "vpe/app/picture/render_request.h"
#include "vpe/app/picture/stereo_render.h"
#include "vpe/app/picture/sun_statement.h"
#include "vpe/app/picture/view_palette.h"
#include "vpe/app/planet/latitude_option.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/inspect.h"
#include "vpe/core/image/image.h"
#include "vpe/core/json_text.h"
#include "vpe/gl/context.h"

namespace vpe::app {

namespace {

// Sets the backend of the options and the settings of the request. --explain-lod alone describes triangles.
void resolve_backend(RenderArguments& arguments, core::Settings& settings, core::DrawRequest& request,
                     double radius_m) {
  RenderOptions& image = arguments.image;
  if (image.backend == core::Backend::kRay && !arguments.explain_lod.empty() &&
      settings.values().ray_mode != core::RayMode::kMultires)
    throw UsageError(
        "--explain-lod: --backend ray chooses tiles by an error in rays.mode=multires only; add --set rays.mode=multires, or take "
        "--backend polygon");
  if (!image.backend && !arguments.explain_lod.empty()) image.backend = core::Backend::kPolygon;
  const BackendChoice chosen = choose_backend(image, settings, {&request, 1}, radius_m, gl::has_gpu());
  image.backend = chosen.backend;
  settings = chosen.settings;
  request.settings = settings.values();
}

nlohmann::json to_json(const core::FrameStats& s) {
  return {{"tiles_visited", s.tiles_visited},
          {"tiles_culled_frustum", s.tiles_culled_frustum},
          {"tiles_culled_horizon", s.tiles_culled_horizon},
          {"tiles_culled_occlusion", s.tiles_culled_occlusion},
          {"tiles_drawn", s.tiles_drawn},
          {"tiles_missing", s.tiles_missing},
          {"tiles_substituted", s.tiles_substituted},
          {"pages_uploaded", s.pages_uploaded},
          {"pages_evicted", s.pages_evicted},
          {"triangles", s.triangles},
          {"skirt_triangles", s.skirt_triangles},
          {"bytes_resident", s.bytes_resident},
          {"tiles_by_level", s.tiles_by_level},
          {"select_ms", s.select_ms},
          {"occlude_ms", s.occlude_ms},
          {"load_ms", s.load_ms},
          {"draw_ms", s.draw_ms},
          {"read_ms", s.read_ms}};
}

// Prints the legend of inspect=levels.
void print_levels(const core::FrameStats& stats, const paging::PlanetFile& planet) {
  for (std::size_t n = 0; n < stats.tiles_by_level.size(); ++n) {
    if (stats.tiles_by_level[n] == 0) continue;
    const int level = static_cast<int>(n);
    const double spacing_m = lod::post_spacing_m(level, planet.meta().tile.intervals(), planet.radius_m());
    std::printf("  %.*s: level %d, posts of %.*f m, %d tiles\n",
                static_cast<int>(core::level_colour(level).name.size()), core::level_colour(level).name.data(),
                level, spacing_m < 10.0 ? 2 : 0, spacing_m, stats.tiles_by_level[n]);
  }
}

mars::LonLat place_below(const core::DrawRequest& request) {
  return mars::lon_lat(request.view.camera.position_m);
}

void print_summary(const RenderArguments& arguments, const core::DrawRequest& request,
                   const core::DrawResult& result) {
  std::string what = base::format_number(static_cast<double>(result.stats.triangles)) + " triangles";
  if (arguments.image.backend == core::Backend::kRay) {
    const glm::ivec2 size = core::drawn_size(request.view);
    what = base::format_number(static_cast<double>(size.x) * size.y * request.settings.samples) + " rays";
  }
  const core::Certificate& c = result.certificate;
  if (c.is_below_ground) {
    std::printf("%s: the camera is below the ground\n", arguments.output.c_str());
    return;
  }
  // Wide images are stretched so much that the middle does not speak for the rest.
  constexpr double kWideStretch = 4;
  std::string corners;
  if (c.corner_stretch > kWideStretch)
    corners = ", up to " + base::format_fixed(c.shift_bound_px * c.corner_stretch, 2) + " px in the corners";
  std::printf("%s: %s in %d tiles, geometry within %.2f px (%s)%s\n", arguments.output.c_str(), what.c_str(),
              result.stats.tiles_drawn, c.shift_bound_px,
              length_text(std::max(c.geometric_error_m, c.smoothing_m), 3).c_str(), corners.c_str());
}

void write_stereo(const RenderArguments& arguments, const Common& common, const StereoImage& drawn,
                  RenderRecipe recipe, const paging::PlanetMeta& planet) {
  const nlohmann::ordered_json certificates{{"left", core::to_json(drawn.left.certificate)},
                                            {"right", core::to_json(drawn.right.certificate)}};
  recipe.stereo.eye_base_m = drawn.eye_base_m;
  core::ImageOptions options;
  options.png_texts = recipe_texts(recipe, planet, certificates);
  core::write_image(arguments.output, drawn.image.pixels, drawn.image.width, drawn.image.height, options);
  if (!arguments.certificate.empty())
    base::write_file(arguments.certificate, core::json_text(certificates, 1) + "\n");
  if (common.json) {
    print_json({{"output", arguments.output},
                {"backend", core::to_string(*arguments.image.backend)},
                {"eye_base_m", drawn.eye_base_m},
                {"certificate", certificates},
                {"stats", {{"left", to_json(drawn.left.stats)}, {"right", to_json(drawn.right.stats)}}}});
  } else if (!common.quiet) {
    std::printf("%s: eyes %s apart, geometry within %.2f px\n", arguments.output.c_str(),
                length_text(drawn.eye_base_m).c_str(),
                std::max(drawn.left.certificate.shift_bound_px, drawn.right.certificate.shift_bound_px));
  }
}

// What --explain-lod says: of the tiles that rays have cast, or of those that triangles have drawn.
nlohmann::json explanation(const RenderArguments& arguments, const Common& common,
                           const core::DrawRequest& request, const paging::PlanetFile& planet,
                           std::span<const lod::TileExplanation> cast) {
  return arguments.image.backend == core::Backend::kRay ? explain_lod(request, cast)
                                                        : explain_lod(request, planet, memory_bytes(common));
}

// Writes the image of a screen, which has no recipe: that of another image says nothing of rooms.
void write_screen_image(const std::string& output, const ChosenScreen& screen, const core::Frame& frame) {
  const core::RgbImage image = image_of_screen(screen, {frame.width, frame.height, frame.colour});
  core::ImageOptions options;
  options.png_texts = {{"Software", std::string("vpe ") + version()}};
  core::write_image(output, image.pixels, image.width, image.height, options);
}

void write_image_files(const RenderArguments& arguments, const Common& common, const ParsedRender& parsed,
                       const core::DrawRequest& request, const core::DrawResult& result,
                       const RenderRecipe& recipe, const paging::PlanetFile& planet,
                       std::span<const lod::TileExplanation> cast) {
  const core::Frame& frame = result.frame;
  const nlohmann::ordered_json certificate = core::to_json(result.certificate);
  core::ImageOptions options;
  if (parsed.screen) {
    write_screen_image(arguments.output, *parsed.screen, frame);
  } else {
    options.png_texts = recipe_texts(recipe, planet.meta(), certificate);
    core::write_image(arguments.output, frame.colour, frame.width, frame.height, options);
  }
  if (!arguments.range.empty()) {
    options.tiff_metadata = range_metadata(recipe.pose, request.view, planet.meta());
    core::write_tiff(arguments.range, frame.range_m, frame.width, frame.height, options);
  }
  if (!arguments.certificate.empty())
    base::write_file(arguments.certificate, core::json_text(certificate, 2) + "\n\n");
  if (!arguments.explain_lod.empty()) {
    const nlohmann::json levels = explanation(arguments, common, request, planet, cast);
    base::write_file(arguments.explain_lod, core::json_text(levels, 2) + "\n");
  }
  if (common.json) {
    print_json({{"output", arguments.output},
                {"backend", core::to_string(*arguments.image.backend)},
                {"sun", to_json(sun_statement(request.settings, place_below(request)))},
                {"palette", palette_json(recipe.palette)},
                {"certificate", certificate},
                {"stats", to_json(result.stats)}});
  } else if (!common.quiet) {
    print_summary(arguments, request, result);
    if (request.settings.inspect == core::Inspect::kLevels) print_levels(result.stats, planet);
  }
}

// Makes the renderer. Without OpenGL rays take the place of triangles that nobody named, and of the backend and the
// settings.
std::unique_ptr<core::Renderer> renderer_for(RenderArguments& arguments, const Common& common,
                                             const std::shared_ptr<const paging::PlanetFile>& planet,
                                             core::Settings& settings, core::DrawRequest& request,
                                             bool is_backend_named,
                                             std::vector<lod::TileExplanation>* explained) {
  try {
    return make_renderer(arguments.image, common, planet, explained);
  } catch (const gl::ContextError& e) {
    const auto rays = rays_instead(arguments.image, settings, {&request, 1});
    if (is_backend_named || !rays) throw;
    note_rays_instead(e.what(), common.quiet);
    arguments.image.backend = rays->backend;
    settings = rays->settings;
    request.settings = settings.values();
    return make_renderer(arguments.image, common, planet);
  }
}

void require_above_ground(const RenderArguments& arguments,
                          const std::shared_ptr<const paging::PlanetFile>& planet,
                          const core::DrawRequest& request) {
  const paging::Surface surface(planet, std::size_t{8} << 20);
  const glm::dvec3& camera_m = request.view.camera.position_m;
  if (arguments.allow_underground || !surface.is_below(camera_m, request.settings.exaggeration)) return;
  const double ground_m = surface.at(camera_m, request.settings.exaggeration).height_m;
  const double alt_m = glm::length(camera_m) - planet->radius_m();
  throw std::runtime_error("the camera at " + *arguments.pose + " is " +
                           base::format_rounded(ground_m - alt_m, 2) + " m below the ground, which lies " +
                           base::format_rounded(ground_m, 2) +
                           " m above the sphere there; give a larger ALT, or --height above the ground "
                           "(--allow-underground draws what is there: nothing)");
}

// Takes the ends of the palette from the view, if the settings say so. Returns them.
std::optional<core::PaletteEnds> take_palette_of_view(core::DrawRequest& request,
                                                      const std::shared_ptr<const paging::PlanetFile>& planet,
                                                      const Common& common) {
  if (!needs_view_palette(request.settings, *planet)) return std::nullopt;
  ViewPalette view(planet, common);
  view.add(reduced(request));
  take_ends(request.settings, view.ends());
  if (!common.quiet) std::fprintf(stderr, "vpe: %s\n", palette_text(request.settings).c_str());
  return core::PaletteEnds{*request.settings.palette_low, *request.settings.palette_high};
}

// Returns what draws the eyes of a pair, or null if both are drawn in full.
std::unique_ptr<CarriedDrawer> pair_drawer(const RenderArguments& arguments, const Common& common,
                                           const std::shared_ptr<const paging::PlanetFile>& planet,
                                           const core::DrawRequest& request, core::Renderer& renderer) {
  if (!arguments.stereo.method.carries()) return nullptr;
  if (const std::string why = why_not_carried(request); !why.empty())
    throw UsageError("--stereo-method reproject: " + why + "; give --stereo-method full");
  return std::make_unique<CarriedDrawer>(
      renderer, planet,
      CarriedDrawerOptions{
          .gap_px = arguments.stereo.method.gap_px,
          .memory_bytes = std::size_t{1048576} * static_cast<std::size_t>(carrying_memory_mb(common.memory_mb)),
          .threads = common.threads});
}

// Writes the maps of a carried eye that were asked for.
void write_maps(const StereoArguments& stereo, const warp::CarriedImage& carried, const core::Frame& right,
                const core::DrawRequest& request, core::Renderer& renderer) {
  const auto write = [&](const std::string& file, const std::vector<base::Rgb>& pixels) {
    core::write_image(file, pixels, right.width, right.height);
  };
  if (!stereo.map.empty()) write(stereo.map, with_drawn_pixels_red(carried, right));
  if (!stereo.differences.empty())
    write(stereo.differences, colour_differences(right, renderer.draw(request).frame));
}

void render(RenderArguments& arguments, const Common& common) {
  // Wrong usage, outputs that cannot be written and a bad gazetteer are reported before any work.
  const std::string identity = take_recipe(arguments, common);
  ParsedRender parsed = parse_view(arguments);
  if (!common.quiet && !parsed.pose.note.empty())
    std::fprintf(stderr, "vpe: note: %s\n", parsed.pose.note.c_str());
  check_render_outputs(arguments, parsed.settings.values());
  const std::string& names = parsed.settings.values().names;
  if (!names.empty()) (void)core::read_gazetteer(names);

  const auto planet = with_earlier(open_planet(arguments.planet, common), arguments.earlier, common);
  FrameOverlays overlays(planet);
  overlays.load(parsed.settings.values());
  require_earlier(parsed.settings.values(), *planet);
  require_layers(parsed.settings.values(), *planet);
  note_illustration(planet->meta(), common.quiet);
  require_known_sun(parsed.settings.values(), planet->meta().body);
  const auto convert = [&](mars::Pose& pose, bool quiet) {
    pose.lat_deg =
        planetocentric({pose.lon_deg, pose.lat_deg}, arguments.latitude, planet->meta(), quiet).lat_deg;
  };
  if (parsed.pose.name.empty()) convert(parsed.pose.pose, common.quiet);
  if (parsed.cull_pose) convert(*parsed.cull_pose, true);
  make_interest_planetocentric(arguments.image.interest, arguments.latitude, planet->meta());
  parsed.request.interest = parse_interest(arguments.image);
  if (!identity.empty() && identity != planet->meta().identity) {
    throw std::runtime_error(arguments.from_image + ": was made from a planet of identity " + identity +
                             ", and " + planet->path() + " has " + planet->meta().identity +
                             "; name that planet file");
  }
  const std::string& earlier = arguments.earlier_of_recipe;
  if (!earlier.empty() && earlier != planet->earlier()->meta().identity) {
    throw std::runtime_error(arguments.from_image + ": was compared with a planet of identity " + earlier +
                             ", and " + planet->earlier()->path() + " has " +
                             planet->earlier()->meta().identity + "; name that planet file with --compare");
  }
  auto [pose, request] = resolve_view(parsed, planet);
  core::Settings settings = parsed.settings;
  if (!common.quiet) print_sun(sun_statement(request.settings, place_below(request)));
  const bool is_backend_named = arguments.image.backend.has_value() || !arguments.explain_lod.empty();
  resolve_backend(arguments, settings, request, planet->radius_m());
  require_budget(settings.values(), *arguments.image.backend);
  require_above_ground(arguments, planet, request);
  std::vector<lod::TileExplanation> explained;  // of what rays drew last
  std::vector<lod::TileExplanation> cast;       // of the image
  Common rest = common;
  if (arguments.stereo.method.carries()) rest.memory_mb -= carrying_memory_mb(common.memory_mb);
  const auto renderer = renderer_for(arguments, rest, planet, settings, request, is_backend_named,
                                     arguments.explain_lod.empty() ? nullptr : &explained);
  RenderRecipe recipe = recipe_of(arguments, settings, pose, parsed, *planet);
  recipe.palette = take_palette_of_view(request, planet, common);
  // Finishes the image of one camera.
  const auto finish = [&](const core::DrawRequest& one, core::DrawResult result) {
    cast = explained;
    require_complete(arguments.image, result);
    if (!common.quiet) {
      print_failures(result.failures);
      note_limited_by_memory(arguments.image, common, one, result);
    }
    if (!overlay::any(one.settings)) return result;
    FrameGround ground{result.frame.range_m, result.certificate, {}};
    if (const auto finer = contour_request(one, result)) {
      ground.contours = renderer->draw(*finer);
      require_complete(arguments.image, *ground.contours);
      if (!common.quiet) print_failures(ground.contours->failures);
    }
    const overlay::Layer layer = overlays.layer(one, ground, 0);
    if (arguments.overlay_layer.empty()) {
      overlay::composite(layer, result.frame.colour);
    } else {
      core::write_image(arguments.overlay_layer, layer.pixels, layer.width, layer.height);
    }
    return result;
  };
  if (arguments.stereo.layout.empty()) {
    const core::DrawResult result = finish(request, renderer->draw(request));  // sets `cast`
    write_image_files(arguments, common, parsed, request, result, recipe, *planet, cast);
  } else {
    const std::unique_ptr<CarriedDrawer> pair = pair_drawer(arguments, common, planet, request, *renderer);
    const auto draw = [&](const core::DrawRequest& one, Eye eye) {
      if (pair == nullptr || eye == Eye::kMiddle) return finish(one, renderer->draw(one));
      if (eye == Eye::kLeft) return finish(one, pair->draw_first(one));
      core::DrawResult right = pair->draw_carried(one);
      write_maps(arguments.stereo, pair->carried(), right.frame, one, *renderer);
      return finish(one, std::move(right));
    };
    write_stereo(arguments, common, draw_stereo(arguments.stereo, request, draw), recipe, planet->meta());
  }
}

}  // namespace

void add_render(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = add_command(program, "render", "Draw one image", common, true);
  command->add_option("PLANET", arguments->planet, "Planet file or DEM (default: the embedded Mars)");
  command->add_option(
      "--pose", arguments->pose,
      "LON,LAT,ALT,YAW,PITCH,ROLL of the camera: degrees; ALT in metres above the sphere; or the name of a "
      "place of Mars ('vpe find')");
  add_latitude_option(*command, arguments->latitude);
  command
      ->add_option("--height", arguments->height_m,
                   "Height of the camera above the terrain, metres; replaces ALT")
      ->check(number_within(-1e7, 1e10));
  command->add_option(
      "--cull-from", arguments->cull_from,
      "LON,LAT,ALT,YAW,PITCH,ROLL: select tiles for this pose, and draw them as seen from --pose");
  command->add_option("-o,--output", arguments->output, "Image to write (.png, .jpg)")->required();
  command->add_option(
      "--from-image", arguments->from_image,
      "Draw an image of 'vpe render' (.png) again, as the recipe in it says; in place of --pose and "
      "all that changes the image");
  command->add_option("--range", arguments->range, "Also write the range of every pixel, metres (.tif)");
  command->add_option("--certificate", arguments->certificate,
                      "Also write the bounds of the image's geometric error (.json)");
  command->add_option("--explain-lod", arguments->explain_lod,
                      "Also write why every drawn tile has its level of detail (.json); levels count from 0");
  command->add_option("--overlay-layer", arguments->overlay_layer,
                      "Write the overlays alone, with alpha (.png), and leave them out of the image");
  command->add_option("--size", arguments->size, "WIDTHxHEIGHT of the image, pixels")->capture_default_str();
  command->add_option("--fov", arguments->fov_deg, "Vertical field of view, degrees")
      ->check(number_within(core::ViewLimits::kMinFov_deg, core::ViewLimits::kMaxFov_deg))
      ->capture_default_str();
  add_stereo_options(*command, arguments->stereo);
  add_screen_options(*command, arguments->screen);
  command->add_flag("--allow-underground", arguments->allow_underground,
                    "Draw one colour for a camera below the ground, instead of failing");
  add_compare_option(*command, arguments->earlier);
  add_render_options(*command, arguments->image);
  add_examples(
      *command,
      {{"from 2 km above the ground, to the east, 5 degrees down",
        "vpe render mars.vpe --pose -59.2,-13.7,0,90,-5,0 --height 2000 -o view.png"},
       {"the globe in colours of elevation",
        "vpe render mars.vpe --pose -75,5,9000000,0,-90,0 --fov 50 --set mode=coloured -o globe.png"},
       {"range of every pixel, bounds of the error, sun by date",
        "vpe render mars.vpe --pose -59.2,-13.7,5000 --sun 2026-11-20T12:00Z -o view.png --range view.tif --certificate view.json"},
       {"a pair for red-cyan glasses, the right eye carried from the left one",
        "vpe render mars.vpe --pose -59.2,-13.7,0,90,-5,0 --height 2000 --stereo anaglyph --stereo-method reproject -o pair.png"},
       {"what has changed since, from 2 km above the ground",
        "vpe render after.vpe --compare before.vpe --pose 137.4,-4.6,0,0,-30,0 --height 2000 -o change.png"},
       {"what a screen that lies on a table shows to a head 10 cm to the right",
        "vpe render mars.vpe --pose -59.2,-13.7,8000,0,0,0 --screens scripts/screens/table.screens.toml --head 0.1,0,0 -o table.png"},
       {"the same image again", "vpe render mars.vpe --from-image view.png -o same.png"}});
  command->callback([arguments, &common] { render(*arguments, common); });
}

}  // namespace vpe::app
