#include "vpe/window/panels/profile_plot_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vpe/base/nice_ticks.h"
#include "vpe/base/number.h"
#include "vpe/explore/results/measure_path.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr ImU32 kSky = IM_COL32(30, 33, 38, 255);
constexpr ImU32 kGround = IM_COL32(104, 66, 44, 255);
constexpr ImU32 kProfileBand = IM_COL32(150, 102, 72, 255);
constexpr ImU32 kNoData = IM_COL32(70, 72, 76, 255);
constexpr ImU32 kLine = IM_COL32(240, 205, 170, 255);
constexpr ImU32 kGrid = IM_COL32(255, 255, 255, 34);
constexpr ImU32 kText = IM_COL32(196, 198, 202, 255);
constexpr ImU32 kSeen = IM_COL32(120, 225, 130, 255);
constexpr ImU32 kHidden = IM_COL32(255, 112, 92, 255);
constexpr ImU32 kCursor = IM_COL32(255, 214, 90, 255);

float thick() { return std::max(1.5F, ImGui::GetFontSize() / 9); }

struct Unit {
  double metres;
  const char* name;
};
Unit unit_of(double length_m) { return length_m >= 10000 ? Unit{1000, "km"} : Unit{1, "m"}; }

// Range of elevations shown: those of the ground and of the ends of the line of sight.
struct Range {
  double low_m;
  double high_m;
};
Range range_of(const ProfilePlot& plot) {
  Range r{plot.profile.lowest_m, plot.profile.highest_m};
  if (plot.sight != nullptr) {
    r.high_m = std::max({r.high_m, plot.profile.points.front().height_m + plot.from_height_m,
                         plot.profile.points.back().height_m + plot.to_height_m});
  }
  const double room_m = std::max(0.5, 0.07 * (r.high_m - r.low_m));
  return {r.low_m - room_m, r.high_m + room_m};
}

// Converts distances and elevations to positions on the screen.
struct Frame {
  double x0, y0, x1, y1;  // of the ground
  double length_m;
  Range range;

  double x(double distance_m) const { return length_m > 0 ? x0 + (x1 - x0) * distance_m / length_m : x0; }
  double y(double height_m) const {
    return y1 - (y1 - y0) * (height_m - range.low_m) / (range.high_m - range.low_m);
  }
};

void draw_axes(ImDrawList& list, const Frame& f, const base::NiceTicks& heights) {
  const double letters = ImGui::GetFontSize();
  for (const double height_m : heights.values) {
    const double y = std::round(f.y(height_m));
    const std::string text = base::format_display(height_m, heights.decimals);
    list.AddLine(at(f.x0, y), at(f.x1, y), kGrid);
    list.AddText(at(f.x0 - 4 - ImGui::CalcTextSize(text.c_str()).x, y - letters / 2), kText, text.c_str());
  }
  const Unit unit = unit_of(f.length_m);
  const base::NiceTicks along = base::nice_ticks(0, f.length_m / unit.metres,
                                                 std::max(2, static_cast<int>((f.x1 - f.x0) / (letters * 4))));
  for (std::size_t n = 0; n < along.values.size(); ++n) {
    const double x = std::round(f.x(along.values[n] * unit.metres));
    std::string text = base::format_display(along.values[n], along.decimals);
    if (n + 1 == along.values.size()) text += std::string(" ") + unit.name;
    const double wide = ImGui::CalcTextSize(text.c_str()).x;
    list.AddLine(at(x, f.y0), at(x, f.y1 + 3), kGrid);
    list.AddText(at(std::min(x - wide / 2, f.x1 - wide), f.y1 + 3), kText, text.c_str());
  }
}

void draw_ground(ImDrawList& list, const Frame& f, const explore::Profile& profile) {
  const int count = std::max(1, static_cast<int>(f.x1 - f.x0));
  const std::vector<explore::PlotColumn> columns = explore::plot_columns(profile, count);
  std::vector<ImVec2> line;
  line.reserve(columns.size() + 1);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const explore::PlotColumn& c = columns[k];
    const double x = f.x0 + static_cast<double>(k);
    list.AddRectFilled(at(x, f.y(c.high_m)), at(x + 1, f.y1), c.nodata ? kNoData : kProfileBand);
    list.AddRectFilled(at(x, f.y(c.low_m)), at(x + 1, f.y1), c.nodata ? kNoData : kGround);
    line.push_back(at(x, f.y(c.begin_m)));
  }
  line.push_back(at(f.x1, f.y(columns.back().end_m)));
  list.AddPolyline(line.data(), static_cast<int>(line.size()), kLine, ImDrawFlags_None, thick());
}

void draw_sight(ImDrawList& list, const Frame& f, const ProfilePlot& plot) {
  const double from_m = plot.profile.points.front().height_m + plot.from_height_m;
  const double to_m = plot.profile.points.back().height_m + plot.to_height_m;
  constexpr int kPieces = 96;
  std::vector<ImVec2> line;
  for (int n = 0; n <= kPieces; ++n) {
    const double t = static_cast<double>(n) / kPieces;
    const double height_m =
        explore::sight_height_m(plot.radius_m, from_m, to_m, plot.sight->arc_m / plot.radius_m, t);
    line.push_back(at(f.x(t * f.length_m), f.y(height_m)));
  }
  const ImU32 colour = plot.sight->visible ? kSeen : kHidden;
  list.AddPolyline(line.data(), static_cast<int>(line.size()), colour, ImDrawFlags_None, thick());
  if (!plot.sight->obstruction) return;
  const double along_m =
      mars::distance_rad(plot.profile.points.front().place, plot.sight->obstruction->place) * plot.radius_m;
  list.AddCircleFilled(at(f.x(along_m), f.y(plot.sight->obstruction->elevation_m)),
                       static_cast<float>(ImGui::GetFontSize() * 0.25), kHidden);
}

void draw_names(ImDrawList& list, const Frame& f, const explore::Profile& profile) {
  std::size_t index = 0;
  double free_from = -1e9;
  for (const paging::ProfilePoint& point : profile.points) {
    if (!point.waypoint) continue;
    const std::string name = explore::path_point_name(index++);
    const double x = f.x(point.distance_m);
    const double wide = ImGui::CalcTextSize(name.c_str()).x;
    list.AddLine(at(x, f.y0), at(x, f.y1), IM_COL32(255, 214, 90, 70));
    const double left = std::clamp(x - wide / 2, f.x0 + 1, f.x1 - wide - 1);
    if (left < free_from) continue;  // would overlap the previous name
    list.AddText(at(left, f.y0), kCursor, name.c_str());
    free_from = left + wide + 2;
  }
}

}  // namespace

std::optional<double> draw_profile_plot(const ProfilePlot& plot, double width, double height,
                                        Widgets& widgets) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("profile plot", at(width, height));
  widgets.record("profile plot");
  const double letters = ImGui::GetFontSize();
  const Range range = range_of(plot);
  const base::NiceTicks heights =
      base::nice_ticks(range.low_m, range.high_m, std::max(2, static_cast<int>(height / (letters * 2))));
  double margin = 0;
  for (const double h : heights.values)
    margin = std::max<double>(margin, ImGui::CalcTextSize(base::format_display(h, heights.decimals).c_str()).x);

  const double left = corner.x;
  const double top = corner.y;
  const Frame f{std::round(left + margin + 6), std::round(top + letters * 1.4),
                std::floor(left + width),      std::round(top + height - letters * 1.3),
                plot.profile.length_m,         range};
  if (f.x1 < f.x0 + 8 || f.y1 < f.y0 + 8) return std::nullopt;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  std::string text = "Elevation (m)";
  if (plot.profile.length_m > 0) {
    const double exaggeration =
        (f.y1 - f.y0) / (range.high_m - range.low_m) * plot.profile.length_m / (f.x1 - f.x0);
    const int digits = exaggeration < 10 ? 1 : 0;
    text += ", exaggerated " + base::format_display(exaggeration, exaggeration < 1 ? 2 : digits) + "x";
  }
  list.AddText(at(left, top), kText, text.c_str());
  list.AddRectFilled(at(f.x0, f.y0), at(f.x1, f.y1), kSky);
  list.PushClipRect(at(f.x0, f.y0), at(f.x1, f.y1), true);
  draw_ground(list, f, plot.profile);
  if (plot.sight != nullptr) draw_sight(list, f, plot);
  draw_names(list, f, plot.profile);
  list.PopClipRect();
  draw_axes(list, f, heights);

  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool over = ImGui::IsItemHovered() && mouse.x >= static_cast<float>(f.x0) &&
                    mouse.x <= static_cast<float>(f.x1) && f.length_m > 0;
  if (!over) return std::nullopt;
  const double distance_m =
      std::clamp((static_cast<double>(mouse.x) - f.x0) / (f.x1 - f.x0), 0.0, 1.0) * f.length_m;
  const paging::ProfilePoint& point = explore::nearest_point(plot.profile, distance_m);
  const double x = f.x(point.distance_m);
  list.AddLine(at(x, f.y0), at(x, f.y1), kCursor);
  list.AddCircleFilled(at(x, f.y(point.height_m)), static_cast<float>(letters * 0.22), kCursor);
  return distance_m;
}

}  // namespace vpe::window
