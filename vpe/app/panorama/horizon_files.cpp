#include "vpe/app/panorama/horizon_files.h"

#include "vpe/app/cli/json_output.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

using base::format_fixed;

// Places to a millimetre, angles to well below the skyline's own accuracy.
constexpr int kPlaceDecimals = 8;
constexpr int kAngleDecimals = 7;

// Returns an azimuth, 0 where it would round to 360.
std::string azimuth(double degrees) {
  const std::string text = format_fixed(degrees, kAngleDecimals);
  return text == format_fixed(360, kAngleDecimals) ? format_fixed(0, kAngleDecimals) : text;
}

std::string csv_point(const panorama::GroundPoint& p) {
  return format_fixed(p.place.lon_deg, kPlaceDecimals) + "," + format_fixed(p.place.lat_deg, kPlaceDecimals) +
         ",";
}

}  // namespace

std::string skyline_csv(std::span<const panorama::GroundPoint> skyline, std::span<const std::string> objects) {
  std::string out = "azimuth_deg,elevation_deg,range_m,lon_deg,lat_deg,elevation_m";
  out += objects.empty() ? "\n" : ",object\n";
  for (std::size_t n = 0; n < skyline.size(); ++n) {
    const panorama::GroundPoint& p = skyline[n];
    out += base::format_number(p.direction.azimuth_deg) + "," +
           format_fixed(p.direction.elevation_deg, kAngleDecimals) + "," + format_fixed(p.range_m, 3) + "," +
           csv_point(p) + format_fixed(p.elevation_m, 3);
    out += objects.empty() ? "\n" : "," + csv_field(objects[n]) + "\n";
  }
  return out;
}

std::string landmarks_csv(std::span<const panorama::Landmark> landmarks) {
  std::string out =
      "name,lon_deg,lat_deg,diameter_km,azimuth_deg,elevation_deg,range_m,elevation_m,visible,"
      "hidden_by_lon_deg,hidden_by_lat_deg,hidden_by_range_m,hidden_by_elevation_m,hidden_by_name\n";
  for (const panorama::Landmark& l : landmarks) {
    const double diameter_km = l.feature.diameter_m / 1000;
    out += csv_field(l.feature.name) + "," + base::format_number(l.feature.lon_deg) + "," +
           base::format_number(l.feature.lat_deg) + "," +
           (diameter_km > 0 ? base::format_number(diameter_km) : std::string()) + "," +
           azimuth(l.centre.direction.azimuth_deg) + "," +
           format_fixed(l.centre.direction.elevation_deg, kAngleDecimals) + "," +
           format_fixed(l.centre.range_m, 3) + "," + format_fixed(l.centre.elevation_m, 3) + "," +
           (l.hidden_by ? "0," : "1,");
    if (l.hidden_by) {
      out += csv_point(*l.hidden_by) + format_fixed(l.hidden_by->range_m, 3) + "," +
             format_fixed(l.hidden_by->elevation_m, 3) + "," + csv_field(l.hidden_by_name) + "\n";
    } else {
      out += ",,,,\n";
    }
  }
  return out;
}

nlohmann::json point_json(const panorama::GroundPoint& p) {
  return {{"azimuth_deg", p.direction.azimuth_deg},
          {"elevation_deg", p.direction.elevation_deg},
          {"range_m", p.range_m},
          {"lon_deg", p.place.lon_deg},
          {"lat_deg", p.place.lat_deg},
          {"elevation_m", p.elevation_m}};
}

nlohmann::json landmark_json(const panorama::Landmark& l) {
  nlohmann::json out = point_json(l.centre);
  out["name"] = l.feature.name;
  out["diameter_m"] = l.feature.diameter_m > 0 ? nlohmann::json(l.feature.diameter_m) : nlohmann::json();
  out["visible"] = !l.hidden_by.has_value();
  if (l.hidden_by) {
    out["hidden_by"] = point_json(*l.hidden_by);
    out["hidden_by"]["name"] = l.hidden_by_name.empty() ? nlohmann::json() : nlohmann::json(l.hidden_by_name);
  }
  return out;
}

std::vector<Output> landscape_files(const std::filesystem::path& folder) {
  return {{"--landscape", folder / panorama::kStellariumList, FileKind::kHorizonList},
          {"--landscape", folder / "landscape.ini", FileKind::kLandscape}};
}

void write_landscape(const std::filesystem::path& folder, const panorama::StellariumPlace& place,
                     std::span<const panorama::GroundPoint> skyline) {
  base::write_file(folder / panorama::kStellariumList, panorama::stellarium_list(skyline));
  base::write_file(folder / "landscape.ini", panorama::stellarium_ini(place, skyline));
}

}  // namespace vpe::app
