#include "lod/options.h"

#include <algorithm>

namespace lod {

namespace core = vpe::core;

DegradeWeights degrade_weights(const core::SettingsValues& settings) {
  return {settings.degrade_distance, settings.degrade_centre, settings.degrade_interest};
}

LevelControl level_control(const core::DrawRequest& request, double planet_radius_m) {
  const core::SettingsValues& s = request.settings;
  LevelControl control;
  control.metric = s.lod_metric;
  control.distance = {s.lod_distance_scale_m, s.lod_distance_offset, s.lod_distance_weight,
                      s.lod_distance_table, request.coarsening};
  control.centre = {s.lod_centre_scale, s.lod_centre_offset, s.lod_centre_weight, s.lod_centre_table, 1.0};
  control.interest_weight = s.lod_interest_weight;
  control.degrade = degrade_weights(s);
  control.coarsening = request.coarsening;
  for (const core::InterestRegion& region : request.interest) {
    control.regions.push_back(control_region(region, planet_radius_m));
  }
  return control;
}

SelectOptions select_options(const core::DrawRequest& request, double planet_radius_m,
                             std::int64_t most_triangles) {
  const core::SettingsValues& s = request.settings;
  SelectOptions options;
  options.tolerance_px = s.lod_tolerance_px * request.coarsening;
  if (request.keeps_levels) options.child_tolerance_px = s.lod_tolerance_px;
  options.exaggeration = s.exaggeration;
  options.max_triangles =
      s.lod_triangles > 0 ? std::min<std::int64_t>(s.lod_triangles, most_triangles) : most_triangles;
  options.control = level_control(request, planet_radius_m);
  return options;
}

}  // namespace lod
