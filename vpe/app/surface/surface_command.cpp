// vpe surface.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <glm/geometric.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "relief/files/surface_file.h"
#include "vpe/app/cli/examples.h"
#include "vpe/app/cli/figures.h"
#include "vpe/app/cli/json_output.h"
#include "vpe/app/cli/output.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/surface/commands.h"
#include "vpe/app/surface/surface_image.h"
#include "vpe/app/surface/surface_scene.h"
#include "vpe/app/surface/surface_view.h"
#include "vpe/base/number.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/core/image/image.h"

namespace vpe::app {

namespace {

struct SurfaceArguments {
  std::string file;
  std::string output;
  std::string range;
  std::string sun;
  SurfaceViewArguments view;
  SurfaceImageOptions image;
  bool has_no_shadows = false;
};

// Returns the usual sun: from the left of the camera and above it.
glm::dvec3 beside_camera(const core::View& view) {
  const mars::Axes& axes = view.camera.axes;
  return glm::normalize(axes.up - axes.right - 0.6 * axes.forward);
}

nlohmann::json to_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// Range and height of each ray are held.
void require_memory(const core::View& view, int samples, const Common& common) {
  const double bytes = 16.0 * view.width * view.height * samples * samples;
  if (bytes > static_cast<double>(memory_bytes(common)))
    throw UsageError("--samples " + std::to_string(samples) + ": an image of this size needs " +
                     bytes_text(bytes) + "; give fewer samples, a smaller --size, or a larger --memory");
}

void print_report(const SurfaceArguments& arguments, const Common& common, const SurfaceScene& scene,
                  const core::View& view, const SurfaceImage& image) {
  const double share = static_cast<double>(image.hits) / static_cast<double>(image.rays);
  if (common.json) {
    const bool has_ground = image.hits > 0;
    const auto figure = [has_ground](double value) {
      return has_ground ? nlohmann::json(value) : nlohmann::json();
    };
    print_json({{"output", arguments.output},
                {"camera_m", to_json(view.camera.position_m)},
                {"forward", to_json(view.camera.axes.forward)},
                {"towards_sun", to_json(arguments.image.towards_sun)},
                {"posts", scene.posts},
                {"reliefs", scene.reliefs},
                {"radius_m", scene.radius_m},
                {"facet_deviation_m", scene.facet_deviation_m},
                {"rays", image.rays},
                {"share_of_ground", share},
                {"range_m", {figure(image.least_range_m), figure(image.most_range_m)}},
                {"height_m", {figure(image.least_height_m), figure(image.most_height_m)}},
                {"counts",
                 {{"bundles", image.counts.bundles},
                  {"steps", image.counts.steps},
                  {"patches", image.counts.patches}}}});
    return;
  }
  if (common.quiet) return;
  std::printf("%s: %s rays, %s %% of them on the ground", arguments.output.c_str(),
              base::format_number(static_cast<double>(image.rays)).c_str(),
              base::format_rounded(100 * share, 1).c_str());
  if (image.hits > 0)
    std::printf(", from %s to %s away; heights %s to %s above the base",
                length_text(image.least_range_m).c_str(), length_text(image.most_range_m).c_str(),
                length_text(image.least_height_m).c_str(), length_text(image.most_height_m).c_str());
  std::printf("\n");
}

void run_surface(SurfaceArguments& arguments, const Common& common) {
  const ParsedSurfaceView parsed = parse_surface_view(arguments.view);
  if (!arguments.image.palette.empty()) {
    if (const std::string problem = core::palette_problem(arguments.image.palette); !problem.empty())
      throw UsageError("--palette " + arguments.image.palette + ": " + problem);
  }
  const std::optional<glm::dvec3> sun =
      arguments.sun.empty() ? std::nullopt : std::optional(parse_direction("--sun", arguments.sun));
  check_outputs({{"-o", arguments.output, FileKind::kImage}, {"--range", arguments.range, FileKind::kRange}},
                {arguments.file});
  require_memory(parsed.view, arguments.image.samples, common);
  const SurfaceScene scene = open_surface(arguments.file);
  const core::View view = resolve_view(parsed, scene);
  arguments.image.towards_sun = sun.value_or(beside_camera(view));
  arguments.image.has_shadows = !arguments.has_no_shadows;
  base::ThreadPool pool(common.threads);
  const SurfaceImage image = draw_surface(scene.surface, view, arguments.image, pool);
  core::write_image(arguments.output, image.colours.pixels, image.colours.width, image.colours.height);
  if (!arguments.range.empty()) {
    core::write_tiff(arguments.range, surface_ranges(scene.surface, view, arguments.image.tolerance_px, pool),
                     view.width, view.height);
  }
  print_report(arguments, common, scene, view, image);
}

}  // namespace

void add_surface(CLI::App& program, Common& common) {
  auto arguments = std::make_shared<SurfaceArguments>();
  CLI::App* command = add_command(
      program, "surface",
      "Draw a body or a plane of a surface file: a sphere, an ellipsoid or a quadric with height maps and reliefs",
      common, true);
  command->add_option("FILE", arguments->file, "Surface file (*.surface.toml)")->required();
  command->add_option("-o,--output", arguments->output, "Image to write (.png, .jpg)")->required();
  command->add_option("--range", arguments->range, "Also write the range of every pixel, metres (.tif)");
  command->add_option(
      "--from", arguments->view.from,
      "LON,LAT[,RANGE]: direction of the camera from its target, degrees in the axes of the base, and "
      "distance, metres (default: the whole surface in the image)");
  command->add_option("--camera", arguments->view.camera,
                      "X,Y,Z of the camera, metres in the axes of the base");
  command->add_option("--target", arguments->view.target,
                      "X,Y,Z at which the camera looks, metres (default: the middle of the surface)");
  command->add_option("--size", arguments->view.size, "WIDTHxHEIGHT of the image, pixels")
      ->capture_default_str();
  command->add_option("--fov", arguments->view.fov_deg, "Vertical field of view, degrees")
      ->check(number_within(core::ViewLimits::kMinFov_deg, core::ViewLimits::kMaxFov_deg))
      ->capture_default_str();
  command->add_option(
      "--sun", arguments->sun,
      "LON,LAT: direction towards the sun, degrees in the axes of the base (default: left of the camera)");
  command->add_flag("--no-shadows", arguments->has_no_shadows, "Leave out shadows that the ground casts");
  command->add_option("--palette", arguments->image.palette,
                      "Colours of heights above the base: " + core::palette_grammar() + " (default: grey)");
  command->add_option("--samples", arguments->image.samples, "Rays on a side of a pixel; more: smoother edges")
      ->check(CLI::Range(1, kMostSamples))
      ->capture_default_str();
  command
      ->add_option("--tolerance", arguments->image.tolerance_px,
                   "Rays may end this many pixels above the ground; 0: exact; larger: quicker on fine maps")
      ->check(number_within(0, 100))
      ->capture_default_str();
  add_examples(*command,
               {{"the whole body, lit from the left", "vpe surface phobos.surface.toml -o phobos.png"},
                {"from above 30 E, 20 N, in colours of height",
                 "vpe surface phobos.surface.toml --from 30,20,40000 --palette relief -o phobos.png"},
                {"ranges for a program, sun from the east",
                 "vpe surface pit.surface.toml --camera 0,-900,400 --sun 0,20 -o pit.png --range pit.tif"}});
  command->callback([arguments, &common] { run_surface(*arguments, common); });
}

}  // namespace vpe::app
