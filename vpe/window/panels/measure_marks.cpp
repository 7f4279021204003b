#include "vpe/window/panels/measure_marks.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "vpe/explore/results/measure_path.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr ImU32 kMeasureMark = IM_COL32(255, 214, 90, 255);
constexpr ImU32 kMeasureFaint = IM_COL32(255, 214, 90, 90);
constexpr ImU32 kMarkDark = IM_COL32(0, 0, 0, 200);
constexpr ImU32 kFaintDark = IM_COL32(0, 0, 0, 60);

class Marker : private GroundView {
 public:
  Marker(ImDrawList& list, const explore::Session& session, const EyeImage& eye)
      : GroundView(session, eye.view),
        list_(list),
        session_(session),
        x0_(eye.x0),
        y0_(eye.y0),
        thick_(std::max(1.5F, ImGui::GetFontSize() / 8)) {}

  ImVec2 at(glm::dvec2 xy) const { return {static_cast<float>(x0_ + xy.x), static_cast<float>(y0_ + xy.y)}; }

  void line(const explore::Profile& profile) const;
  void point(mars::LonLat place, const std::string& name) const;
  void cross(mars::LonLat place) const;
  void clip() const { list_.PushClipRect(at({0, 0}), at({view().width, view().height}), true); }
  void end_clip() const { list_.PopClipRect(); }

 private:
  struct LinePoint {
    glm::dvec3 place_m;
    core::Projected seen;
    bool hidden = false;
  };
  void draw_section(std::vector<LinePoint> points) const;

  ImDrawList& list_;
  const explore::Session& session_;
  double x0_;
  double y0_;
  float thick_;  // of lines; each lies on a dark one twice as wide
};

// Draws one section of the path, which is in the view.
void Marker::draw_section(std::vector<LinePoint> points) const {
  const std::size_t every = 1 + points.size() / MarkLimits::kLinePoints;
  std::vector<LinePoint> kept;
  for (std::size_t n = 0; n < points.size(); ++n)
    if (n % every == 0 || n + 1 == points.size()) kept.push_back(points[n]);
  const std::size_t cast_every = 1 + kept.size() / MarkLimits::kCasts;
  bool hidden = false;
  for (std::size_t n = 0; n < kept.size(); ++n) {
    if (n % cast_every == 0) hidden = is_hidden(kept[n].place_m);
    kept[n].hidden = hidden;
  }
  const auto runs = [&](const auto& draw) {
    for (std::size_t n = 1; n < kept.size(); ++n) {
      const LinePoint& a = kept[n - 1];
      const LinePoint& b = kept[n];
      if (!a.seen.behind && !b.seen.behind) draw(at(a.seen.xy), at(b.seen.xy), a.hidden || b.hidden);
    }
  };
  runs(
      [&](ImVec2 a, ImVec2 b, bool faint) { list_.AddLine(a, b, faint ? kFaintDark : kMarkDark, 2 * thick_); });
  runs([&](ImVec2 a, ImVec2 b, bool faint) {
    list_.AddLine(a, b, faint ? kMeasureFaint : kMeasureMark, thick_);
  });
}

void Marker::line(const explore::Profile& profile) const {
  const double exaggeration = session_.settings().values().exaggeration;
  std::vector<LinePoint> all;
  all.reserve(profile.points.size());
  for (const paging::ProfilePoint& p : profile.points) {
    LinePoint next;
    next.place_m = mars::direction(p.place) * (session_.ground().radius_m + p.height_m * exaggeration);
    next.seen = seen(next.place_m);
    all.push_back(next);
  }
  // A piece with both ends outside of the view may still cross it.
  const auto crosses = [&](std::size_t n) {
    const core::Projected& p = all[n - 1].seen;
    const core::Projected& q = all[n].seen;
    return !p.behind && !q.behind && std::min(p.xy.x, q.xy.x) <= view().width &&
           std::max(p.xy.x, q.xy.x) >= 0 && std::min(p.xy.y, q.xy.y) <= view().height &&
           std::max(p.xy.y, q.xy.y) >= 0;
  };
  for (std::size_t n = 1; n < all.size(); ++n) {
    if (!crosses(n)) continue;
    const std::size_t begin = n - 1;
    while (n < all.size() && crosses(n)) ++n;
    draw_section(
        {all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(n)});
  }
}

void Marker::point(mars::LonLat place, const std::string& name) const {
  const glm::dvec3 place_m = on_ground(mars::direction(place));
  const core::Projected p = seen(place_m);
  if (!is_in_view(p)) return;
  const ImVec2 middle = at(p.xy);
  const auto size = static_cast<float>(ImGui::GetFontSize() * 0.28);
  const bool hidden = is_hidden(place_m);
  list_.AddCircleFilled(middle, size + 0.8F * thick_, hidden ? kFaintDark : kMarkDark);
  if (hidden)
    list_.AddCircle(middle, size, kMeasureFaint, 0, thick_);
  else
    list_.AddCircleFilled(middle, size, kMeasureMark);
  const ImVec2 corner{middle.x + size + 3, middle.y - ImGui::GetFontSize() - 1};
  draw_bordered(list_, corner, name, hidden ? IM_COL32(255, 214, 90, 170) : kMeasureMark,
                hidden ? kFaintDark : kMarkDark);
}

void Marker::cross(mars::LonLat place) const {
  const core::Projected p = seen(on_ground(mars::direction(place)));
  if (!is_in_view(p)) return;
  const ImVec2 m = at(p.xy);
  const auto size = static_cast<float>(ImGui::GetFontSize() * 0.5);
  for (const auto& [colour, thick] :
       {std::pair{kMarkDark, 2 * thick_}, {IM_COL32(255, 255, 255, 255), thick_}}) {
    list_.AddLine({m.x - size, m.y}, {m.x + size, m.y}, colour, thick);
    list_.AddLine({m.x, m.y - size}, {m.x, m.y + size}, colour, thick);
  }
}

}  // namespace

void draw_measure_marks(ImDrawList& list, const explore::Session& session, const MeasureMarks& marks,
                        const EyeImage& eye) {
  const Marker marker(list, session, eye);
  marker.clip();
  if (marks.profile != nullptr) marker.line(*marks.profile);
  for (std::size_t n = 0; n < marks.points.size(); ++n)
    marker.point(marks.points[n], explore::path_point_name(n));
  if (marks.marked) marker.cross(*marks.marked);
  marker.end_clip();
}

}  // namespace vpe::window
