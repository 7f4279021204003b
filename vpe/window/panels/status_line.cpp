#include "vpe/window/panels/status_line.h"

#include <algorithm>
#include <cmath>

#include "vpe/base/number.h"
#include "vpe/explore/measure/angle_text.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

std::string hemisphere_text(mars::LonLat place, explore::LongitudeRange range) {
  const double lat = std::abs(place.lat_deg);
  const double lon = range == explore::LongitudeRange::kPositive
                         ? (place.lon_deg < 0 ? place.lon_deg + 360 : place.lon_deg)
                         : std::abs(place.lon_deg);
  const bool is_west = range == explore::LongitudeRange::kSigned && place.lon_deg < 0;
  return formatted("%.5f\u00b0 %s  %.5f\u00b0 %s", lat, place.lat_deg < 0 && lat >= 5e-6 ? "S" : "N", lon,
                   is_west ? "W" : "E");
}

std::string attitude_text(const mars::Pose& pose) {
  return "heading " + explore::heading_text(pose.yaw_deg, 1) + "\u00b0  pitch " +
         explore::angle_text(pose.pitch_deg, 1) + "\u00b0  roll " + explore::angle_text(pose.roll_deg, 1) +
         "\u00b0";
}

std::string cursor_text(const explore::ReadOut& read_out, explore::LongitudeRange range) {
  const paging::PlaceAnswer& at = read_out.at;
  std::string text = hemisphere_text(at.place, range);
  if (at.nodata) return text + "   no data";
  text += "   " + base::format_display(at.elevation_m, 1) + " m";
  text += "   slope " + base::format_display(at.slope_deg, 0) + "\u00b0";
  if (!read_out.source.empty()) text += "   " + read_out.source;
  if (read_out.source_spacing_m > 0) text += " " + explore::measured_length_text(read_out.source_spacing_m);
  return text;
}

std::string fitting_parts(std::string text, double room_px,
                          const std::function<double(const std::string&)>& width_px) {
  while (width_px(text) > room_px) {
    const std::size_t end = text.rfind("   ");
    if (end == std::string::npos) break;
    text.resize(end);
  }
  return text;
}

std::string camera_text(const explore::Session& session, explore::LongitudeRange range) {
  const mars::Pose& pose = session.pose();
  if (session.is_orthographic()) {
    const auto shown_m = explore::shown_height_m(pose, session.screen(), session.ground());
    return hemisphere_text({pose.lon_deg, pose.lat_deg}, range) + "   orthographic" +
           (shown_m ? ", " + panel_length_text(*shown_m) + " high" : "") + "   " + attitude_text(pose);
  }
  return hemisphere_text({pose.lon_deg, pose.lat_deg}, range) + "   " + panel_length_text(session.height_m()) +
         " above ground   " + attitude_text(pose);
}

QualityText quality_text(const DrawnImage& drawn, const std::string& mode, int finest_level,
                         double finest_post_m, double mean_s) {
  const core::DrawResult& r = drawn.result;
  const bool is_rays = drawn.request.backend == core::Backend::kRay;
  const double shift_px = r.certificate.shift_bound_px / drawn.request.px_per_screen_px;
  const std::int64_t loading = r.stats.pages_wanted + r.stats.pages_loading;
  const std::string bound = formatted("within %.2f px", shift_px);
  constexpr double kExact_px = 0.05;  // of the rasteriser's grid
  QualityText text;
  if (!drawn.request.is_full)
    text.word = "coarser while moving";
  else if (loading > 0 && !r.settled)
    text.word = "loading " + std::to_string(loading);
  else
    text.word = shift_px <= kExact_px ? "exact" : bound;
  const core::View& view = drawn.request.draw.view;
  text.details =
      mode + (is_rays ? " by rays" : " by triangles") + (drawn.request.is_auto ? " (quicker here)" : "");
  text.details += "\nerror of the image: " + bound;
  if (drawn.request.is_full && r.settled && shift_px > drawn.request.draw.settings.lod_tolerance_px)
    text.details += ": the finest ground that there is, seen from very near";
  text.details +=
      "\nfinest level " + std::to_string(finest_level) + ": posts every " + panel_length_text(finest_post_m);
  text.details +=
      "\n" + (is_rays ? formatted("%.0f thousand rays", view.width * view.height / 1e3)
                      : formatted("%.0f thousand triangles", static_cast<double>(r.stats.triangles) / 1e3));
  text.details +=
      "\n" + formatted("tiles in memory: %.0f MB", static_cast<double>(r.stats.bytes_resident) / 1e6);
  text.details += "\n" + formatted("an image takes %.0f ms", mean_s * 1e3);
  if (drawn.request.stereo) text.details += "\nfigures of the left eye";
  return text;
}

}  // namespace vpe::window
