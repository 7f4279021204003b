// The line below the view: the place under the cursor, the camera, and how the image was drawn.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "vpe/explore/files/preferences.h"
#include "vpe/explore/measure/read_out.h"
#include "vpe/explore/session.h"
#include "vpe/window/workers/painter.h"

namespace vpe::window {

// Returns a place as "4.58950° S  137.44170° E", the longitude from 0 to 360 or to 180 on either side. Pure.
std::string hemisphere_text(mars::LonLat place, explore::LongitudeRange range);

// Returns angles of the camera as "heading 90.0°  pitch -20.0°  roll 3.0°", never -0.0 nor 360.0. Pure.
std::string attitude_text(const mars::Pose& pose);

// Describes the place under the cursor: coordinates, elevation, slope, source and spacing of its posts. Pure.
std::string cursor_text(const explore::ReadOut& read_out, explore::LongitudeRange range);

// Returns a text without the last of its parts, which three blanks separate, until it is at most so wide. The first part
// stays. Pure if width_px is.
std::string fitting_parts(std::string text, double room_px,
                          const std::function<double(const std::string&)>& width_px);

// Describes the camera: place, height above the ground, attitude. Pure.
std::string camera_text(const explore::Session& session, explore::LongitudeRange range);

// Describes how good an image is in one word, and in full.
struct QualityText {
  std::string word;     // "exact", "within 1.9 px", "coarser while moving", "loading 12"
  std::string details;  // one figure a line
};
// Pure. `finest_post_m` is the spacing of posts of the finest level in the image.
QualityText quality_text(const DrawnImage& drawn, const std::string& mode, int finest_level,
                         double finest_post_m, double mean_s);

}  // namespace vpe::window
