#include "vpe/explore/results/path_results.h"

#include <algorithm>
#include <cmath>

#include "vpe/base/number.h"
#include "vpe/explore/results/feature_table.h"

namespace vpe::explore {

namespace {

using nlohmann::json;

json point_json(const paging::ProfilePoint& p) {
  return {{"distance_m", p.distance_m},
          {"ground_distance_m", p.ground_distance_m},
          {"lon_deg", p.place.lon_deg},
          {"lat_deg", p.place.lat_deg},
          {"elevation_m", p.nodata ? json() : json(p.height_m)},
          {"slope_deg", p.nodata ? json() : json(p.slope_deg)},
          {"steepest_slope_deg", p.nodata ? json() : json(p.cross_slope_deg)},
          {"place_given", p.waypoint}};
}

mars::LonLat place_of(const json& value, const std::string& prefix = "") {
  return {value.at(prefix + "lon_deg").get<double>(), value.at(prefix + "lat_deg").get<double>()};
}

}  // namespace

int steepness(const paging::ProfilePoint& point, std::span<const double> limits_deg) {
  if (point.nodata) return 0;
  return static_cast<int>(
      std::ranges::count_if(limits_deg, [&](double limit) { return point.cross_slope_deg > limit; }));
}

json profile_json(const Profile& profile, const GroundAlong& ground, const paging::PlanetMeta& meta,
                  std::span<const double> limits_deg) {
  json points = json::array();
  for (const paging::ProfilePoint& p : profile.points) {
    points.push_back(point_json(p));
    if (limits_deg.empty()) continue;
    const int count = steepness(p, limits_deg);
    points.back()["steeper_than_deg"] =
        count == 0 ? json() : json(limits_deg[static_cast<std::size_t>(count) - 1]);
  }
  json all = ground_json(ground, meta);
  all.update({{"length_m", profile.length_m},
              {"ground_length_m", profile.ground_length_m},
              {"lowest_m", profile.lowest_m},
              {"highest_m", profile.highest_m},
              {"step_m", profile.step_m},
              {"points", std::move(points)}});
  return all;
}

mars::FeatureLayer profile_layer(const json& profile, std::span<const mars::LonLat> places) {
  FeatureTable table("profile");
  json path = profile;
  path.erase("points");
  table.add("path", path, {great_circle_line(places)});
  for (const json& point : profile.at("points")) table.add("point", point, {point_shape(place_of(point))});
  return table.layer();
}

json sight_json(const LineOfSight& sight, const SightPoint& from, const SightPoint& to,
                const GroundAlong& ground, const paging::PlanetMeta& meta) {
  const auto end = [](const SightPoint& p) {
    return json{{"lon_deg", p.place.lon_deg}, {"lat_deg", p.place.lat_deg}, {"height_m", p.height_m}};
  };
  json obstacle;
  if (sight.obstruction) {
    obstacle = {{"lon_deg", sight.obstruction->place.lon_deg},
                {"lat_deg", sight.obstruction->place.lat_deg},
                {"distance_m", sight.obstruction->distance_m},
                {"elevation_m", sight.obstruction->elevation_m}};
    if (!sight.obstruction->object.empty()) obstacle["object"] = sight.obstruction->object;
  }
  json all = ground_json(ground, meta);
  all.update(
      {{"from", end(from)},
       {"to", end(to)},
       {"visible", sight.visible},
       {"distance_m", sight.distance_m},
       {"arc_m", sight.arc_m},
       {"clearance_m", sight.clearance_m},
       {"clearance_error_m", sight.clearance_error_m},
       {"clearance_lon_deg", sight.clearance_place.lon_deg},
       {"clearance_lat_deg", sight.clearance_place.lat_deg},
       {"clearance_distance_m", sight.clearance_distance_m},
       {"obstacle", std::move(obstacle)},
       {"needed_height_m", std::isfinite(sight.needed_height_m) ? json(sight.needed_height_m) : json()}});
  return all;
}

mars::FeatureLayer sight_layer(const json& sight) {
  const json& from = sight.at("from");
  const json& to = sight.at("to");
  const std::vector<mars::LonLat> ends{place_of(from), place_of(to)};
  FeatureTable table("sight");
  table.add("line", sight, {great_circle_line(ends)});
  table.add("from", from, {point_shape(ends[0])});
  table.add("to", to, {point_shape(ends[1])});
  const mars::LonLat nearest = place_of(sight, "clearance_");
  table.add("clearance",
            {{"lon_deg", nearest.lon_deg},
             {"lat_deg", nearest.lat_deg},
             {"distance_m", sight.at("clearance_distance_m")},
             {"clearance_m", sight.at("clearance_m")}},
            {point_shape(nearest)});
  if (const json& obstacle = sight.at("obstacle"); obstacle.is_object())
    table.add("obstacle", obstacle, {point_shape(place_of(obstacle))});
  return table.layer();
}

mars::FeatureFileInfo result_info(const std::string& command, const paging::PlanetMeta& meta) {
  mars::FeatureFileInfo info;
  info.radius_m = meta.radius_m;
  info.body = meta.body;
  info.description =
      "vpe " + command + ". Elevations count from " + paging::describe_datum(meta) +
      ". Lengths and areas are on the sphere of " + base::format_number(meta.radius_m) +
      " m unless they are said to be of the ground. Attributes have the names of the JSON that the command "
      "prints: among them the spacing of posts, the error against the sources, and the shares of nodata and of "
      "synthetic ground.";
  return info;
}

std::string text_of_lines(std::span<const ReadOutLine> lines) {
  std::string text;
  for (const ReadOutLine& line : lines)
    text += (line.label.empty() ? "" : line.label + ": ") + line.text + "\n";
  return text;
}

}  // namespace vpe::explore
