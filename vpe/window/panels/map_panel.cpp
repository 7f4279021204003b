#include "vpe/window/panels/map_panel.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "paging/planet/planet_meta.h"
#include "vpe/explore/measure/map_line.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr std::size_t kBudget_bytes = std::size_t{96} << 20;
constexpr double kDragBegins_px = 4;
constexpr std::size_t kMostMarks = 200;  // of waypoints, and of hotspots with names
constexpr double kHotspotNames_deg_px =
    0.05;  // names are not shown at smaller scales, where they would overlap
constexpr ImU32 kCamera = IM_COL32(255, 214, 90, 255);
constexpr ImU32 kOutline = IM_COL32(255, 214, 90, 190);
constexpr ImU32 kRegion = IM_COL32(90, 200, 255, 220);
constexpr ImU32 kFlight = IM_COL32(255, 255, 255, 230);
constexpr ImU32 kHotspot = IM_COL32(120, 220, 255, 255);
constexpr ImU32 kPath = IM_COL32(120, 255, 160, 255);
constexpr ImU32 kMapDark = IM_COL32(0, 0, 0, 160);

}  // namespace

MapPanel::MapPanel(std::shared_ptr<const paging::PlanetFile> planet, int threads, std::function<void()> notify)
    : planet_(std::move(planet)), threads_(threads), notify_(std::move(notify)), worker_(make_worker()) {}

void MapPanel::set_planet(std::shared_ptr<const paging::PlanetFile> planet) {
  planet_ = std::move(planet);
  worker_ = make_worker();
  requested_.reset();
}

void MapPanel::set_layers(std::vector<explore::MapLayer> layers, std::uint64_t revision) {
  layers_ = std::make_shared<const std::vector<explore::MapLayer>>(std::move(layers));
  layers_revision_ = revision;
}

std::unique_ptr<MapPanel::Worker> MapPanel::make_worker() const {
  return std::make_unique<Worker>(
      [planet = planet_, threads = threads_, painter = std::unique_ptr<explore::MapPainter>(),
       pool = std::unique_ptr<base::ThreadPool>()](const Request& request) mutable -> std::optional<Made> {
        try {
          if (painter == nullptr) {
            painter = std::make_unique<explore::MapPainter>(planet, kBudget_bytes);
            pool = std::make_unique<base::ThreadPool>(threads);
          }
          core::RgbImage image = painter->paint(request.map, request.style, *pool, *request.layers);
          if (image.width > 0) return Made(request, std::move(image));
        } catch (const std::exception&) {
          // Tiles that cannot be read leave the map unchanged; the view reports them.
        }
        return std::nullopt;
      },
      notify_);
}

MapActions MapPanel::draw(const explore::Session& session, explore::MapStyle style,
                          std::span<const mars::LonLat> path, std::span<const explore::Hotspot> hotspots,
                          int width, int height, Widgets& widgets) {
  MapActions actions;
  if (is_fresh_) {
    map_ = explore::whole_map(width, height);
    is_fresh_ = false;
  } else if (map_.width != width || map_.height != height) {
    map_ = explore::resized(map_, width, height);
  }
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("map", at(width, height));
  widgets.record("map");
  const ImGuiIO& io = ImGui::GetIO();
  const glm::dvec2 xy{static_cast<double>(io.MousePos.x - corner.x),
                      static_cast<double>(io.MousePos.y - corner.y)};
  if (ImGui::IsItemHovered()) actions.under_cursor = map_.place(xy);
  if (ImGui::IsItemHovered() && io.MouseWheel != 0.0F)
    map_ = explore::zoomed(map_, xy, std::pow(1.25, static_cast<double>(io.MouseWheel)));
  if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) menu_click_.press(xy);
  menu_click_.move(xy);
  if (ImGui::IsMouseReleased(ImGuiMouseButton_Right)) {
    if (const auto clicked = menu_click_.release(); clicked && ImGui::IsItemHovered())
      actions.menu_at = map_.place(*clicked);
  }
  if (ImGui::IsItemActivated()) {
    pressed_ = xy;
    dragged_ = xy;
    is_drag_ = false;
    waypoint_ = waypoint_near(session, xy);
    waypoint_moved_ = false;
    with_shift_ = io.KeyShift;
    with_control_ = io.KeyCtrl;
    with_alt_ = io.KeyAlt;
    overlay_holds_ = overlay_ != nullptr && overlay_->press_on_map(map_, xy);
  }
  if (pressed_ && ImGui::IsItemActive()) {
    is_drag_ = is_drag_ || glm::length(xy - *pressed_) > kDragBegins_px;
    if (overlay_holds_) {
      if (const auto place = map_.place(xy); place && is_drag_ && xy != dragged_) overlay_->drag_on_map(*place);
    } else if (is_drag_ && waypoint_) {
      if (const auto place = map_.place(xy); place && xy != dragged_) {
        actions.drag = MapActions::Drag{*waypoint_, *place, waypoint_moved_};
        waypoint_moved_ = true;
      }
    } else if (with_alt_) {
      actions.aim_at = map_.place(xy);
    } else if (is_drag_ && !with_shift_) {
      map_ = explore::moved(map_, xy - dragged_);
    }
    dragged_ = xy;
  }
  if (pressed_ && ImGui::IsItemDeactivated()) {
    const auto place = map_.place(xy);
    const auto begun = map_.place(*pressed_);
    if (overlay_holds_) {
      overlay_->release_on_map();
    } else if (waypoint_ && is_drag_) {
      // The waypoint stays where it was dropped.
    } else if (with_shift_ && is_drag_ && place && begun) {
      const double radius_m = mars::distance_rad(*begun, *place) * planet_->radius_m();
      actions.new_region =
          core::InterestRegion{begun->lon_deg, begun->lat_deg, radius_m, with_control_ ? -1 : 1};
    } else if (!is_drag_ && !with_alt_ && place) {
      if (with_control_)
        actions.new_waypoint = place;
      else if (overlay_ == nullptr || !overlay_->click_on_map(map_, xy, ImGui::GetTime()))
        actions.go_to = place;
    }
    pressed_.reset();
  }

  const Request request{map_, style, layers_revision_, layers_};
  if (!(requested_ == request)) {
    requested_ = request;
    worker_->request(request);
  }
  if (const std::optional<Made> made = worker_->take()) {
    if (texture_ == nullptr) texture_ = std::make_unique<Texture>();
    texture_->upload(made->second);
    shown_ = made->first.map;
  }

  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(corner, at(corner.x + static_cast<float>(width), corner.y + static_cast<float>(height)),
                    true);
  list.AddRectFilled(corner, at(corner.x + static_cast<float>(width), corner.y + static_cast<float>(height)),
                     IM_COL32(40, 42, 46, 255));
  if (texture_ != nullptr) {
    // The present image may be of another section of the map: draws it at its place in the present one.
    const double scale = shown_.degrees_per_px / map_.degrees_per_px;
    const double wide = shown_.lon_degrees_per_px() / map_.lon_degrees_per_px();
    const glm::dvec2 middle = map_.position(shown_.middle);
    const double w = shown_.width * wide / 2;
    const double h = shown_.height * scale / 2;
    list.AddImage(texture_->id(), at(corner.x + middle.x - w, corner.y + middle.y - h),
                  at(corner.x + middle.x + w, corner.y + middle.y + h));
  }
  draw_marks(session, corner.x, corner.y);
  draw_hotspots(hotspots, corner.x, corner.y);
  draw_path(path, corner.x, corner.y);
  if (overlay_ != nullptr) overlay_->draw_on_map(list, map_, corner.x, corner.y);
  list.PopClipRect();
  return actions;
}

// Returns the waypoint at a position, if any.
std::optional<std::size_t> MapPanel::waypoint_near(const explore::Session& session, glm::dvec2 xy) const {
  const explore::FlightEditor* editor = session.flights().editor();
  if (editor == nullptr || editor->flight().waypoints.size() > kMostMarks) return std::nullopt;
  const double reach_px = static_cast<double>(ImGui::GetFontSize()) * 0.6;
  std::optional<std::size_t> nearest;
  double nearest_px = reach_px;
  const std::vector<scripts::Waypoint>& all = editor->flight().waypoints;
  for (std::size_t n = 0; n < all.size(); ++n) {
    const double off_px = glm::length(map_.position({all[n].lon_deg, all[n].lat_deg}) - xy);
    if (off_px < nearest_px) {
      nearest = n;
      nearest_px = off_px;
    }
  }
  return nearest;
}

void MapPanel::draw_marks(const explore::Session& session, double x0, double y0) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const mars::Pose& pose = session.pose();
  const double radius_m = session.ground().radius_m;
  const auto point = [&](mars::LonLat place) {
    const glm::dvec2 p = map_.position(place);
    return at(x0 + p.x, y0 + p.y);
  };
  // Lines across the map's edge are left out: they would run across the whole map.
  const auto line = [&](mars::LonLat a, mars::LonLat b, ImU32 colour, float thick) {
    const ImVec2 p = point(a);
    const ImVec2 q = point(b);
    if (std::abs(p.x - q.x) < static_cast<float>(180.0 / map_.lon_degrees_per_px()))
      list.AddLine(p, q, colour, thick);
  };
  const double ground_m = radius_m + pose.alt_m - session.height_m();
  const std::vector<mars::LonLat> outline = explore::footprint(session.view(), ground_m);
  for (std::size_t n = 0; n < outline.size(); ++n)
    line(outline[n], outline[(n + 1) % outline.size()], kOutline, 1.5F);

  for (const core::InterestRegion& region : session.interest()) {
    constexpr int kCorners = 48;
    const mars::LonLat middle{region.lon_deg, region.lat_deg};
    mars::LonLat before = mars::destination(middle, 0, region.radius_m / radius_m);
    for (int n = 1; n <= kCorners; ++n) {
      const mars::LonLat next = mars::destination(middle, 360.0 * n / kCorners, region.radius_m / radius_m);
      line(before, next, kRegion, 1.5F);
      before = next;
    }
  }
  if (const explore::FlightEditor* editor = session.flights().editor(); editor != nullptr) {
    // A long log is drawn with every n-th pose.
    constexpr std::size_t kMost = 2000;
    const std::vector<scripts::Waypoint>& all = editor->flight().waypoints;
    const std::size_t every = 1 + all.size() / kMost;
    const bool few = all.size() <= kMostMarks;
    for (std::size_t n = 0; n + every < all.size(); n += every) {
      constexpr int kParts = 8;
      const glm::dvec3 a = mars::direction({all[n].lon_deg, all[n].lat_deg});
      const glm::dvec3 b = mars::direction({all[n + every].lon_deg, all[n + every].lat_deg});
      mars::LonLat before{all[n].lon_deg, all[n].lat_deg};
      for (int k = 1; k <= kParts; ++k) {
        const mars::LonLat next = mars::lon_lat(mars::slerp(a, b, static_cast<double>(k) / kParts));
        line(before, next, kFlight, 1.5F);
        before = next;
      }
    }
    for (std::size_t n = 0; few && n < all.size(); ++n) {
      const ImVec2 p = point({all[n].lon_deg, all[n].lat_deg});
      list.AddCircleFilled(p, ImGui::GetFontSize() * 0.28F, kFlight);
      list.AddCircle(p, ImGui::GetFontSize() * 0.28F, kMapDark, 0, 1.5F);
    }
  }
  if (pressed_ && is_drag_ && with_shift_) {
    const double radius = glm::length(dragged_ - *pressed_);
    list.AddCircle(at(x0 + pressed_->x, y0 + pressed_->y), static_cast<float>(radius), kRegion, 48, 1.5F);
  }

  // Beside the map the camera is marked at its border.
  const glm::dvec2 inside = glm::clamp(map_.position({pose.lon_deg, pose.lat_deg}), glm::dvec2(0),
                                       glm::dvec2(map_.width, map_.height));
  const ImVec2 camera = at(x0 + inside.x, y0 + inside.y);
  const double heading = (pose.yaw_deg + session.look().yaw_deg) * mars::kRadiansPerDegree;
  const double size = ImGui::GetFontSize() * 0.6;
  const auto corner_at = [&](double angle, double r) {
    return at(camera.x + r * std::sin(heading + angle), camera.y - r * std::cos(heading + angle));
  };
  list.AddTriangleFilled(corner_at(0, size * 1.35), corner_at(2.5, size), corner_at(-2.5, size), kCamera);
  list.AddTriangle(corner_at(0, size * 1.35), corner_at(2.5, size), corner_at(-2.5, size), kMapDark, 1.5F);
}

void MapPanel::draw_hotspots(std::span<const explore::Hotspot> hotspots, double x0, double y0) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float size = ImGui::GetFontSize() * 0.35F;
  const bool named = hotspots.size() <= kMostMarks && map_.degrees_per_px < kHotspotNames_deg_px;
  for (const explore::Hotspot& hotspot : hotspots) {
    const glm::dvec2 p = map_.position(hotspot.place);
    if (p.x < 0 || p.y < 0 || p.x > map_.width || p.y > map_.height) continue;
    const ImVec2 middle = at(x0 + p.x, y0 + p.y);
    const ImVec2 corners[4] = {{middle.x, middle.y - size},
                               {middle.x + size, middle.y},
                               {middle.x, middle.y + size},
                               {middle.x - size, middle.y}};
    list.AddConvexPolyFilled(corners, 4, kHotspot);
    list.AddPolyline(corners, 4, kMapDark, ImDrawFlags_Closed, 1.5F);
    if (!named) continue;
    const ImVec2 text{middle.x + size * 1.6F, middle.y - ImGui::GetFontSize() * 0.5F};
    list.AddText({text.x + 1, text.y + 1}, kMapDark, hotspot.name.c_str());
    list.AddText(text, kHotspot, hotspot.name.c_str());
  }
}

void MapPanel::draw_path(std::span<const mars::LonLat> path, double x0, double y0) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  std::vector<ImVec2> points;
  for (const std::vector<glm::dvec2>& piece : explore::map_line(map_, path)) {
    points.clear();
    for (const glm::dvec2 p : piece) points.push_back(at(x0 + p.x, y0 + p.y));
    list.AddPolyline(points.data(), static_cast<int>(points.size()), kPath, 0, 1.5F);
  }
  for (std::size_t n = 0; n < path.size(); ++n) {
    const glm::dvec2 p = map_.position(path[n]);
    list.AddCircleFilled(at(x0 + p.x, y0 + p.y), ImGui::GetFontSize() * 0.22F, kPath);
    const char letter[2] = {static_cast<char>('A' + static_cast<char>(n % 26)), 0};
    list.AddText(at(x0 + p.x + ImGui::GetFontSize() * 0.4, y0 + p.y - ImGui::GetFontSize() * 1.1), kPath,
                 letter);
  }
}

}  // namespace vpe::window
