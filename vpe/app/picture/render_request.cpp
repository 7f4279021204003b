#include "vpe/app/picture/render_request.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

#include "vpe/app/cli/output.h"
#include "vpe/app/picture/comparison.h"
#include "vpe/app/picture/frame_overlays.h"
#include "vpe/core/appearance/layer_list.h"

namespace vpe::app {

namespace {

// Options that the recipe of an image sets. A configuration file may have defaults of these; naming one beside
// --from-image contradicts it.
constexpr std::array<std::string_view, 20> kOptionsOfRecipes{
    "--pose",          "--height",     "--cull-from", "--size",   "--fov",      "--set",         "--backend",
    "--tolerance",     "--sun",        "--interest",  "--stereo", "--eye-base", "--convergence", "--latitude",
    "--stereo-method", "--stereo-gap", "--screens",   "--screen", "--head",     "--screen-eye"};

void check_overlay_layer(const std::string& path, const core::Overlays& overlays) {
  if (path.empty()) return;
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  if (extension != ".png")
    throw UsageError("--overlay-layer " + path + ": a layer has alpha; let the name end in .png");
  if (!overlay::any(overlays)) {
    throw UsageError("--overlay-layer " + path +
                     ": no overlay is set; for example, add --set overlay.graticule=on");
  }
}

void require_valid(const core::View& view) {
  if (const std::string error = core::check(view); !error.empty()) throw UsageError(error);
}

// Returns the files that an image is made of.
std::vector<std::filesystem::path> inputs_of_image(const RenderArguments& arguments,
                                                   const core::SettingsValues& settings) {
  std::vector<std::filesystem::path> inputs{arguments.planet, settings.names, settings.palette, settings.scene};
  for (const core::LayerFile& layer : core::parse_layer_list(settings.layers)) inputs.emplace_back(layer.path);
  return inputs;
}

}  // namespace

// Takes the arguments from the image of --from-image, if there is one. Returns the planet's identity, else "".
std::string take_recipe(RenderArguments& arguments, const Common& common) {
  if (arguments.from_image.empty()) {
    if (!arguments.pose)
      throw UsageError("--pose is required (or --from-image IMAGE); see 'vpe render --help'");
    show_differences(arguments.earlier, arguments.image);
    return {};
  }
  for (const std::string& word : common.words) {
    const std::string_view option = std::string_view(word).substr(0, word.find('='));
    if (std::ranges::find(kOptionsOfRecipes, option) == kOptionsOfRecipes.end()) continue;
    throw UsageError(std::string(option) + " and --from-image: the image says how it was made; leave one out");
  }
  const RenderRecipe recipe = read_recipe(arguments.from_image);
  arguments.pose = pose_text(recipe.pose);
  arguments.latitude = "planetocentric";
  arguments.height_m.reset();
  arguments.cull_from.reset();
  if (recipe.cull_pose) arguments.cull_from = pose_text(*recipe.cull_pose);
  arguments.size = std::to_string(recipe.width) + "x" + std::to_string(recipe.height);
  arguments.fov_deg = recipe.fov_deg;
  arguments.image.backend = recipe.backend;
  arguments.image.set = recipe.settings;
  arguments.image.tolerance_px = RenderOptions().tolerance_px;
  arguments.image.sun.clear();
  arguments.image.interest = recipe.interest;
  // The maps are outputs of this run.
  const StereoArguments asked = std::exchange(arguments.stereo, recipe.stereo);
  arguments.stereo.map = asked.map;
  arguments.stereo.differences = asked.differences;
  arguments.allow_underground = recipe.allow_underground;
  arguments.earlier_of_recipe = recipe.earlier;
  if (!recipe.earlier.empty() && arguments.earlier.empty()) {
    throw UsageError(arguments.from_image + ": shows differences from the planet of identity " +
                     recipe.earlier + "; name it with --compare");
  }
  return recipe.planet;
}

ParsedRender parse_view(const RenderArguments& arguments) {
  ParsedRender parsed;
  parsed.settings = make_settings(arguments.image);
  const core::SettingsValues& settings = parsed.settings.values();
  core::DrawRequest& request = parsed.request;
  const Size size = parse_size(arguments.size);
  request.view.width = size.width;
  request.view.height = size.height;
  request.view.fov_deg = arguments.fov_deg;
  request.interest = parse_interest(arguments.image);
  request.settings = settings;
  request.want_range =
      !arguments.range.empty() || !arguments.certificate.empty() || overlay::needs_range(settings);
  request.paging.timeout_s = arguments.image.wait_s;
  parsed.pose = parse_pose("--pose", *arguments.pose, arguments.height_m);
  if (arguments.cull_from) {
    const ParsedPose cull = parse_pose("--cull-from", *arguments.cull_from);
    if (!cull.name.empty())
      throw UsageError("--cull-from '" + *arguments.cull_from + "': give numbers, and not a name");
    parsed.cull_pose = cull.pose;
  }
  parsed.screen = choose_screen(arguments.screen);
  if (parsed.screen && !arguments.stereo.layout.empty())
    throw UsageError("--screens and --stereo: draw each eye by itself with --screen-eye left and right");
  if (parsed.screen && parsed.cull_pose) throw UsageError("--screens and --cull-from: leave one out");
  if (parsed.screen && parsed.screen->lens() != nullptr &&
      !(arguments.range + arguments.overlay_layer).empty()) {
    throw UsageError(
        "--range and --overlay-layer: the image of a screen behind a lens is bent, and they are not; leave them out");
  }
  return parsed;
}

void check_render_outputs(const RenderArguments& arguments, const core::SettingsValues& settings) {
  check_outputs({{"-o", arguments.output, FileKind::kImage},
                 {"--range", arguments.range, FileKind::kRange},
                 {"--certificate", arguments.certificate, FileKind::kCertificate},
                 {"--explain-lod", arguments.explain_lod, FileKind::kExplanation},
                 {"--overlay-layer", arguments.overlay_layer, FileKind::kImage},
                 {"--stereo-map", arguments.stereo.map, FileKind::kImage},
                 {"--stereo-differences", arguments.stereo.differences, FileKind::kImage}},
                inputs_of_image(arguments, settings));
  check_overlay_layer(arguments.overlay_layer, settings);
  check_stereo(arguments.stereo);
  if (arguments.stereo.layout.empty()) return;
  if (!arguments.range.empty() || !arguments.explain_lod.empty() || !arguments.overlay_layer.empty()) {
    throw UsageError(
        "--range, --explain-lod and --overlay-layer describe the image of one eye; leave out --stereo, or "
        "render each eye by itself");
  }
}

ResolvedView resolve_view(const ParsedRender& parsed, const std::shared_ptr<const paging::PlanetFile>& planet) {
  core::DrawRequest request = parsed.request;
  const mars::Pose pose = resolve(parsed.pose, planet, request.settings.exaggeration);
  if (parsed.screen) {
    request.view = screen_view_of(*parsed.screen, pose, planet->radius_m());
  } else {
    request.view.camera = mars::to_camera(pose, planet->radius_m());
  }
  require_valid(request.view);
  request.sun = sun_for(request.settings, pose);
  if (parsed.cull_pose) {
    request.cull_view = request.view;
    request.cull_view->camera = mars::to_camera(*parsed.cull_pose, planet->radius_m());
    require_valid(*request.cull_view);
  }
  return {pose, std::move(request)};
}

RenderRecipe recipe_of(const RenderArguments& arguments, const core::Settings& settings, const mars::Pose& pose,
                       const ParsedRender& parsed, const paging::PlanetFile& planet) {
  RenderRecipe recipe;
  recipe.pose = pose;
  recipe.cull_pose = parsed.cull_pose;
  recipe.width = parsed.request.view.width;
  recipe.height = parsed.request.view.height;
  recipe.fov_deg = arguments.fov_deg;
  recipe.backend = *arguments.image.backend;
  recipe.settings = changed_settings(settings, arguments.overlay_layer.empty());
  recipe.interest = arguments.image.interest;
  recipe.stereo = arguments.stereo;
  recipe.allow_underground = arguments.allow_underground;
  recipe.planet = planet.meta().identity;
  if (planet.earlier()) recipe.earlier = planet.earlier()->meta().identity;
  return recipe;
}

}  // namespace vpe::app
