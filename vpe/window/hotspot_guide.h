// Panorama hotspots in the window: which one is near, opening its panorama ahead, entering and leaving it.
//
// Hotspots are drawn as marks over the images of the window. They are not objects of the scene: films and still images
// do not show them.
#pragma once

#include <imgui.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vpe/explore/files/hotspots.h"
#include "vpe/explore/session.h"
#include "vpe/window/marks/ground_view.h"
#include "vpe/window/overlook_view.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

// Opens a panorama's view. Throws if the file cannot be used.
using OpenOverlook = std::function<OverlookSetup(const std::filesystem::path& panorama)>;

// Follows the camera and holds the panorama that is open. For the window's thread.
//
// Typical usage, in each iteration of the event loop:
//   if (const std::string text = guide.follow(session, area); !text.empty()) show(text);
//   if (enter_was_pressed) show(guide.enter());
//   if (guide.inside() != nullptr) guide.inside()->draw();
class HotspotGuide {
 public:
  HotspotGuide(std::vector<explore::Hotspot> hotspots, OpenOverlook open);

  const std::vector<explore::Hotspot>& hotspots() const { return hotspots_; }

  // Updates for the session's camera. Opens the panorama of a hotspot that the camera approaches, with a first
  // image for a view of this area. Returns a message for the user if the situation has changed, or "".
  std::string follow(const explore::Session& session, const ViewArea& area);
  // Returns the hotspot that can be entered, or null.
  const explore::Hotspot* within_reach() const;

  // Enters the hotspot within reach, with the heading of the session's view. Returns what is wrong, or "".
  std::string enter(const explore::Session& session);
  void leave() { inside_.reset(); }
  // Returns the panorama that was entered, or null.
  OverlookView* inside() { return inside_.get(); }
  const OverlookView* inside() const { return inside_.get(); }
  const glm::dvec3& inside_camera_m() const { return positions_m_[inside_index_]; }
  const explore::Hotspot* inside_hotspot() const { return inside_ ? &hotspots_[inside_index_] : nullptr; }

  // Draws marks and names over the image of an eye, except those hidden by terrain.
  void draw_marks(ImDrawList& list, const explore::Session& session, const EyeImage& eye) const;

 private:
  void compute_positions(const explore::Session& session);

  std::vector<explore::Hotspot> hotspots_;
  OpenOverlook open_;
  std::vector<glm::dvec3> positions_m_;
  double positions_exaggeration_ = -1;
  std::optional<explore::HotspotTracker> tracker_;
  explore::HotspotTracker::State state_;
  std::unique_ptr<OverlookView> ahead_;  // of the hotspot that the camera approaches
  std::size_t ahead_index_ = 0;
  std::unique_ptr<OverlookView> inside_;
  std::size_t inside_index_ = 0;
};

}  // namespace vpe::window
