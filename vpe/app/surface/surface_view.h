// The camera of an image of a surface.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "vpe/app/surface/surface_scene.h"
#include "vpe/core/view.h"

namespace vpe::app {

// Holds the options of a camera as the user gave them. Metres in the axes of the base.
struct SurfaceViewArguments {
  std::string from;    // LON,LAT[,RANGE]: direction from the target, and distance; empty: usual ones
  std::string camera;  // X,Y,Z in place of from
  std::string target;  // X,Y,Z; empty: the middle of the surface
  std::string size = "1280x720";
  double fov_deg = 40;
};

// Holds the same, parsed and checked. Only the surface can tell the rest.
struct ParsedSurfaceView {
  std::optional<glm::dvec3> direction;  // from the target, unit
  std::optional<double> range_m;
  std::optional<glm::dvec3> camera_m;
  std::optional<glm::dvec3> target_m;
  core::View view;  // without a camera
};

// Throws UsageError that names the option.
ParsedSurfaceView parse_surface_view(const SurfaceViewArguments& arguments);

// Returns the view: up is z, or y where the camera looks along z. Without a range the whole surface is in the image.
// Throws UsageError for a camera at its target, and std::runtime_error for one below the ground.
core::View resolve_view(const ParsedSurfaceView& parsed, const SurfaceScene& scene);

// Parses "LON,LAT" of a direction in degrees: from x towards y, and towards z. Throws UsageError that names the option.
glm::dvec3 parse_direction(const std::string& option, const std::string& text);

}  // namespace vpe::app
