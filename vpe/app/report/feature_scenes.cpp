#include "vpe/app/report/feature_scenes.h"

#include <algorithm>
#include <array>

#include "mars/geodesy/sun.h"
#include "vpe/app/picture/contour_ranges.h"
#include "vpe/app/picture/stereo_render.h"
#include "vpe/overlay/overlay.h"

namespace vpe::app {
namespace {

const std::vector<std::string> kBare{"mode=unlit", "colour=none",        "background=black",
                                     "edges=hard", "cull.occlusion=off", "shadows=off"};

}  // namespace

std::span<const FeatureScene> feature_scenes() {
  static const std::array<FeatureScene, 12> kScenes{{
      {"bare", "", {}},
      {"imagery at posts", "bare", {"colour=image"}, false, false, false, true, true},
      {"pseudo-colour", "bare", {"colour=elevation"}},
      {"light of facets", "bare", {"mode=lit", "shading=flat"}},
      {"light and normals of posts", "bare", {"mode=lit"}},
      {"imagery", "light and normals of posts", {"mode=textured"}, false, false, false, true, true},
      {"shadows", "light and normals of posts", {"mode=lit", "shadows=on"}},
      {"overlays",
       "planes",
       {"overlay.graticule=on", "overlay.scale=on", "overlay.title=Valles Marineris"},
       true},
      {"occlusion culling", "bare", {"cull.occlusion=on"}, false, false, false, false},
      {"planes", "bare", {}, true},
      {"statistics", "bare", {}, false, true},
      {"stereo", "bare", {}, false, false, true},
  }};
  return kScenes;
}

const FeatureScene* find_scene(const std::string& name) {
  const auto scenes = feature_scenes();
  const auto at =
      std::find_if(scenes.begin(), scenes.end(), [&](const FeatureScene& s) { return s.name == name; });
  return at == scenes.end() ? nullptr : &*at;
}

bool is_built_in(const FeatureScene& scene) {
  if (core::overlays_refused().empty()) return true;
  return std::none_of(scene.set.begin(), scene.set.end(),
                      [](const std::string& key) { return key.starts_with("overlay."); });
}

core::DrawRequest scene_request(const FeatureScene& scene, const core::View& view) {
  RenderOptions options;
  options.set = kBare;
  options.set.insert(options.set.end(), scene.set.begin(), scene.set.end());
  core::DrawRequest request;
  request.settings = make_settings(options).values();
  request.view = view;
  request.want_range = scene.range;
  request.sun = mars::sun_direction(mars::lon_lat(view.camera.position_m), request.settings.sun_azimuth_deg,
                                    request.settings.sun_elevation_deg);
  return request;
}

ScenePainter::ScenePainter(const FeatureScene& scene, std::shared_ptr<const paging::PlanetFile> planet,
                           const std::string& statistics_file)
    : scene_(scene) {
  if (overlay::any(scene_request(scene, {}).settings)) overlays_ = std::make_unique<FrameOverlays>(planet);
  if (scene.statistics) statistics_ = std::make_unique<scripts::StatsWriter>(statistics_file);
}

core::FrameStats ScenePainter::paint(core::Renderer& renderer, const core::DrawRequest& request) {
  const auto draw = [&](const core::DrawRequest& eye) {
    core::DrawResult result = renderer.draw(eye);
    if (!overlays_) return result;
    FrameGround ground{result.frame.range_m, result.certificate, {}};
    if (const auto finer = contour_request(eye, result)) ground.contours = renderer.draw(*finer);
    overlay::composite(overlays_->layer(eye, ground, 0), result.frame.colour);
    return result;
  };
  core::DrawResult result;
  if (scene_.stereo) {
    StereoArguments stereo;
    stereo.layout = "sbs";
    stereo.eye_base_m = 20;
    result = std::move(
        draw_stereo(stereo, request, [&](const core::DrawRequest& eye, Eye) { return draw(eye); }).left);
  } else {
    result = draw(request);
  }
  if (statistics_) statistics_->row(frame_, static_cast<double>(frame_), result.stats, result.certificate);
  ++frame_;
  return result.stats;
}

}  // namespace vpe::app
