// The scenes of `vpe report features`: a bare one, and others that differ from one another by one feature.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scripts/stats.h"
#include "vpe/app/picture/frame_overlays.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/core/frame.h"

namespace vpe::app {

struct FeatureScene {
  std::string name;
  std::string compared;          // the scene without the feature; empty for the bare one
  std::vector<std::string> set;  // KEY=VALUE, in addition to those of the bare scene
  bool range = false;
  bool statistics = false;  // a row for each frame into a file
  bool stereo = false;      // two eyes side by side
  bool rays = true;         // the ray backend can draw it, and the feature affects it
  bool imagery = false;     // needs imagery in the planet file
};

// Returns all scenes, the bare one first: one colour, no light, no imagery, black sky, hard edges, no occlusion
// culling, one camera.
std::span<const FeatureScene> feature_scenes();

// Returns the scene of that name, or null.
const FeatureScene* find_scene(const std::string& name);

// Returns true if this program can draw the scene: overlays may be left out of a build.
bool is_built_in(const FeatureScene& scene);

core::DrawRequest scene_request(const FeatureScene& scene, const core::View& view);

// Draws a scene as `vpe render` and `vpe fly` do. Makes nothing that the scene does not use. Use it on the
// renderer's thread.
class ScenePainter {
 public:
  // Writes rows of statistics to a file of this name, if the scene has them.
  ScenePainter(const FeatureScene& scene, std::shared_ptr<const paging::PlanetFile> planet,
               const std::string& statistics_file);

  // Draws the finished image and returns its statistics; for two eyes those of the left one.
  core::FrameStats paint(core::Renderer& renderer, const core::DrawRequest& request);

 private:
  FeatureScene scene_;
  std::unique_ptr<FrameOverlays> overlays_;
  std::unique_ptr<scripts::StatsWriter> statistics_;
  std::int64_t frame_ = 0;
};

}  // namespace vpe::app
