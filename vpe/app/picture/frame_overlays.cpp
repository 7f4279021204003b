#include "vpe/app/picture/frame_overlays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "paging/planet/planet_look.h"
#include "paging/surface/place_cursor.h"
#include "paging/surface/query.h"
#include "vpe/app/picture/contour_ranges.h"
#include "vpe/app/picture/sun_statement.h"
#include "vpe/core/appearance/layer_list.h"

namespace vpe::app {
FrameOverlays::FrameOverlays(std::shared_ptr<const paging::PlanetFile> planet)
    : planet_(std::move(planet)),
      surface_(planet_, std::size_t{16} << 20),
      has_imagery_(planet_->meta().finest_image_level >= 0) {}

void FrameOverlays::change_planet(std::shared_ptr<const paging::PlanetFile> planet) {
  if (planet == planet_) return;
  surface_.change_planet(planet);
  planet_ = std::move(planet);
  for (auto& [file, names] : names_)
    std::ranges::fill(names.height_m, std::numeric_limits<double>::quiet_NaN());
}

void FrameOverlays::load(const core::Overlays& overlays) {
  for (const core::LayerFile& file : core::parse_layer_list(overlays.layers)) {
    if (layers_.contains(file.path)) continue;
    layers_.emplace(file.path, overlay::read_layer_file(file.path, planet_->radius_m(), layers_.size()));
  }
  if (overlays.names.empty() || names_.contains(overlays.names)) return;
  Names names;
  names.places = core::read_gazetteer(overlays.names);
  names.height_m.assign(names.places.size(), std::numeric_limits<double>::quiet_NaN());
  names_.emplace(overlays.names, std::move(names));
}

void FrameOverlays::add_layers(const core::Overlays& overlays, overlay::Scene& scene) const {
  for (const core::LayerFile& file : core::parse_layer_list(overlays.layers)) {
    for (const auto& features : layers_.at(file.path)) scene.layers.push_back({features, file.opacity});
  }
}

overlay::Layer FrameOverlays::layer(const core::DrawRequest& request, const FrameGround& ground,
                                    double time_s) {
  const core::SettingsValues& settings = request.settings;
  if (!overlay::any(settings)) return {};
  load(settings);
  overlay::Scene scene;
  scene.view = request.view;
  scene.range_m = ground.range_m;
  scene.radius_m = planet_->radius_m();
  scene.appearance = settings;
  paging::fit_to_planet(scene.appearance, planet_->meta());
  scene.shift_px = shift_px(ground.certificate);
  if (ground.contours) {
    scene.contours = {ground.contours->frame.range_m, shift_px(ground.contours->certificate)};
  }
  scene.has_imagery = has_imagery_;
  scene.time_s = time_s;
  if (!settings.names.empty()) {
    Names& names = names_.at(settings.names);
    scene.places = names.places;
    scene.height_m = [this, &names](const core::Place& place) {
      double& height_m = names.height_m.at(static_cast<std::size_t>(&place - names.places.data()));
      if (std::isnan(height_m)) {
        height_m = surface_.at(mars::direction({place.lon_deg, place.lat_deg})).height_m;
      }
      return height_m;
    };
  }
  add_layers(settings, scene);
  paging::PlaceCursor cursor(surface_);
  scene.ground_m = [&cursor](const glm::dvec3& direction) { return cursor.move_to(direction).height_m; };
  if (settings.time_code == core::TimeCode::kSolar) {
    const auto sun = sun_statement(settings, mars::lon_lat(request.view.camera.position_m));
    if (sun) scene.solar = {sun->true_solar_time_h, sun->solar_longitude_deg};
  }
  if (settings.inspect == core::Inspect::kSynthetic)
    scene.is_synthetic = [this](const glm::dvec3& place) { return paging::is_synthetic(surface_, place); };
  return overlay::draw(settings, scene);
}

}  // namespace vpe::app
