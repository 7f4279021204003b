#include "vpe/app/picture/frame_overlays.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "paging/planet/planet_look.h"
#include "paging/surface/height_cursor.h"
#include "paging/surface/query.h"
#include "vpe/app/picture/contour_ranges.h"
#include "vpe/app/picture/sun_statement.h"
#include "vpe/core/appearance/layer_list.h"

namespace vpe::app {
namespace {

// Largest shift of an image's places by their heights' errors, and the largest change of their distances, of which lines are hidden
// by twice as much (overlay::kHiddenLineShare).
constexpr double kDrapedShift_px = 0.05;
constexpr double kDrapedDistanceShare = 2.5e-4;

// Computes how far heights may be off, direction by direction, without being seen in an image.
class HeightErrors {
 public:
  HeightErrors(const core::View& view, const paging::PlanetFile& planet, double exaggeration)
      : camera_m_(view.camera.position_m), radius_m_(planet.radius_m()), exaggeration_(exaggeration) {
    for (const lod::TileInfo& tile : planet.tree().tiles().first(6))
      relief_m_ = std::max({relief_m_, exaggeration * tile.max_height_m, -exaggeration * tile.min_height_m});
    // The pixels of a radian, at a perspective image's corners, or of a round one's columns.
    const double focal_px = core::focal_px(view);
    px_per_rad_ = std::max(focal_px, view.width / (2 * mars::kPi));
    if (view.projection == core::Projection::kPerspective) {
      const double x_px = 0.5 * view.width + std::abs(view.principal_offset_px.x);
      const double y_px = 0.5 * view.height + std::abs(view.principal_offset_px.y);
      px_per_rad_ = focal_px * (1 + (x_px * x_px + y_px * y_px) / (focal_px * focal_px));
    }
  }

  double most_error_m(const glm::dvec3& direction) const {
    // No point in the direction is nearer than the line through it, and no ground than the planet's relief allows.
    const double aside_m = glm::length(glm::cross(camera_m_, direction));
    const double nearest_m = std::max(aside_m, glm::length(direction * radius_m_ - camera_m_) - relief_m_);
    // The triangle of the camera and two heights has the area height * aside / 2, and two sides of at least the nearest distance.
    const double by_shift_m =
        kDrapedShift_px * nearest_m * nearest_m / (px_per_rad_ * std::max(aside_m, 1e-3 * nearest_m));
    return std::min(by_shift_m, kDrapedDistanceShare * nearest_m) / exaggeration_;
  }

 private:
  glm::dvec3 camera_m_;
  double radius_m_;
  double exaggeration_;
  double relief_m_ = 0;
  double px_per_rad_ = 1;
};

}  // namespace

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
  paging::HeightCursor cursor(surface_);
  const HeightErrors errors(request.view, *planet_, scene.appearance.exaggeration);
  scene.ground_m = [&cursor, &errors](const glm::dvec3& direction) {
    return cursor.height_m(direction, errors.most_error_m(direction));
  };
  if (settings.time_code == core::TimeCode::kSolar) {
    const auto sun = sun_statement(settings, mars::lon_lat(request.view.camera.position_m));
    if (sun) scene.solar = {sun->true_solar_time_h, sun->solar_longitude_deg};
  }
  if (settings.inspect == core::Inspect::kSynthetic)
    scene.is_synthetic = [this](const glm::dvec3& place) { return paging::is_synthetic(surface_, place); };
  return overlay::draw(settings, scene);
}

}  // namespace vpe::app
