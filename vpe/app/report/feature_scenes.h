// The scenes of `vpe report features`: a bare one, and others that differ by one thing each.
#pragma once

#include <memory>
#include <optional>
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
  std::string compared;          // the scene without the thing; empty for the bare one
  std::vector<std::string> set;  // KEY=VALUE, on top of those of the bare scene
  bool range = false;
  bool statistics = false;  // a row a frame into a file
  bool stereo = false;      // two eyes side by side
  bool rays = true;         // the ray backend can draw it, and it is something there
  bool imagery = false;     // of the planet file
};

// The bare one first: one colour, no light, no imagery, black sky, hard edges, no culling by occlusion, one
// camera.
std::span<const FeatureScene> feature_scenes();

// Nothing for a name that there is not.
const FeatureScene* find_scene(const std::string& name);

// Whether this program can draw it: overlays may be left out.
bool is_built_in(const FeatureScene& scene);

core::DrawRequest scene_request(const FeatureScene& scene, const core::View& view);

// Draws a scene as `vpe render` and `vpe fly` do. What the scene does not use is not made. One thread, the
// renderer's.
class ScenePainter {
 public:
  // Rows of statistics go to a file under this name.
  ScenePainter(const FeatureScene& scene, std::shared_ptr<const paging::PlanetFile> planet,
               const std::string& statistics_file);

  // The finished image's statistics; of two eyes the left one's.
  core::FrameStats paint(core::Renderer& renderer, const core::DrawRequest& request);

 private:
  FeatureScene scene_;
  std::unique_ptr<FrameOverlays> overlays_;
  std::unique_ptr<scripts::StatsWriter> statistics_;
  std::int64_t frame_ = 0;
};

}  // namespace vpe::app
