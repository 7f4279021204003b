#include "vpe/app/picture/explain_lod.h"

#include <nlohmann/json.hpp>

#include "lod/explain.h"
#include "lod/options.h"
#include "mars/geodesy/sphere.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/voxel/foveated_image.h"

namespace vpe::app {

namespace {

nlohmann::json term_json(const char* x_name, const lod::ControlTerm& term) {
  nlohmann::json object{{"levels", term.levels}, {"weight", term.weight}, {"weighted", term.weighted()}};
  if (x_name != nullptr) object[x_name] = term.x;
  return object;
}

nlohmann::json tile_json(const lod::TileExplanation& e, bool by_distance) {
  nlohmann::json object{{"tile", lod::to_string(e.key)},
                        {"lod", e.key.level},
                        {"post_spacing_m", e.post_spacing_m},
                        {"min_distance_m", e.min_distance_m},
                        {"angle_from_centre_deg", e.terms.centre_angle_rad / mars::kRadiansPerDegree},
                        {"error_m", e.geometric_error_m},
                        {"error_px", e.screen_space_error_px},
                        {"centre", term_json("half_heights", e.terms.centre)},
                        {"interest", term_json(nullptr, e.terms.interest)},
                        {"sum", e.terms.sum},
                        {"reason", lod::to_string(e.reason)}};
  if (by_distance) {
    object["distance"] = term_json("m", e.terms.distance);
    object["wanted_lod"] = e.wanted_level;
  } else {
    object["shift_levels"] = e.shift;
  }
  return object;
}

}  // namespace

nlohmann::json explain_lod(const core::DrawRequest& request, const paging::PlanetFile& planet,
                           std::size_t memory_bytes) {
  const lod::SelectOptions options =
      lod::select_options(request, planet.radius_m(), gl::most_triangles(memory_bytes));
  const lod::SelectView view = lod::select_view(request.view);
  lod::SelectScratch scratch;
  lod::Selection selection;
  lod::select(options, planet.tree(), view, scratch, selection);
  const bool by_distance = options.control.metric == core::LodMetric::kDistance;
  nlohmann::json tiles = nlohmann::json::array();
  for (const lod::TileExplanation& e : lod::explain(options, planet.tree(), view, selection)) {
    nlohmann::json& tile = tiles.emplace_back(tile_json(e, by_distance));
    tile["mesh"] = e.variant + 1;
    tile["meshes"] = e.variants;
  }
  nlohmann::json object{{"rule", by_distance ? "distance" : "error"},
                        {"max_triangles", options.max_triangles},
                        {"triangles", selection.triangles},
                        {"budget_spent", selection.capped},
                        {"tiles", tiles}};
  if (!by_distance) object["tolerance_px"] = options.tolerance_px;
  return object;
}

nlohmann::json explain_lod(const core::DrawRequest& request, std::span<const lod::TileExplanation> cast) {
  const bool by_distance = request.settings.lod_metric == core::LodMetric::kDistance;
  nlohmann::json tiles = nlohmann::json::array();
  for (const lod::TileExplanation& e : cast) tiles.push_back(tile_json(e, by_distance));
  // The key also tells what the file is (vpe/app/cli/file_kind.cpp).
  nlohmann::json object{
      {"rule", by_distance ? "distance" : "error"}, {"budget_spent", false}, {"tiles", tiles}};
  if (by_distance) return object;
  object["tolerance_px"] = request.settings.ray_cell_px;
  if (request.settings.ray_fovea)
    object["thinned_tolerance_px"] = voxel::kThinned * request.settings.ray_cell_px;
  return object;
}

}  // namespace vpe::app
