// Options and steps that every command that draws has in common.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/app/cli/program.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Values of --backend.
inline const std::string kAutoBackend = "auto";  // as backend_choice.h chooses
inline const std::string kPolygonBackend = "polygon";
inline const std::string kRayBackend = "voxel";

struct RenderOptions {
  std::vector<std::string> set;  // KEY=VALUE
  std::string sun;               // as the setting; empty: as set
  std::string backend = kAutoBackend;
  double tolerance_px = -1;  // < 0: as set
  double wait_s = 300;       // for the tiles of an image
  bool allow_incomplete = false;
  std::vector<std::string> interest;  // LON,LAT,RADIUS_M,LEVELS
};

void add_render_options(CLI::App& command, RenderOptions& options);

// Default settings (sky, and image or elevation colours), then --tolerance and --sun, then every --set in
// order. Throws UsageError naming the key.
core::Settings make_settings(const RenderOptions& options);

// The regions of every --interest, in order. Throws UsageError that says what is expected.
std::vector<core::InterestRegion> parse_interest(const RenderOptions& options);

std::size_t memory_bytes(const Common& common);
// Of a named backend.
std::unique_ptr<core::Renderer> make_renderer(const RenderOptions& options, const Common& common,
                                              std::shared_ptr<const paging::PlanetFile> planet);

// Throws std::runtime_error that names what is missing in an image, unless that is allowed.
void require_complete(const RenderOptions& options, const core::DrawResult& result);

// Where the sun stands: for its date, or for season and hour, or azimuth and elevation, at the ground below a
// pose.
glm::dvec3 sun_for(const core::SettingsValues& settings, const mars::Pose& pose);

struct Size {
  int width = 0;
  int height = 0;
};
// "1280x720"; throws UsageError for anything else or a size outside ViewLimits.
Size parse_size(const std::string& text);

}  // namespace vpe::app
