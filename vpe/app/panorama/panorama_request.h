// A panorama as a value: everything that its image depends on, by options or by the sidecar of an earlier one.
//
// Typical usage:
//   PanoramaRequest request = parse_panorama(arguments, common);  // once, from the command line or a sidecar
//   const PanoramaPlan plan = plan_panorama(request);             // map, strips and sizes (panorama_plan.h)
//   ...                                                           // camera, eyes and names of this planet
//   PanoramaMaker(request, plan, ...).run(...);                   // strips (panorama_maker.h)
//   join_strips(request, plan, ...);                              // files (panorama_files.h)
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "panorama/panorama_plan.h"
#include "panorama/planes.h"
#include "panorama/stereo_pieces.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/panorama/panorama_page.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/stereo_render.h"
#include "vpe/core/appearance/settings.h"
#include "vpe/core/backend.h"

namespace vpe::app {

// Holds the command line of `vpe panorama` as it is written.
struct PanoramaArguments {
  std::string planet;
  std::string at;
  std::string latitude;  // vpe/app/planet/latitude_option.h
  std::optional<double> height_m;
  std::optional<double> altitude_m;
  std::string output;
  std::string projection;
  int facets = panorama::PlanLimits::kDefaultFacets;
  double yaw_deg = 0;
  std::optional<double> from_deg;
  std::optional<double> to_deg;
  std::string elevation;
  std::optional<std::int64_t> width_px;
  std::optional<double> degrees_per_pixel;
  std::string aux_layers;
  std::string from_sidecar;
  bool has_facets = false;  // --facets is given
  bool has_yaw = false;     // --yaw is given
  RenderOptions render;
  StereoArguments stereo;
  PageArguments page;
};

struct PanoramaRequest {
  // What the image depends on. The sidecar holds these fields as its recipe.
  panorama::PlanOptions map;  // projection, arc, elevations and size
  mars::Pose camera;          // yaw, pitch and roll 0; alt_m is not known yet where height_m is set
  core::Backend backend = core::Backend::kRay;
  core::Settings settings;
  std::vector<std::string> interest;        // as --interest
  std::vector<panorama::Plane> layers;      // auxiliary layers
  std::optional<panorama::EyePair> stereo;  // nullopt: one eye; base_m 0: not chosen yet (measure_eyes)
  std::string planet;                       // file, absolute; empty: the embedded Mars
  std::string identity;                     // PlanetMeta::identity; empty: not known yet
  int memory_mb = 0;  // bounds what polygons may take; 0 for rays, whose images do not depend on it
  bool allow_incomplete = false;
  std::string names_checksum;   // of the file of overlay.names, when it is set
  std::string layers_checksum;  // of the files of overlay.layers, when it is set
  std::string scene_checksum;   // of the scene and its models, when there is one

  // How this run makes it.
  std::string latitude;            // as --latitude: of camera and interest, until the planet is open
  std::string place_name;          // of the camera's place on Mars; empty: coordinates were given
  std::optional<double> height_m;  // above the terrain as drawn, in place of camera.alt_m
  double wait_s = 300;             // for the tiles of a piece
  std::filesystem::path output;
  std::string from_sidecar;  // sidecar that the recipe was read from; empty: options
};

// Parses the command line, and the sidecar that --from-sidecar names. Rays draw unless triangles are named.
// Throws UsageError, and base::FileError for a sidecar that cannot be used.
PanoramaRequest parse_panorama(const PanoramaArguments& arguments, const Common& common);

// Returns the options for renderers, of the request's backend.
RenderOptions render_options(const PanoramaRequest& request);

// Returns the recipe of a sidecar. Every number keeps its bits: request_from_recipe(recipe_json(r)) has the
// recipe of r.
nlohmann::ordered_json recipe_json(const PanoramaRequest& request);

// Reads a recipe, also one of an earlier version with former names. Throws panorama::MetadataError naming the
// key that is missing or wrong.
PanoramaRequest request_from_recipe(const nlohmann::json& json);

}  // namespace vpe::app
