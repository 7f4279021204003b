// The map: the planet flat, the camera and what it sees, clicked to go there, dragged, zoomed.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "vpe/core/interest.h"
#include "vpe/explore/files/hotspots.h"
#include "vpe/explore/measure/map_painter.h"
#include "vpe/explore/measure/map_view.h"
#include "vpe/explore/session.h"
#include "vpe/window/display.h"
#include "vpe/window/widgets.h"

namespace vpe::window {

// What the user asked for in a frame.
struct MapActions {
  std::optional<mars::LonLat> under_cursor;
  std::optional<mars::LonLat> go_to;               // a click
  std::optional<core::InterestRegion> new_region;  // drawn with Shift
  struct Drag {
    std::size_t waypoint = 0;
    mars::LonLat to;
    bool goes_on = false;  // of the same drag
  };
  std::optional<Drag> drag;
  std::optional<mars::LonLat> new_waypoint;  // a click with Ctrl
};

class MapPanel {
 public:
  // Images of the map are made on a thread of its own; `tell` is called there when one is finished.
  MapPanel(std::shared_ptr<const paging::PlanetFile> planet, int threads, std::function<void()> tell);
  ~MapPanel();

  // Inside an ImGui window: takes so many pixels of it. `way`: points that are measured. `spots`: that have panoramas.
  MapActions draw(const explore::Session& session, explore::MapGround ground, std::span<const mars::LonLat> way,
                  std::span<const explore::Hotspot> hotspots, int width, int height, Widgets& widgets);

  const explore::MapView& map() const { return map_; }
  bool is_at_rest() const;

 private:
  struct Request {
    explore::MapView map;
    explore::MapGround ground = explore::MapGround::kRelief;
    bool operator==(const Request&) const = default;
  };

  void run();
  std::optional<std::size_t> waypoint_near(const explore::Session& session, glm::dvec2 xy) const;
  void draw_marks(const explore::Session& session, double x0, double y0) const;
  void draw_hotspots(std::span<const explore::Hotspot> hotspots, double x0, double y0) const;
  void draw_way(std::span<const mars::LonLat> way, double x0, double y0) const;

  std::shared_ptr<const paging::PlanetFile> planet_;
  int threads_;
  std::function<void()> tell_;
  explore::MapView map_;
  bool is_fresh_ = true;
  std::optional<glm::dvec2> pressed_;  // on the map, while the button is down
  bool is_drag_ = false;
  bool with_shift_ = false;
  bool with_control_ = false;
  glm::dvec2 dragged_{0, 0};
  std::optional<std::size_t> waypoint_;  // that is dragged
  bool waypoint_moved_ = false;
  std::unique_ptr<Texture> texture_;
  explore::MapView shown_;  // of the texture
  std::optional<Request> asked_;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Request> waiting_;
  std::optional<std::pair<Request, core::RgbImage>> finished_;
  bool is_busy_ = false;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace vpe::window
