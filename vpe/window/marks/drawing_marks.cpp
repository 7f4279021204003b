#include "vpe/window/marks/drawing_marks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>
#include <utility>

#include "vpe/explore/measure/map_line.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

using explore::Drawing;
using explore::DrawingKind;

constexpr double kRefined_px = 40;         // longer pieces in the view follow the ground more closely
constexpr double kEdgeStep_rad = 3e-4;     // a kilometre on Mars
constexpr std::size_t kMostOnMap = 4'000;  // vertices of a drawing

ImVec2 vec_of(double x, double y) { return {static_cast<float>(x), static_cast<float>(y)}; }

ImU32 colour_of(base::Rgb c, int alpha) { return IM_COL32(c.r, c.g, c.b, alpha); }

// Returns the vertices of the drawing's outline, closed for polygons.
std::vector<mars::LonLat> outline_of(std::span<const mars::LonLat> vertices, bool is_closed) {
  std::vector<mars::LonLat> outline(vertices.begin(), vertices.end());
  if (is_closed && outline.size() > 2) outline.push_back(outline.front());
  return outline;
}

std::vector<glm::dvec3> ground_line(std::span<const mars::LonLat> outline, const GroundView& ground) {
  std::vector<glm::dvec3> points_m;
  if (outline.empty()) return points_m;
  const auto most = static_cast<int>(std::clamp<std::size_t>(
      DrawingMarkLimits::kLinePoints / std::max<std::size_t>(1, outline.size()), 1, 256));
  glm::dvec3 a = mars::direction(outline[0]);
  points_m.push_back(ground.on_ground(a));
  for (const mars::LonLat place : outline.subspan(1)) {
    const glm::dvec3 b = mars::direction(place);
    const int steps = std::clamp(static_cast<int>(mars::angle_between_rad(a, b) / kEdgeStep_rad), 1, most);
    for (int n = 1; n <= steps; ++n)
      points_m.push_back(ground.on_ground(n == steps ? b : mars::slerp(a, b, static_cast<double>(n) / steps)));
    a = b;
  }
  return points_m;
}

class DrawingMarker : public GroundView {
 public:
  DrawingMarker(ImDrawList& list, const explore::Session& session, const EyeImage& eye)
      : GroundView(session, eye.view),
        list_(list),
        x0_(eye.x0),
        y0_(eye.y0),
        thick_(std::max(1.5F, ImGui::GetFontSize() / 8)) {}

  void line(std::span<const glm::dvec3> points_m, base::Rgb colour) {
    Run run;
    for (std::size_t n = 0; n < points_m.size(); ++n) {
      const Seen next{points_m[n], seen(points_m[n])};
      if (n > 0 && may_be_in_view(last_.at, next.at)) {
        if (run.empty()) run.push_back(last_);
        refine(last_, next, run, 0);
        run.push_back(next);
      } else {
        draw(run, colour);
        run.clear();
      }
      last_ = next;
    }
    draw(run, colour);
  }

  void vertex(const glm::dvec3& point_m, base::Rgb colour, float size, const std::string& name) {
    const core::Projected p = seen(point_m);
    if (!is_in_view(p)) return;
    const bool hidden = is_hidden(point_m);
    const ImVec2 middle = at(p.xy);
    list_.AddCircleFilled(middle, size + 0.8F * thick_, IM_COL32(0, 0, 0, hidden ? 60 : 200));
    if (hidden)
      list_.AddCircle(middle, size, colour_of(colour, 90), 0, thick_);
    else
      list_.AddCircleFilled(middle, size, colour_of(colour, 255));
    if (name.empty()) return;
    const ImVec2 corner{middle.x + size + 3, middle.y - ImGui::GetFontSize() - 1};
    draw_bordered(list_, corner, name, colour_of(colour, hidden ? 170 : 255),
                  IM_COL32(0, 0, 0, hidden ? 60 : 200));
  }

  // Shares the casts of a frame among this many lines.
  void share_casts(std::size_t lines) {
    casts_ = std::max<std::size_t>(4, DrawingMarkLimits::kDrawingCasts / std::max<std::size_t>(1, lines));
  }

 private:
  struct Seen {
    glm::dvec3 point_m{0, 0, 0};
    core::Projected at;
  };
  using Run = std::vector<Seen>;

  ImVec2 at(glm::dvec2 xy) const { return vec_of(x0_ + xy.x, y0_ + xy.y); }

  bool may_be_in_view(const core::Projected& p, const core::Projected& q) const {
    return !p.behind && !q.behind && std::min(p.xy.x, q.xy.x) <= view().width &&
           std::max(p.xy.x, q.xy.x) >= 0 && std::min(p.xy.y, q.xy.y) <= view().height &&
           std::max(p.xy.y, q.xy.y) >= 0;
  }

  void refine(const Seen& a, const Seen& b, Run& run, int depth) {
    constexpr int kDepth = 8;
    if (depth == kDepth || refinements_ >= DrawingMarkLimits::kRefinements) return;
    if (!may_be_in_view(a.at, b.at) || glm::length(a.at.xy - b.at.xy) < kRefined_px) return;
    ++refinements_;
    const glm::dvec3 middle = glm::normalize(glm::normalize(a.point_m) + glm::normalize(b.point_m));
    const glm::dvec3 point_m = on_ground(middle);
    const Seen m{point_m, seen(point_m)};
    if (m.at.behind) return;
    refine(a, m, run, depth + 1);
    run.push_back(m);
    refine(m, b, run, depth + 1);
  }

  void draw(const Run& run, base::Rgb colour) {
    if (run.size() < 2) return;
    const std::size_t every = 1 + run.size() / casts_;
    std::vector<bool> hidden(run.size());
    for (std::size_t n = 0; n < run.size(); ++n)
      hidden[n] = n % every == 0 ? is_hidden(run[n].point_m) : hidden[n - 1];
    for (const bool is_dark : {true, false}) {
      for (std::size_t n = 1; n < run.size(); ++n) {
        const bool faint = hidden[n - 1] || hidden[n];
        const ImU32 paint = is_dark ? IM_COL32(0, 0, 0, faint ? 60 : 200) : colour_of(colour, faint ? 90 : 255);
        list_.AddLine(at(run[n - 1].at.xy), at(run[n].at.xy), paint, is_dark ? 2 * thick_ : thick_);
      }
    }
  }

  ImDrawList& list_;
  double x0_;
  double y0_;
  float thick_;  // of lines; each lies on a dark one twice as wide
  Seen last_;
  int refinements_ = 0;
  std::size_t casts_ = DrawingMarkLimits::kDrawingCasts;
};

}  // namespace

const std::vector<glm::dvec3>& DrawingMarks::line_of(const explore::Drawings::Shared& drawing,
                                                     const explore::Session& session) {
  const auto found = lines_.find(drawing);
  if (found != lines_.end()) return found->second;
  const std::vector<mars::LonLat> outline =
      outline_of(drawing->vertices, drawing->kind == DrawingKind::kPolygon);
  return lines_.emplace(drawing, ground_line(outline, GroundView(session, session.view()))).first->second;
}

void DrawingMarks::draw(ImDrawList& list, const explore::Session& session, const DrawingScene& scene,
                        const EyeImage& eye) {
  const double exaggeration = session.settings().values().exaggeration;
  if (exaggeration != exaggeration_) lines_.clear();
  exaggeration_ = exaggeration;
  // Drawings that were edited or deleted leave lines behind.
  if (lines_.size() > 2 * scene.drawings.size() + 50) lines_.clear();
  DrawingMarker marker(list, session, eye);
  marker.share_casts(scene.drawings.size() + 1);
  const float size = ImGui::GetFontSize() * 0.22F;
  for (const explore::Drawings::Shared& drawing : scene.drawings) {
    if (!drawing->visible) continue;
    const float vertex_size = drawing->id == scene.selected ? 1.5F * size : size;
    if (drawing->kind != DrawingKind::kPoint) marker.line(line_of(drawing, session), drawing->colour);
    if (drawing->vertices.size() > DrawingMarkLimits::kNamedVertices) continue;
    for (std::size_t n = 0; n < drawing->vertices.size(); ++n)
      marker.vertex(marker.on_ground(mars::direction(drawing->vertices[n])), drawing->colour, vertex_size,
                    n == 0 ? drawing->name : "");
  }
  if (scene.unfinished.empty()) return;
  std::vector<mars::LonLat> sketch(scene.unfinished.begin(), scene.unfinished.end());
  if (scene.cursor) sketch.push_back(*scene.cursor);
  marker.line(ground_line(outline_of(sketch, scene.is_polygon), marker), scene.colour);
  for (const mars::LonLat place : scene.unfinished)
    marker.vertex(marker.on_ground(mars::direction(place)), scene.colour, 1.5F * size, "");
}

void draw_on_map(ImDrawList& list, const explore::MapView& map, const DrawingScene& scene, double x0,
                 double y0) {
  const float size = ImGui::GetFontSize() * 0.2F;
  std::vector<ImVec2> points;
  const auto draw_line = [&](std::span<const mars::LonLat> outline, base::Rgb colour) {
    for (const std::vector<glm::dvec2>& piece : explore::map_line(map, outline)) {
      points.clear();
      for (const glm::dvec2 p : piece) points.push_back(vec_of(x0 + p.x, y0 + p.y));
      list.AddPolyline(points.data(), static_cast<int>(points.size()), IM_COL32(0, 0, 0, 160), 0, 3);
      list.AddPolyline(points.data(), static_cast<int>(points.size()), colour_of(colour, 255), 0, 1.5F);
    }
  };
  const auto draw_vertex = [&](mars::LonLat place, base::Rgb colour, float vertex_size) {
    const glm::dvec2 p = map.position(place);
    list.AddCircleFilled(vec_of(x0 + p.x, y0 + p.y), vertex_size + 1, IM_COL32(0, 0, 0, 160));
    list.AddCircleFilled(vec_of(x0 + p.x, y0 + p.y), vertex_size, colour_of(colour, 255));
  };
  for (const explore::Drawings::Shared& drawing : scene.drawings) {
    if (!drawing->visible) continue;
    std::vector<mars::LonLat> outline = outline_of(drawing->vertices, drawing->kind == DrawingKind::kPolygon);
    if (const std::size_t every = 1 + outline.size() / kMostOnMap; every > 1) {
      std::vector<mars::LonLat> few;
      for (std::size_t n = 0; n < outline.size(); n += every) few.push_back(outline[n]);
      few.push_back(outline.back());
      outline = std::move(few);
    }
    draw_line(outline, drawing->colour);
    if (drawing->vertices.size() > DrawingMarkLimits::kNamedVertices) continue;
    const float vertex_size = drawing->id == scene.selected ? 1.5F * size : size;
    for (const mars::LonLat place : drawing->vertices) draw_vertex(place, drawing->colour, vertex_size);
  }
  if (scene.unfinished.empty()) return;
  std::vector<mars::LonLat> sketch(scene.unfinished.begin(), scene.unfinished.end());
  if (scene.cursor) sketch.push_back(*scene.cursor);
  draw_line(outline_of(sketch, scene.is_polygon), scene.colour);
  for (const mars::LonLat place : scene.unfinished) draw_vertex(place, scene.colour, 1.5F * size);
}

}  // namespace vpe::window
