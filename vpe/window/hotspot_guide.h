// Panoramas in the world: where they are, which is near, and stepping into them.
#pragma once

#include <imgui.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vpe/explore/files/hotspots.h"
#include "vpe/explore/session.h"
#include "vpe/window/overlook_view.h"

namespace vpe::window {

// A panorama's view; throws what is wrong with the file.
using OpenOverlook = std::function<OverlookSetup(const std::filesystem::path& panorama)>;

class HotspotGuide {
 public:
  HotspotGuide(std::vector<explore::Hotspot> hotspots, OpenOverlook open);

  const std::vector<explore::Hotspot>& hotspots() const { return hotspots_; }

  // Where the camera is now. While it approaches a spot its panorama is opened ahead. Returns what is worth saying
  // when that has changed, else nothing. Its first image is made for a view of that size.
  std::string follow(const explore::Session& session, const ViewArea& area);
  // The spot that one may step into.
  const explore::Hotspot* within_reach() const;

  // Steps into it. What is wrong, empty when all is well.
  std::string enter();
  void step_out() { inside_.reset(); }
  // The panorama that one stands in; null outside.
  OverlookView* inside() { return inside_.get(); }
  const OverlookView* inside() const { return inside_.get(); }
  const glm::dvec3& inside_camera_m() const { return eyes_m_[inside_index_]; }
  const explore::Hotspot* inside_hotspot() const { return inside_ ? &hotspots_[inside_index_] : nullptr; }

  // Markers and names over a view with its upper left corner at (x0, y0); those that ground hides are left out.
  void draw_marks(ImDrawList& list, const explore::Session& session, double x0, double y0) const;

 private:
  void place(const explore::Session& session);

  std::vector<explore::Hotspot> hotspots_;
  OpenOverlook open_;
  std::vector<glm::dvec3> eyes_m_;
  double placed_exaggeration_ = -1;
  std::optional<explore::HotspotTracker> tracker_;
  explore::HotspotTracker::State state_;
  std::unique_ptr<OverlookView> ahead_;
  std::size_t ahead_index_ = 0;
  std::unique_ptr<OverlookView> inside_;
  std::size_t inside_index_ = 0;
};

}  // namespace vpe::window
