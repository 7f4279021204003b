// What `vpe panorama` is asked for: by options, or by the sidecar of a panorama that is made again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "vpe/app/cli/program.h"
#include "vpe/app/panorama/panorama_recipe.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/stereo_render.h"

namespace vpe::app {

struct PanoramaArguments {
  std::string planet;
  std::string at;
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
  std::string planes;
  std::string again;
  bool has_facets = false;
  bool has_yaw = false;
  RenderOptions panorama_image;
  StereoArguments stereo;
};

// What a panorama is to be, but for what only the planet knows.
struct PanoramaOrder {
  PanoramaRecipe recipe;
  std::optional<double> height_m;  // above the ground, in place of recipe.camera.alt_m
  StereoArguments stereo;          // recipe.stereo is what the planet lets become of it
  std::filesystem::path output;
  std::string again;  // sidecar that is made again, or empty
};

// Both throw UsageError, panorama::PlanError, and base::FileError for a sidecar that cannot be used. Rays draw
// unless triangles are named.
PanoramaOrder new_order(PanoramaArguments arguments, const Common& common);
PanoramaOrder order_again(const PanoramaArguments& arguments, const Common& common);

}  // namespace vpe::app
