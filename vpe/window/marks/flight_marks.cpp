#include "vpe/window/marks/flight_marks.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <string>
#include <vector>

#include "vpe/core/view.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr std::size_t kMostPoses = 60;  // with numbers
constexpr int kCourseParts = 180;
constexpr ImU32 kCourse = IM_COL32(255, 255, 255, 225);
constexpr ImU32 kCourseHidden = IM_COL32(255, 255, 255, 70);
constexpr ImU32 kChosen = IM_COL32(255, 214, 90, 255);
constexpr ImU32 kCourseDark = IM_COL32(0, 0, 0, 160);

struct Shown {
  ImVec2 at;
  bool is_hidden = false;
};

// Projects points of the world, as long as they are in front of the camera.
class Projector {
 public:
  Projector(const explore::Session& session, const EyeImage& eye) : eye_(eye), ground_(session.ground()) {}

  std::optional<Shown> operator()(const glm::dvec3& point_m) const {
    const core::Projected p = core::project(eye_.view, point_m);
    if (p.behind) return std::nullopt;
    const glm::dvec3& camera_m = eye_.view.camera.position_m;
    const glm::dvec3 path = point_m - camera_m;
    const double range_m = glm::length(path);
    const bool is_near = range_m < 1e-3;
    const double ground_m = is_near ? 0 : ground_.cast_m(camera_m, path / range_m);
    return Shown{vpe::window::at(eye_.x0 + p.xy.x, eye_.y0 + p.xy.y), !is_near && ground_m < range_m * 0.999};
  }

 private:
  const EyeImage& eye_;
  const explore::TerrainQuery& ground_;
};

}  // namespace

void draw_flight_marks(ImDrawList& list, explore::Session& session, std::optional<std::size_t> selected,
                       const EyeImage& eye) {
  const explore::FlightPlayer* player = session.player();
  const explore::FlightEditor* editor = session.flights().editor();
  if (player == nullptr || editor == nullptr || session.follows_flight()) return;
  const Projector projected(session, eye);
  std::optional<Shown> before;
  for (int n = 0; n <= kCourseParts; ++n) {
    const double time_s = player->duration_s() * n / kCourseParts;
    const std::optional<Shown> next = projected(player->state_at(time_s).camera.position_m);
    if (before && next)
      list.AddLine(before->at, next->at, before->is_hidden || next->is_hidden ? kCourseHidden : kCourse, 1.5F);
    before = next;
  }
  const std::vector<scripts::Waypoint>& poses = editor->flight().waypoints;
  if (poses.size() > kMostPoses) return;
  const float radius = ImGui::GetFontSize() * 0.28F;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    const auto shown = projected(player->state_at(poses[n].time_s).camera.position_m);
    if (!shown) continue;
    const bool is_chosen = selected == n;
    const ImU32 colour = is_chosen ? kChosen : shown->is_hidden ? kCourseHidden : kCourse;
    list.AddCircleFilled(shown->at, is_chosen ? radius * 1.5F : radius, colour);
    list.AddCircle(shown->at, is_chosen ? radius * 1.5F : radius, kCourseDark, 0, 1.5F);
    const std::string number = std::to_string(n + 1);
    const ImVec2 text{shown->at.x + radius * 1.8F, shown->at.y - ImGui::GetFontSize()};
    list.AddText({text.x + 1, text.y + 1}, kCourseDark, number.c_str());
    list.AddText(text, colour, number.c_str());
  }
}

std::optional<PoseMark> pose_mark_at(explore::Session& session, const core::View& view, glm::dvec2 xy,
                                     double reach_px) {
  const explore::FlightPlayer* player = session.player();
  const explore::FlightEditor* editor = session.flights().editor();
  if (player == nullptr || editor == nullptr || session.follows_flight()) return std::nullopt;
  const std::vector<scripts::Waypoint>& poses = editor->flight().waypoints;
  if (poses.size() > kMostPoses) return std::nullopt;
  const EyeImage eye{view, 0, 0};
  const Projector projected(session, eye);
  std::optional<PoseMark> nearest;
  double nearest_px = reach_px;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    const auto shown = projected(player->state_at(poses[n].time_s).camera.position_m);
    if (!shown || shown->is_hidden) continue;
    const glm::dvec2 mark{shown->at.x, shown->at.y};
    if (glm::length(mark - xy) > nearest_px) continue;
    nearest_px = glm::length(mark - xy);
    nearest = PoseMark{n, mark};
  }
  return nearest;
}

}  // namespace vpe::window
