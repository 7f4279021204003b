#include "vpe/window/marks/pivot_mark.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <optional>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr ImU32 kPivot = IM_COL32(255, 255, 255, 235);
constexpr ImU32 kPivotDark = IM_COL32(0, 0, 0, 150);

}  // namespace

void draw_pivot_mark(ImDrawList& list, const glm::dvec3& pivot_m, const EyeImage& eye) {
  const mars::LocalFrame frame = mars::local_frame(mars::lon_lat(pivot_m));
  const double radius_m = PivotMarkLimits::kRadius * glm::length(pivot_m - eye.view.camera.position_m);
  const auto shown = [&](const glm::dvec3& point_m) -> std::optional<ImVec2> {
    const core::Projected p = core::project(eye.view, point_m);
    if (p.behind) return std::nullopt;
    return at(eye.x0 + p.xy.x, eye.y0 + p.xy.y);
  };
  std::vector<ImVec2> ring;
  for (int n = 0; n < PivotMarkLimits::kRingParts; ++n) {
    const double angle = 2 * std::numbers::pi * n / PivotMarkLimits::kRingParts;
    const auto point =
        shown(pivot_m + radius_m * (std::cos(angle) * frame.north + std::sin(angle) * frame.east));
    if (!point) return;
    ring.push_back(*point);
  }
  const float thick = ImGui::GetFontSize() / 8;
  const auto count = static_cast<int>(ring.size());
  list.AddPolyline(ring.data(), count, kPivotDark, ImDrawFlags_Closed, 2.5F * thick);
  list.AddPolyline(ring.data(), count, kPivot, ImDrawFlags_Closed, thick);
  if (const auto middle = shown(pivot_m)) {
    list.AddCircleFilled(*middle, 2.2F * thick, kPivotDark);
    list.AddCircleFilled(*middle, 1.4F * thick, kPivot);
  }
}

}  // namespace vpe::window
