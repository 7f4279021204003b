#include "vpe/explore/results/polygon_results.h"

#include <cmath>

#include "paging/surface/query.h"
#include "vpe/base/number.h"
#include "vpe/explore/drawing/drawing_measures.h"
#include "vpe/explore/results/feature_table.h"

namespace vpe::explore {

namespace {

nlohmann::json value_json(const std::optional<double>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json volume_json(const std::optional<GroundVolume>& volume, double elevation_off_m) {
  if (!volume) return {};
  return {{"above_m3", volume->above_m3},
          {"below_m3", volume->below_m3},
          {"area_above_m2", volume->area_above_m2},
          {"area_below_m2", volume->area_below_m2},
          {"error_m3", elevation_off_m * (volume->area_above_m2 + volume->area_below_m2)}};
}

nlohmann::json plane_json(const std::optional<FittedPlane>& plane) {
  if (!plane) return {};
  return {{"elevation_m", plane->height_m},
          {"dip_deg", plane->dip_deg},
          {"dip_azimuth_deg", plane->dip_azimuth_deg},
          {"strike_deg", plane->strike_deg},
          {"dip_error_deg", value_json(plane->dip_error_deg)},
          {"strike_error_deg", value_json(plane->strike_error_deg)},
          {"residual_rms_m", plane->residual_m}};
}

// Returns a share without the sign that a part without area may have.
double without_sign(double share) { return std::abs(share); }

std::string six_digits(double value) { return base::format_significant(value, 6); }

std::string volume_line(const char* name, const std::optional<GroundVolume>& volume) {
  if (!volume) return {};
  return std::string("volume against ") + name + ": above " + measured_volume_text(volume->above_m3) +
         ", below " + measured_volume_text(volume->below_m3) + "\n";
}

std::string with_error(double value_deg, int decimals, const std::optional<double>& error_deg) {
  return base::format_fixed(value_deg, decimals) +
         (error_deg ? " +- " + base::format_fixed(*error_deg, decimals) : "") + " degrees";
}

// Returns by how much the other ground may be off its sources' posts, metres.
double other_off_m(const MeasuredPolygon& measured) {
  return measured.options.other ? measured.options.other->planet().meta().resampling.max_m : 0;
}

}  // namespace

double elevation_error_m(const GroundStatistics& ground, const paging::PlanetMeta& meta) {
  const double of_planet_m = meta.resampling.posts > 0 ? meta.resampling.max_m : meta.quantum_m;
  return ground.resampling_max_m.value_or(of_planet_m);
}

nlohmann::json polygon_json(const MeasuredPolygon& measured, const paging::PlanetMeta& meta) {
  const GroundStatistics& ground = measured.ground;
  nlohmann::json steeper = nlohmann::json::array();
  for (std::size_t n = 0; n < ground.steeper_share.size(); ++n)
    steeper.push_back(
        {{"limit_deg", measured.options.slope_limits_deg[n]}, {"share", ground.steeper_share[n]}});
  const double elevation_off_m = elevation_error_m(ground, meta);
  return {{"name", measured.polygon.name},
          {"corners", measured.polygon.vertices.size()},
          {"middle", {{"lon_deg", ground.middle.lon_deg}, {"lat_deg", ground.middle.lat_deg}}},
          {"outline_m", measured.outline_m},
          {"ground_outline_m", measured.ground_outline_m},
          {"sphere_area_m2", ground.sphere_area_m2},
          {"ground_area_m2", ground.area_m2},
          {"lowest_m", ground.lowest_m},
          {"highest_m", ground.highest_m},
          {"mean_m", ground.mean_m},
          {"slope",
           {{"mean_deg", ground.mean_slope_deg},
            {"rms_deg", ground.rms_slope_deg},
            {"median_deg", ground.median_slope_deg},
            {"percentile_90_deg", ground.slope_90_deg},
            {"steepest_deg", ground.steepest_deg},
            {"steeper", std::move(steeper)}}},
          {"plane", plane_json(ground.plane)},
          {"over_plane", volume_json(ground.over_plane, elevation_off_m)},
          {"over_rim", volume_json(ground.over_rim, elevation_off_m)},
          {"over_level", volume_json(ground.over_level, elevation_off_m)},
          {"level_m", value_json(measured.options.level_m)},
          {"over_other", volume_json(ground.over_other, elevation_off_m + other_off_m(measured))},
          {"other",
           measured.options.other ? nlohmann::json(measured.options.other->planet().path()) : nlohmann::json()},
          {"nodata_share", without_sign(ground.nodata_share)},
          {"synthetic_share",
           value_json(ground.synthetic_share ? std::optional(without_sign(*ground.synthetic_share))
                                             : std::nullopt)},
          {"is_exact", ground.is_exact},
          {"post_spacing_m", ground.spacing_m},
          {"elevation_error_m", elevation_off_m},
          {"datum", paging::describe_datum(meta)},
          {"radius_m", meta.radius_m}};
}

std::string polygon_text(const MeasuredPolygon& measured, const paging::PlanetMeta& meta) {
  const GroundStatistics& ground = measured.ground;
  std::string text;
  if (!measured.polygon.name.empty()) text += measured.polygon.name + "\n";
  text += "area " + measured_area_text(ground.sphere_area_m2) + " on the sphere, " +
          measured_area_text(ground.area_m2) + " of ground; outline " + six_digits(measured.outline_m) +
          " m, over the ground " + six_digits(measured.ground_outline_m) + " m\n";
  text += "elevation " + six_digits(ground.lowest_m) + " to " + six_digits(ground.highest_m) + " m, mean " +
          six_digits(ground.mean_m) + " m\n";
  const auto slope = [](double value_deg) { return base::format_fixed(value_deg, 2); };
  text += "slope mean " + slope(ground.mean_slope_deg) + ", RMS " + slope(ground.rms_slope_deg) + ", median " +
          slope(ground.median_slope_deg) + ", 90 % below " + slope(ground.slope_90_deg) + ", steepest " +
          slope(ground.steepest_deg) + " degrees\n";
  for (std::size_t n = 0; n < ground.steeper_share.size(); ++n)
    text += "  steeper than " + base::format_number(measured.options.slope_limits_deg[n]) +
            " degrees: " + base::format_fixed(100 * ground.steeper_share[n], 2) + " %\n";
  if (const auto& plane = ground.plane)
    text += "plane: dip " + with_error(plane->dip_deg, 2, plane->dip_error_deg) + " towards " +
            base::format_fixed(plane->dip_azimuth_deg, 1) + ", strike " +
            with_error(plane->strike_deg, 1, plane->strike_error_deg) + ", residual " +
            base::format_significant(plane->residual_m, 3) + " m RMS\n";
  text += volume_line("the plane", ground.over_plane) + volume_line("the rim", ground.over_rim);
  if (measured.options.level_m)
    text += volume_line(("a level of " + base::format_number(*measured.options.level_m) + " m").c_str(),
                        ground.over_level);
  if (measured.options.other)
    text +=
        volume_line(("the ground of " + measured.options.other->planet().path()).c_str(), ground.over_other);
  text += "from posts " + six_digits(ground.spacing_m) + " m apart" +
          (ground.is_exact ? "" : " (coarser than there are: the outline is large)") + "; datum " +
          paging::describe_datum(meta) + "; ground within " + six_digits(elevation_error_m(ground, meta)) +
          " m of its sources\n";
  const auto share = [](double value) { return base::format_fixed(100 * without_sign(value), 2) + " %"; };
  text += "nodata: " + share(ground.nodata_share) +
          "; synthetic: " + (ground.synthetic_share ? share(*ground.synthetic_share) : "not known") + "\n";
  return text;
}

mars::FeatureLayer polygon_layer(const nlohmann::json& results, std::span<const Drawing> polygons) {
  FeatureTable table("measure");
  for (std::size_t n = 0; n < polygons.size(); ++n)
    table.add("", results.at(n), {great_circle_polygon(polygons[n].vertices)});
  return table.layer();
}

std::vector<ReadOutLine> polygon_ground_lines(const GroundStatistics& ground, const paging::PlanetMeta& meta) {
  const auto share = [](double value) { return base::format_significant(100 * without_sign(value), 3) + " %"; };
  return {{"Datum", paging::describe_datum(meta)},
          {"Posts",
           measured_length_text(ground.spacing_m) + " apart" + (ground.is_exact ? "" : ", not all there are")},
          {"Error", "at most " + measured_length_text(elevation_error_m(ground, meta)) +
                        (ground.resampling_max_m ? " from its sources" : " on the planet")},
          {"Nodata", share(ground.nodata_share)},
          {"Synthetic", ground.synthetic_share ? share(*ground.synthetic_share) : "unknown"}};
}

}  // namespace vpe::explore
