// The recipe of an image: everything that the same program needs to draw it again, kept in the text of PNG files.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "paging/planet/planet_meta.h"
#include "vpe/app/picture/stereo_render.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/core/appearance/settings.h"
#include "vpe/core/backend.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"

namespace vpe::app {

struct RenderRecipe {
  mars::Pose pose;  // its altitude is that of the camera, also where a height above the ground was given
  std::optional<mars::Pose> cull_pose;
  int width = 0;
  int height = 0;
  double fov_deg = 0;
  core::Backend backend = core::Backend::kPolygon;
  std::vector<std::string> settings;  // KEY=VALUE of those that are not at their defaults
  std::vector<std::string> interest;
  StereoArguments stereo;
  bool allow_underground = false;
  std::optional<core::PaletteEnds>
      palette;          // those taken from the view; for readers, since they follow from the rest
  std::string planet;   // PlanetMeta::identity
  std::string earlier;  // the same of the planet that it was compared with; empty: none
};

// Returns an object with low and high, or null.
nlohmann::json palette_json(const std::optional<core::PaletteEnds>& palette);

// Returns the settings that differ from the defaults, as KEY=VALUE. Without `overlays` those are left out.
std::vector<std::string> changed_settings(const core::Settings& settings, bool overlays = true);

// Returns the texts of a PNG: "Software", and "vpe" with the recipe, the planet and the certificate as JSON.
std::vector<core::PngText> recipe_texts(const RenderRecipe& recipe, const paging::PlanetMeta& planet,
                                        const nlohmann::ordered_json& certificate);

// Reads the recipe of an image that vpe render wrote. Throws base::FileError that says why it has none.
RenderRecipe read_recipe(const std::filesystem::path& image);

// Returns a pose as the options take it.
std::string pose_text(const mars::Pose& pose);

// Returns what GDAL shows of a raster of ranges: its unit, the value of the sky, camera and planet.
core::TiffMetadata range_metadata(const mars::Pose& pose, const core::View& view,
                                  const paging::PlanetMeta& planet);

}  // namespace vpe::app
