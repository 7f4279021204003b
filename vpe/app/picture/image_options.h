// Options and steps that all commands that draw share.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lod/explain.h"
#include "paging/planet/planet_file.h"
#include "vpe/app/cli/program.h"
#include "vpe/core/backend.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Values of the options that add_render_options() adds.
struct RenderOptions {
  std::vector<std::string> set;          // KEY=VALUE
  std::string sun;                       // value of the setting; empty: the setting stays
  std::optional<core::Backend> backend;  // nullopt: auto, the choice of choose_backend()
  std::string scene;                     // value of the setting; empty: the setting stays
  double tolerance_px = -1;              // < 0: the setting stays
  // For the tiles of an image. Smaller: a slow disk or server fails the image sooner; larger: it is waited for.
  double wait_s = 300;
  bool allow_incomplete = false;
  std::vector<std::string> interest;  // LON,LAT,RADIUS_M,LEVELS
};

// Adds --set, --backend, --tolerance, --sun, --scene, --wait, --allow-incomplete and --interest to a command. The values
// in `options` at this moment are the defaults.
//
// Typical usage:
//   add_render_options(*command, arguments->image);   // once, with the command's declaration
//   core::DrawRequest request;                        // when the command runs
//   const core::Settings settings = make_settings(arguments.image);
//   request.settings = settings.values();
//   request.interest = parse_interest(arguments.image);
//   const auto renderer = make_renderer(arguments.image, common, planet);
//   const core::DrawResult result = renderer->draw(request);
//   require_complete(arguments.image, result);
void add_render_options(CLI::App& command, RenderOptions& options);

// Returns the default settings (sky, and image or elevation colours) changed by --tolerance, --sun and --scene, then
// every --set in order. Throws UsageError that names the key, and what read_scene_file() throws.
core::Settings make_settings(const RenderOptions& options);

// Returns the regions of every --interest, in order. Throws UsageError that says what is expected.
std::vector<core::InterestRegion> parse_interest(const RenderOptions& options);

// Makes the latitudes in texts of --interest planetocentric, as --latitude says
// (vpe/app/planet/latitude_option.h). The texts must be ones that parse_interest() accepts.
void make_interest_planetocentric(std::vector<std::string>& interest, const std::string& latitude,
                                  const paging::PlanetMeta& meta);

// Returns --memory in bytes.
std::size_t memory_bytes(const Common& common);

// Makes the renderer of the options' backend. Throws std::logic_error when that is auto, and what the backends
// throw. Rays explain their tiles to `explained` (RayOptions::explained).
std::unique_ptr<core::Renderer> make_renderer(const RenderOptions& options, const Common& common,
                                              std::shared_ptr<const paging::PlanetFile> planet,
                                              std::vector<lod::TileExplanation>* explained = nullptr);

// Throws UsageError if the settings weigh what a budget takes (degrade.*) and images that are drawn in full have none:
// rays, and triangles without lod.triangles. Frames of windows have a budget of time.
void require_budget(const core::SettingsValues& settings, core::Backend backend);

// Throws std::runtime_error that names the missing tiles of an image, unless the options allow them. Unreadable
// tiles come first: tiles below them are missing for the same reason.
void require_complete(const RenderOptions& options, const core::DrawResult& result);

// Prints a note on stderr, with what to do, if an image of triangles is coarser than its tolerance because
// --memory is not enough for more triangles. Says nothing where lod.triangles or level control decide, and about
// incomplete images.
void note_limited_by_memory(const RenderOptions& options, const Common& common,
                            const core::DrawRequest& request, const core::DrawResult& result);

// Prints failures to read tiles (core::DrawResult::failures) as warnings on stderr.
void print_failures(std::span<const std::string> failures);

// Returns the direction towards the sun at the ground below a pose: for the setting's date, for its season and
// hour, or for azimuth and elevation.
glm::dvec3 sun_for(const core::SettingsValues& settings, const mars::Pose& pose);

// Pixels.
struct Size {
  int width = 0;
  int height = 0;
};
// Parses "1280x720". Throws UsageError for any other text and for a size outside core::ViewLimits.
Size parse_size(const std::string& text);

}  // namespace vpe::app
