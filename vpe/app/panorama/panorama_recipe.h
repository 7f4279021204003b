// All that a panorama's image depends on, as one value that its sidecar keeps.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "mars/geodesy/pose.h"
#include "panorama/panorama_plan.h"
#include "panorama/planes.h"
#include "panorama/stereo_pieces.h"
#include "vpe/core/appearance/settings.h"

namespace vpe::app {

struct PanoramaRecipe {
  panorama::PlanOptions plan;
  mars::Pose camera;  // yaw, pitch and roll 0
  std::string backend;
  core::Settings settings;
  std::vector<std::string> interest;  // as --interest
  std::vector<panorama::Plane> planes;
  std::optional<panorama::EyePair> stereo;  // nothing: one eye
  std::string planet;                       // file, absolute; empty: the embedded Mars
  std::string identity;                     // PlanetMeta::identity
  int memory_mb = 0;  // bounds what polygons may take; 0 for rays, whose images do not depend on it
  bool allow_incomplete = false;
  std::string names_checksum;  // of the file of overlay.names, when it is set
};

// Every number to the bit: recipe_from(to_json(r)) is r.
nlohmann::ordered_json to_json(const PanoramaRecipe& recipe);
// Throws panorama::MetadataError naming the key that is missing or wrong.
PanoramaRecipe recipe_from(const nlohmann::json& json);

}  // namespace vpe::app
