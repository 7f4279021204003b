// The options of vpe render, and what they ask for.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/pose_option.h"
#include "vpe/app/picture/render_recipe.h"
#include "vpe/app/picture/screen_option.h"
#include "vpe/app/picture/stereo_render.h"
#include "vpe/core/frame.h"

namespace vpe::app {

struct RenderArguments {
  std::string planet;
  std::optional<std::string> pose;  // needed unless from_image is given
  std::string from_image;           // image whose recipe replaces the options of the view
  std::optional<double> height_m;
  std::optional<std::string> cull_from;
  std::string latitude;           // latitude_option.h
  std::string earlier;            // planet of --compare
  std::string earlier_of_recipe;  // identity of the one that from_image was compared with
  std::string output;
  std::string range;
  std::string certificate;
  std::string explain_lod;
  std::string overlay_layer;
  std::string size = "1280x720";
  double fov_deg = 60;
  bool allow_underground = false;
  RenderOptions image;
  StereoArguments stereo;
  ScreenArguments screen;
};

// Holds the arguments, parsed and checked. Only what needs the planet is left to resolve_request().
struct ParsedRender {
  core::Settings settings;
  ParsedPose pose;
  std::optional<mars::Pose> cull_pose;  // of the view whose tiles are drawn
  std::optional<ChosenScreen> screen;   // whose image is drawn
  core::DrawRequest request;            // without camera, cull view and sun
};

// Takes the arguments from the recipe of --from-image, if that is given. Returns the identity of its planet, else "".
// Throws UsageError if a view is given twice or not at all, and what read_recipe() throws.
std::string take_recipe(RenderArguments& arguments, const Common& common);

// Parses the arguments of a view. Throws UsageError.
ParsedRender parse_view(const RenderArguments& arguments);

// Throws UsageError for outputs that cannot be made, alone or beside each other.
void check_render_outputs(const RenderArguments& arguments, const core::SettingsValues& settings);

struct ResolvedView {
  mars::Pose pose;
  core::DrawRequest request;
};
// Returns the request over the planet. Throws UsageError for a view that cannot be drawn, and what resolve() throws.
ResolvedView resolve_view(const ParsedRender& parsed, const std::shared_ptr<const paging::PlanetFile>& planet);

// Returns the recipe of the image. The backend of the arguments is the one that draws, and the settings are those
// that it is given.
RenderRecipe recipe_of(const RenderArguments& arguments, const core::Settings& settings, const mars::Pose& pose,
                       const ParsedRender& parsed, const paging::PlanetFile& planet);

}  // namespace vpe::app
