#include "vpe/explore/measure/profile.h"

#include <algorithm>

#include "lod/tree/posts.h"
#include "vpe/base/number.h"

namespace vpe::explore {

double profile_step_m(const paging::PlanetMeta& meta, std::span<const mars::LonLat> places,
                      double most_points) {
  double length_m = 0;
  for (std::size_t n = 1; n < places.size(); ++n) {
    length_m += mars::distance_rad(places[n - 1], places[n]) * meta.radius_m;
  }
  const double finest_m = lod::post_spacing_m(meta.finest_level, meta.tile.intervals(), meta.radius_m);
  return std::max(length_m / most_points, finest_m);
}

Profile make_profile(const paging::Surface& surface, std::span<const mars::LonLat> places,
                     const ProfileOptions& options) {
  Profile profile;
  profile.step_m = options.step_m > 0 ? options.step_m
                                      : profile_step_m(surface.planet().meta(), places, options.most_points);
  profile.points = paging::profile(surface, places, profile.step_m);
  profile.length_m = profile.points.back().distance_m;
  profile.ground_length_m = profile.points.back().ground_distance_m;
  profile.lowest_m = profile.points.front().lowest_m;
  profile.highest_m = profile.points.front().highest_m;
  for (const paging::ProfilePoint& p : profile.points) {
    profile.lowest_m = std::min(profile.lowest_m, p.lowest_m);
    profile.highest_m = std::max(profile.highest_m, p.highest_m);
    profile.has_nodata = profile.has_nodata || p.nodata;
  }
  return profile;
}

std::string profile_csv_header() {
  return "distance_m,ground_distance_m,lon_deg,lat_deg,elevation_m,slope_deg,steepest_slope_deg,place_given\n";
}

std::string profile_csv_line(const paging::ProfilePoint& p) {
  std::string line = base::format_display(p.distance_m, 3) + "," +
                     base::format_display(p.ground_distance_m, 3) + "," + base::format_number(p.place.lon_deg) +
                     "," + base::format_number(p.place.lat_deg) + ",";
  if (!p.nodata) line += base::format_display(p.height_m, 3);
  line += ",";
  if (!p.nodata) line += base::format_display(p.slope_deg, 3);
  line += ",";
  if (!p.nodata) line += base::format_display(p.cross_slope_deg, 3);
  return line + (p.waypoint ? ",1\n" : ",0\n");
}

std::string to_csv(const Profile& profile) {
  std::string text = profile_csv_header();
  for (const paging::ProfilePoint& p : profile.points) text += profile_csv_line(p);
  return text;
}

}  // namespace vpe::explore
