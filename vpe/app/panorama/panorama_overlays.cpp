#include "vpe/app/panorama/panorama_overlays.h"

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "paging/planet/planet_look.h"
#include "paging/surface/surface.h"
#include "panorama/horizon/landmarks.h"
#include "vpe/app/cli/digest.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/panorama/horizon_objects.h"
#include "vpe/app/scene/scene_library.h"
#include "vpe/overlay/overlay.h"
#include "vpe/overlay/panorama_overlay.h"

namespace vpe::app {

namespace {

// Returns the places of which the camera sees the centre, or another point.
std::vector<overlay::PanoramaName> visible_names(const PanoramaRequest& request,
                                                 const std::vector<core::Place>& places,
                                                 const std::shared_ptr<const paging::PlanetFile>& planet,
                                                 std::size_t memory_bytes, base::ThreadPool& pool) {
  const paging::Surface surface(planet, memory_bytes);
  const double exaggeration = request.settings.values().exaggeration;
  const double radius_m = planet->radius_m();
  const mars::Pose& pose = request.camera;
  const panorama::Viewpoint camera = panorama::viewpoint_at({pose.lon_deg, pose.lat_deg}, pose.alt_m, radius_m);
  const double highest_m = radius_m + exaggeration * (planet->meta().highest_radius_m - radius_m);
  const double within_m = panorama::farthest_sight_m(radius_m + pose.alt_m,
                                                     planet->tree().lowest_radius_m(exaggeration), highest_m);
  std::optional<HorizonObjects> things;
  if (const std::string& file = request.settings.values().scene; !file.empty())
    things = HorizonObjects{SceneLibrary(surface).scene(file, exaggeration, 0).scene, camera};
  const auto range_m = [&](const glm::dvec3& ray) {
    const double ground_m = surface.cast(camera.position_m, ray, exaggeration);
    return things ? things->range_m(ray, ground_m) : ground_m;
  };
  const auto landmarks = panorama::landmarks(
      camera, places, within_m, [&](const glm::dvec3& up) { return surface.at(up, exaggeration).radius_m; },
      range_m, pool, panorama::Extent::kPoints);
  std::vector<overlay::PanoramaName> names;
  for (const panorama::Landmark& l : landmarks) {
    if (l.hidden_by && !l.seen_at) continue;
    const panorama::GroundPoint& at = l.seen_at ? *l.seen_at : l.centre;
    names.push_back({l.feature.name, at.direction.azimuth_deg, at.direction.elevation_deg, at.range_m,
                     l.feature.diameter_m});
  }
  return names;
}

}  // namespace

void resolve_overlays(PanoramaRequest& request) {
  const core::SettingsValues& values = request.settings.values();
  if (const std::string reason = overlay::not_for_panoramas(values); !reason.empty())
    throw UsageError("--set " + reason + "; leave it out");
  if (values.names.empty()) return;
  const std::string file = std::filesystem::absolute(values.names).lexically_normal().string();
  if (const std::string trouble = request.settings.set("overlay.names", file); !trouble.empty())
    throw UsageError("--set overlay.names: " + trouble);
  (void)core::read_gazetteer(file);  // throws now if it cannot be used
  const std::string checksum = checksum_of(std::filesystem::path(file));
  if (!request.names_checksum.empty() && request.names_checksum != checksum) {
    throw std::runtime_error(
        file +
        " has changed since the image was made, so its names differ; restore the old file, "
        "or make a new image with --set overlay.names=" +
        file);
  }
  request.names_checksum = checksum;
}

PanoramaOverlays::PanoramaOverlays(const PanoramaRequest& request, const panorama::PanoramaMap& map,
                                   std::shared_ptr<const paging::PlanetFile> planet, base::ThreadPool& pool,
                                   std::size_t memory_bytes)
    : request_(request), map_(map), planet_(std::move(planet)), pool_(pool), memory_bytes_(memory_bytes) {
  const std::string& file = request.settings.values().names;
  if (!file.empty()) places_ = core::read_gazetteer(file);
}

overlay::SpriteLayer PanoramaOverlays::lay_out() {
  const core::SettingsValues& values = request_.settings.values();
  overlay::PanoramaScene scene;
  scene.width_px = map_.width_px;
  scene.height_px = map_.height_px;
  scene.full_circle_px = std::llround(map_.turn_px);
  scene.left_azimuth_deg = map_.to_direction(0, map_.horizon_px).azimuth_deg;
  const double right_deg = map_.to_direction(static_cast<double>(map_.width_px), map_.horizon_px).azimuth_deg;
  const double span_deg = right_deg - scene.left_azimuth_deg;
  scene.span_deg = span_deg > 0 ? span_deg : span_deg + 360;
  if (map_.width_px == scene.full_circle_px) scene.span_deg = 360;
  // A facet has the fewest pixels a degree in its middle.
  scene.px_per_deg =
      map_.kind == panorama::MapKind::kFacets ? map_.focal_px * mars::kRadiansPerDegree : map_.turn_px / 360.0;
  scene.horizon_px = map_.horizon_px;
  scene.place = [this](double azimuth_deg, double elevation_deg) -> std::optional<glm::dvec2> {
    glm::dvec2 at = map_.place({azimuth_deg, elevation_deg});
    // The image's own edges belong to it.
    constexpr double kEdge_px = 1e-6;
    if (at.x < -kEdge_px) at.x += map_.turn_px;
    if (at.x > map_.turn_px - kEdge_px) at.x -= map_.turn_px;
    if (at.x > static_cast<double>(map_.width_px) + kEdge_px) return std::nullopt;
    return at;
  };
  scene.appearance = values;
  paging::fit_to_planet(scene.appearance, planet_->meta());
  scene.has_imagery = !planet_->image_keys().empty();
  if (!places_.empty()) names_ = visible_names(request_, places_, planet_, memory_bytes_, pool_);
  scene.names = names_;
  return overlay::lay_out_panorama(values, scene);
}

void PanoramaOverlays::prepare() {
  if (!sprites_ && overlay::any(request_.settings.values())) sprites_ = lay_out();
}

void PanoramaOverlays::lay(const overlay::ImageRegion& region) {
  prepare();
  if (sprites_) sprites_->composite(region);
}

}  // namespace vpe::app
