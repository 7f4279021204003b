// The map panel: a flat map with the camera and its footprint. The user can click, drag and zoom it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "vpe/base/latest_worker.h"
#include "vpe/core/interest.h"
#include "vpe/explore/files/hotspots.h"
#include "vpe/explore/measure/map_painter.h"
#include "vpe/explore/measure/map_view.h"
#include "vpe/explore/session.h"
#include "vpe/window/menu/still_click.h"
#include "vpe/window/ui/display.h"
#include "vpe/window/ui/widgets.h"

namespace vpe::window {

// Holds what the user did with the map in one frame.
struct MapActions {
  std::optional<mars::LonLat> under_cursor;
  std::optional<mars::LonLat> go_to;  // by a click
  // By dragging with Shift: a level finer; with Ctrl and Shift: a level coarser.
  std::optional<core::InterestRegion> new_region;
  std::optional<mars::LonLat> aim_at;  // the camera turns there, by dragging with Alt
  struct Drag {
    std::size_t waypoint = 0;
    mars::LonLat to;
    bool continues = false;  // not the first step of this drag
  };
  std::optional<Drag> drag;
  std::optional<mars::LonLat> new_waypoint;  // by a click with Ctrl
  std::optional<mars::LonLat> menu_at;       // by a right click
};

// Lies over the map, and may take clicks and drags on it.
class MapOverlay {
 public:
  virtual ~MapOverlay() = default;
  // Draws over a map whose upper left corner is at (x0, y0) of the list.
  virtual void draw_on_map(ImDrawList& list, const explore::MapView& map, double x0, double y0) = 0;
  // Returns true if what lies at a position is dragged from there. Then the others follow.
  virtual bool press_on_map(const explore::MapView& map, glm::dvec2 xy) = 0;
  virtual void drag_on_map(mars::LonLat to) = 0;
  virtual void release_on_map() = 0;
  // Returns true if the click was for the overlay.
  virtual bool click_on_map(const explore::MapView& map, glm::dvec2 xy, double time_s) = 0;
};

// Draws the map. For the window's thread.
class MapPanel {
 public:
  // Images of the map are painted on a thread of its own, which calls `notify` when one is finished.
  MapPanel(std::shared_ptr<const paging::PlanetFile> planet, int threads, std::function<void()> notify);

  // Draws the map inside an ImGui window, with this size in pixels. `path` holds the points that are measured.
  MapActions draw(const explore::Session& session, explore::MapStyle style, std::span<const mars::LonLat> path,
                  std::span<const explore::Hotspot> hotspots, int width, int height, Widgets& widgets);

  // Shows another planet file of the same body from now on. Waits for the image that is being painted.
  void set_planet(std::shared_ptr<const paging::PlanetFile> planet);

  // Shows vector layers on the map from now on; `revision` differs whenever they do.
  void set_layers(std::vector<explore::MapLayer> layers, std::uint64_t revision);
  std::uint64_t layers_revision() const { return layers_revision_; }

  // Draws this over the map too, from now on; it must outlive the panel. May be null.
  void set_overlay(MapOverlay* overlay) { overlay_ = overlay; }

  const explore::MapView& map() const { return map_; }
  bool is_at_rest() const { return worker_->is_idle(); }

 private:
  struct Request {
    explore::MapView map;
    explore::MapStyle style = explore::MapStyle::kElevation;
    std::uint64_t layers_revision = 0;
    std::shared_ptr<const std::vector<explore::MapLayer>> layers;
    bool operator==(const Request&) const = default;
  };
  using Made = std::pair<Request, core::RgbImage>;

  std::optional<std::size_t> waypoint_near(const explore::Session& session, glm::dvec2 xy) const;
  void draw_marks(const explore::Session& session, double x0, double y0) const;
  void draw_hotspots(std::span<const explore::Hotspot> hotspots, double x0, double y0) const;
  void draw_path(std::span<const mars::LonLat> path, double x0, double y0) const;

  std::shared_ptr<const paging::PlanetFile> planet_;
  int threads_;
  std::function<void()> notify_;
  explore::MapView map_;
  bool is_fresh_ = true;
  std::optional<glm::dvec2> pressed_;  // on the map, while the button is down
  bool is_drag_ = false;
  bool with_shift_ = false;
  bool with_control_ = false;
  bool with_alt_ = false;
  glm::dvec2 dragged_{0, 0};
  std::optional<std::size_t> waypoint_;  // that is dragged
  bool waypoint_moved_ = false;
  StillClick menu_click_;  // of the right button
  MapOverlay* overlay_ = nullptr;
  bool overlay_holds_ = false;  // what is dragged
  std::unique_ptr<Texture> texture_;
  explore::MapView shown_;  // of the texture
  std::optional<Request> requested_;
  std::shared_ptr<const std::vector<explore::MapLayer>> layers_ =
      std::make_shared<const std::vector<explore::MapLayer>>();
  std::uint64_t layers_revision_ = 0;

  using Worker = base::LatestWorker<Request, Made>;
  std::unique_ptr<Worker> make_worker() const;
  std::unique_ptr<Worker> worker_;
};

}  // namespace vpe::window
