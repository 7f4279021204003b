#include "vpe/app/panorama/panorama_overlays.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "paging/planet/planet_look.h"
#include "paging/surface/place_cursor.h"
#include "paging/surface/surface.h"
#include "panorama/eye_projection.h"
#include "panorama/horizon/landmarks.h"
#include "vpe/app/cli/digest.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/panorama/horizon_objects.h"
#include "vpe/app/scene/scene_library.h"
#include "vpe/core/appearance/layer_list.h"
#include "vpe/overlay/features/area_colours.h"
#include "vpe/overlay/layer_files.h"
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

// Shows the ground to one eye.
class PanoramaSight : public overlay::GroundSight {
 public:
  PanoramaSight(const Frame& frame, const panorama::EyeProjection& projection, const paging::Surface& surface,
                const panorama::Viewpoint& viewpoint, std::shared_ptr<const objects::Scene> objects)
      : GroundSight(frame),
        projection_(projection),
        surface_(surface),
        cursor_(surface),
        viewpoint_(viewpoint),
        objects_(std::move(objects)) {}

  double height_m(const glm::dvec3& direction) const override {
    if (frame().exaggeration == 1) return cursor_.move_to(direction).height_m;
    return (surface_.at(direction, frame().exaggeration).radius_m - frame().radius_m) / frame().exaggeration;
  }
  std::optional<glm::dvec2> to_image(const glm::dvec3& point_m) const override {
    const auto seen = projection_.project(point_m);
    return seen ? std::optional(seen->at_px) : std::nullopt;
  }
  bool is_hidden(glm::dvec2, const glm::dvec3& point_m, double) const override {
    const auto seen = projection_.project(point_m);
    if (!seen) return true;
    const glm::dvec3 along = point_m - seen->seen_from_m;
    const double least_m = glm::length(along) * (1 - overlay::kHiddenLineShare);
    const glm::dvec3 ray = glm::normalize(along);
    if (surface_.cast(seen->seen_from_m, ray, frame().exaggeration, {0, least_m}) < least_m) return true;
    if (!objects_) return false;
    panorama::Viewpoint eye = viewpoint_;
    eye.position_m = seen->seen_from_m;
    return HorizonObjects{objects_, eye}.range_m(ray, least_m) < least_m;
  }
  bool may_show(const glm::dvec3& centre_m, double radius_m) const override {
    return projection_.may_show(centre_m, radius_m, overlay::kLineMargin_px);
  }

 private:
  panorama::EyeProjection projection_;
  const paging::Surface& surface_;
  mutable paging::PlaceCursor cursor_;
  panorama::Viewpoint viewpoint_;
  std::shared_ptr<const objects::Scene> objects_;
};

// Returns the checksum of vector files, with the other files of Shapefiles.
std::string layers_checksum(const std::vector<core::LayerFile>& files) {
  Digest digest;
  for (const core::LayerFile& file : files) {
    const std::filesystem::path path = file.path;
    digest.add(checksum_of(path));
    if (path.extension() != ".shp" && path.extension() != ".SHP") continue;
    for (const char* extension : {".shx", ".dbf", ".prj", ".cpg"}) {
      const std::filesystem::path beside = std::filesystem::path(path).replace_extension(extension);
      if (std::filesystem::exists(beside)) digest.add(extension).add(checksum_of(beside));
    }
  }
  return digest.hex();
}

void resolve_layers(PanoramaRequest& request) {
  if (request.settings.values().layers.empty()) return;
  std::vector<core::LayerFile> files = core::parse_layer_list(request.settings.values().layers);
  for (core::LayerFile& file : files)
    file.path = std::filesystem::absolute(file.path).lexically_normal().string();
  const std::string list = core::layer_list_text(files);
  if (const std::string trouble = request.settings.set("overlay.layers", list); !trouble.empty())
    throw UsageError("--set overlay.layers: " + trouble);
  const std::string checksum = layers_checksum(files);
  if (!request.layers_checksum.empty() && request.layers_checksum != checksum) {
    throw std::runtime_error(
        "a file of overlay.layers=" + list +
        " has changed since the image was made, so its features differ; restore the old files, or "
        "make a new image with --set overlay.layers=" +
        list);
  }
  request.layers_checksum = checksum;
}

}  // namespace

void resolve_overlays(PanoramaRequest& request) {
  const core::SettingsValues& values = request.settings.values();
  if (const std::string reason = overlay::not_for_panoramas(values); !reason.empty())
    throw UsageError("--set " + reason + "; leave it out");
  resolve_layers(request);
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
  load_layers();
}

void PanoramaOverlays::load_layers() {
  const core::SettingsValues& values = request_.settings.values();
  std::size_t number = 0;
  for (const core::LayerFile& file : core::parse_layer_list(values.layers)) {
    for (auto& features : overlay::read_layer_file(file.path, planet_->radius_m(), number))
      layers_.push_back({std::move(features), file.opacity});
    ++number;
  }
  if (layers_.empty()) return;
  surface_ = std::make_unique<paging::Surface>(planet_, memory_bytes_ / 8);
  if (!values.scene.empty())
    objects_ = SceneLibrary(*surface_).scene(values.scene, values.exaggeration, 0).scene;
}

bool PanoramaOverlays::has_areas() const {
  return std::ranges::any_of(layers_, [](const auto& layer) { return !layer.features->areas().empty(); });
}

std::size_t PanoramaOverlays::held_bytes() const {
  if (layers_.empty()) return 0;
  std::size_t total = memory_bytes_ / 8 + memory_bytes_ / 4;
  for (const overlay::SceneLayer& layer : layers_) total += layer.features->bytes();
  return total;
}

double PanoramaOverlays::unit() const {
  overlay::PanoramaScene scene;
  scene.width_px = map_.width_px;
  scene.height_px = map_.height_px;
  scene.full_circle_px = std::llround(map_.turn_px);
  return overlay::panorama_unit(scene);
}

overlay::PanoramaLines& PanoramaOverlays::lines(std::optional<panorama::Eye> eye) {
  auto& lines = lines_[!eye ? 2 : *eye == panorama::Eye::kRight ? 1 : 0];
  if (lines) return *lines;
  const core::SettingsValues& values = request_.settings.values();
  const panorama::Viewpoint viewpoint = panorama::viewpoint_of(request_.camera, planet_->radius_m());
  const panorama::EyeProjection projection =
      eye ? panorama::EyeProjection(map_, viewpoint, *eye, request_.stereo.value().base_m)
          : panorama::EyeProjection(map_, viewpoint);
  overlay::GroundSight::Frame frame;
  frame.camera_m = viewpoint.position_m;
  frame.radius_m = planet_->radius_m();
  frame.exaggeration = values.exaggeration;
  frame.size_px = glm::dvec2(static_cast<double>(map_.width_px), static_cast<double>(map_.height_px));
  frame.turn_px = map_.turn_px;
  frame.scale = {unit(), map_.focal_px};
  const auto make_sight = [this, frame, projection, viewpoint]() -> std::unique_ptr<overlay::GroundSight> {
    return std::make_unique<PanoramaSight>(frame, projection, *surface_, viewpoint, objects_);
  };
  lines = std::make_unique<overlay::PanoramaLines>(layers_, make_sight, values.hidden_lines, pool_,
                                                   memory_bytes_ / (request_.stereo ? 8 : 4));
  return *lines;
}

void PanoramaOverlays::fill(const core::View& view, const overlay::PixelBlock& block) {
  if (!has_areas()) return;
  const double exaggeration = request_.settings.values().exaggeration;
  const overlay::GroundAnswers ground{
      [&](const glm::dvec3& point_m) { return surface_->at(point_m, exaggeration).normal; },
      [&](const glm::dvec3& from_m, const glm::dvec3& ray) {
        return surface_->cast(from_m, ray, exaggeration);
      }};
  overlay::fill_pixels(layers_, view, {unit(), map_.focal_px}, ground, pool_, block);
}

void PanoramaOverlays::drape(std::optional<panorama::Eye> eye, const overlay::ImageRegion& region) {
  if (!layers_.empty()) lines(eye).composite(region);
}

// Marks the areas that some rays meet, at most half a thousand across the image.
void PanoramaOverlays::mark_areas(std::vector<overlay::LayerUse>& uses) const {
  constexpr std::int64_t kRaysAcross = 512;
  const std::int64_t step = std::max<std::int64_t>(1, map_.width_px / kRaysAcross);
  const std::int64_t rows = (map_.height_px + step - 1) / step;
  const panorama::Viewpoint viewpoint = panorama::viewpoint_of(request_.camera, planet_->radius_m());
  const double exaggeration = request_.settings.values().exaggeration;
  std::mutex merging;
  pool_.run(static_cast<std::size_t>(rows), [&](std::size_t row) {
    std::vector<overlay::LayerUse> own;
    std::vector<overlay::AreaColours> colours;
    for (const overlay::SceneLayer& layer : layers_) {
      own.emplace_back(*layer.features);
      colours.emplace_back(*layer.features, layer.opacity, overlay::FeatureScale{unit(), map_.focal_px});
    }
    std::vector<std::uint32_t> found;
    const double y = (static_cast<double>(row) + 0.5) * static_cast<double>(step);
    for (std::int64_t column = 0; column < map_.width_px; column += step) {
      const glm::dvec3 ray = panorama::ray_of(
          viewpoint, map_.to_direction(static_cast<double>(column) + 0.5 * static_cast<double>(step), y));
      const double range_m = surface_->cast(viewpoint.position_m, ray, exaggeration);
      if (!std::isfinite(range_m)) continue;
      const mars::LonLat at = mars::lon_lat(viewpoint.position_m + ray * range_m);
      for (std::size_t k = 0; k < layers_.size(); ++k) {
        colours[k].find({at.lon_deg, at.lat_deg}, 0, found);
        if (!found.empty()) (void)colours[k].at(found, {at.lon_deg, at.lat_deg}, range_m, &own[k]);
      }
    }
    const std::scoped_lock lock(merging);
    for (std::size_t k = 0; k < layers_.size(); ++k)
      for (std::size_t n = 0; n < own[k].areas.size(); ++n) uses[k].areas[n] |= own[k].areas[n];
  });
}

void PanoramaOverlays::add_layers(overlay::PanoramaScene& scene) {
  const core::SettingsValues& values = request_.settings.values();
  const bool has_labels =
      std::ranges::any_of(layers_, [](const auto& layer) { return layer.features->has_labels(); });
  if (layers_.empty() || (!has_labels && !values.layers_legend)) return;
  overlay::PanoramaLines& middle = lines(std::nullopt);
  if (values.layers_legend) {
    std::vector<overlay::LayerUse> uses = middle.use();
    if (has_areas()) mark_areas(uses);
    scene.layers_legend = overlay::legend_rows(layers_, uses);
  }
  // The uppermost layer has the first choice of room.
  for (std::size_t k = layers_.size(); k-- > 0 && has_labels;) {
    const overlay::GroundFeatures& features = *layers_[k].features;
    if (!features.has_labels()) continue;
    const overlay::FeaturePainter painter{{unit(), map_.focal_px}, layers_[k].opacity, values.hidden_lines};
    for (const overlay::LabelAnchor& anchor : middle.anchors()[k]) {
      const std::string text = features.label(anchor.feature);
      if (text.empty()) continue;
      const mars::FeatureStyle& style = features.style(anchor.feature);
      scene.labels.push_back({text, anchor.at_px, anchor.radius_px, painter.font(style, anchor.distance_m),
                              overlay::ink_of(style.label_colour, painter.opacity)});
    }
  }
  if (request_.stereo) lines_[2].reset();
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
  add_layers(scene);
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
