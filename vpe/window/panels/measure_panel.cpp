#include "vpe/window/panels/measure_panel.h"

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <system_error>
#include <utility>

#include "mars/geodesy/place_text.h"
#include "paging/planet/planet_meta.h"
#include "vpe/base/number.h"
#include "vpe/explore/measure/sight_text.h"
#include "vpe/explore/results/path_results.h"
#include "vpe/explore/results/result_files.h"
#include "vpe/window/panels/file_names.h"
#include "vpe/window/panels/measure_marks.h"
#include "vpe/window/panels/profile_plot_view.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr const char* kMeasuring = "measuring \u2026";
constexpr double kMostHeight_m = 1e9;

}  // namespace

MeasurePanel::MeasurePanel(std::shared_ptr<const paging::Surface> surface, std::function<void()> notify,
                           explore::OpenScene open_scene)
    : surface_(std::move(surface)),
      notify_(std::move(notify)),
      measurer_(std::make_unique<Measurer>(surface_, notify_, std::move(open_scene))) {}

void MeasurePanel::set_surface(std::shared_ptr<const paging::Surface> surface, explore::OpenScene open_scene) {
  surface_ = std::move(surface);
  measurer_ = std::make_unique<Measurer>(surface_, notify_, std::move(open_scene));
  request();
}

void MeasurePanel::set_scene(explore::SightScene scene) {
  scene_ = std::move(scene);
  if (measured_ && measurer_->is_idle() && !is_of_scene(*measured_)) measure();
}

void MeasurePanel::add(mars::LonLat place) {
  path_.add(place);
  update();
}

void MeasurePanel::begin_at(mars::LonLat place) {
  path_.begin_at(place);
  update();
}

void MeasurePanel::go_on_to(mars::LonLat place, mars::LonLat begin) {
  path_.go_on_to(place, begin);
  update();
}

void MeasurePanel::erase(std::size_t index) {
  path_.erase(index);
  update();
}

void MeasurePanel::clear() {
  path_.clear();
  update();
}

void MeasurePanel::update() {
  if (path_.revision() != measured_revision_) request();
  take();
}

std::optional<mars::LonLat> MeasurePanel::marked() const {
  return ImGui::GetFrameCount() - marked_frame_ <= 1 ? marked_ : std::nullopt;
}

void MeasurePanel::request() {
  measured_.reset();
  marked_.reset();
  measurer_->forget();
  wanted_ = 0;
  measured_revision_ = path_.revision();
  if (points().size() >= 2) measure();
}

void MeasurePanel::measure() {
  wanted_ = measurer_->request(
      {{points().begin(), points().end()}, path_.from_height_m(), path_.to_height_m(), scene_});
}

void MeasurePanel::take() {
  std::optional<Measured> next = measurer_->take();
  if (!next || next->number != wanted_) return;
  const bool is_present = is_of_scene(*next);
  // A former scene may be gone by now.
  if (is_present || next->error.empty()) measured_ = std::move(next);
  if (!is_present) measure();
}

bool MeasurePanel::is_of_scene(const Measured& measured) const {
  return explore::is_same_sight(measured.request.scene, measured.moves, scene_);
}

MeasureActions MeasurePanel::draw(const explore::Session& session, std::optional<mars::LonLat> under_cursor,
                                  Widgets& widgets) {
  update();
  MeasureActions actions;
  begin_part("measure");
  if (ImGui::CollapsingHeader("Under the cursor", ImGuiTreeNodeFlags_DefaultOpen))
    draw_read_out(session, under_cursor);
  if (ImGui::CollapsingHeader("Place", ImGuiTreeNodeFlags_DefaultOpen)) draw_place(actions, widgets);
  if (ImGui::CollapsingHeader("Path", ImGuiTreeNodeFlags_DefaultOpen)) {
    draw_points(actions, widgets);
    if (points().size() >= 2) draw_values();
  }
  if (points().size() >= 2) {
    if (ImGui::CollapsingHeader("Line of sight", ImGuiTreeNodeFlags_DefaultOpen)) draw_sight(widgets);
  }
  ImGui::EndChild();
  return actions;
}

void MeasurePanel::draw_read_out(const explore::Session& session, std::optional<mars::LonLat> under_cursor) {
  if (under_cursor) {
    read_out_error_.clear();
    try {
      explore::ReadOut out =
          explore::read_out_at(session.surface(), *under_cursor, session.settings().values().exaggeration);
      // A place on the map has a range only if the camera sees it.
      const glm::dvec3 camera_m = session.view().camera.position_m;
      const glm::dvec3 path = out.point_m - camera_m;
      const double range_m = glm::length(path);
      const double cast_m = range_m > 0 ? session.ground().cast_m(camera_m, path / range_m) : 0;
      if (std::abs(cast_m - range_m) <= 0.01 + 1e-3 * range_m) out.range_m = range_m;
      read_out_ = explore::read_out_lines(out);
    } catch (const std::exception& e) {
      read_out_.clear();
      read_out_error_ = e.what();
    }
  }
  // Of one height, so that what is below stays where it is while the cursor moves.
  begin_part("read-out", ImVec2(0, ImGui::GetTextLineHeightWithSpacing() * 11.5F));
  if (!read_out_error_.empty()) {
    coloured(kErrorColour, read_out_error_);
  } else if (read_out_.empty()) {
    ImGui::TextDisabled("Point at the ground in the view or on the map.");
  } else {
    const ValueTable table("read-out");
    for (const explore::ReadOutLine& line : read_out_) table.add(line.label.c_str(), line.text);
  }
  ImGui::EndChild();
}

void MeasurePanel::draw_place(MeasureActions& actions, Widgets& widgets) {
  ImGui::SetNextItemWidth(-1);
  if (widgets.text(
          "##place", place_text_,
          "Longitude, latitude; also with E, W, N, S, or in degrees, minutes, seconds. Then press Enter.")) {
    std::string fault;
    place_read_ = mars::parse_place(place_text_, fault);
    place_reply_ = place_read_ ? mars::place_text(*place_read_) : fault;
    if (place_text_.empty()) place_reply_.clear();
  }
  if (place_reply_.empty())
    draw_hint("Paste longitude, latitude and press Enter.");
  else
    coloured(place_read_ ? kSuccessColour : kErrorColour, place_reply_);
  ImGui::BeginDisabled(!place_read_);
  if (widgets.button("Go there") && place_read_) actions.go_to = place_read_;
  ImGui::SameLine();
  if (widgets.button("Add as a point") && place_read_) add(*place_read_);
  ImGui::EndDisabled();
}

void MeasurePanel::draw_points(MeasureActions& actions, Widgets& widgets) {
  actions.undoes = widgets.button("Undo##measure", "Ctrl+Z: the last edit, of points, drawings and all else");
  ImGui::SameLine();
  actions.redoes = widgets.button("Redo##measure", "Ctrl+Shift+Z");
  if (points().empty()) {
    draw_hint("M adds the point under the cursor. Two points make a path.");
    return;
  }
  ImGui::SameLine();
  if (widgets.button("Clear", "remove all points")) clear();
  std::optional<std::size_t> gone;
  for (std::size_t n = 0; n < points().size(); ++n) {
    const std::string name = explore::path_point_name(n);
    if (widgets.button(("x##" + name).c_str(), "remove this point")) gone = n;
    ImGui::SameLine();
    ImGui::Text("%s   %s", name.c_str(), explore::coordinates_text(points()[n]).c_str());
  }
  if (gone) erase(*gone);
}

void MeasurePanel::draw_values() {
  const ValueTable table("figures");
  double arc_rad = 0;
  for (std::size_t n = 1; n < points().size(); ++n) arc_rad += mars::distance_rad(points()[n - 1], points()[n]);
  table.add("Great circle", explore::measured_length_text(arc_rad * surface_->planet_radius_m()));
  const explore::Profile* profile = measured_ ? measured_->profile.get() : nullptr;
  const auto of_profile = [&](const std::string& text) {
    return profile != nullptr ? text : std::string(measured_ ? "unknown" : kMeasuring);
  };
  const explore::Profile none;
  const explore::Profile& p = profile != nullptr ? *profile : none;
  table.add("Over ground", of_profile(explore::measured_length_text(p.ground_length_m)));
  table.add("Lowest", of_profile(base::format_display(p.lowest_m, 1) + " m"));
  table.add("Highest", of_profile(base::format_display(p.highest_m, 1) + " m"));
  if (profile == nullptr) return;
  for (const explore::ReadOutLine& line : explore::ground_lines(measured_->ground, surface_->planet().meta()))
    table.add(line.label.c_str(), line.text);
}

void MeasurePanel::draw_sight(Widgets& widgets) {
  const std::string first = explore::path_point_name(0);
  const std::string last = explore::path_point_name(points().size() - 1);
  double from_height_m = path_.from_height_m();
  double to_height_m = path_.to_height_m();
  ImGui::PushItemWidth(ImGui::GetFontSize() * 5);
  bool changed = widgets.number((first + " (m)##from").c_str(), from_height_m, 0, kMostHeight_m, 0, "%.6g",
                                "height above the ground");
  ImGui::SameLine();
  changed |= widgets.number((last + " (m)##to").c_str(), to_height_m, 0, kMostHeight_m, 0, "%.6g",
                            "height above the ground");
  ImGui::PopItemWidth();
  if (changed) {
    path_.set_heights(from_height_m, to_height_m);
    update();
  }
  if (!measured_) {
    ImGui::TextDisabled("%s", kMeasuring);
    return;
  }
  if (!measured_->sight) {
    coloured(kErrorColour, measured_->error);
    return;
  }
  const explore::LineOfSight& sight = *measured_->sight;
  coloured(sight.visible ? kSuccessColour : kErrorColour,
           sight.visible ? first + " and " + last + " see each other"
                         : first + " and " + last + " do not see each other");
  const ValueTable table("sight");
  const explore::SightEnds ends{first, last, measured_->request.to_height_m,
                                !measured_->request.scene.file.empty()};
  for (const explore::ReadOutLine& line : explore::sight_lines(sight, ends))
    table.add(line.label.c_str(), line.text);
}

MeasureActions MeasurePanel::draw_profile(Widgets& widgets) {
  MeasureActions actions;
  if (points().size() < 2) return actions;
  update();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const double line = static_cast<double>(ImGui::GetFrameHeightWithSpacing());
  const double height = std::max(line, static_cast<double>(room.y) - line);
  if (!measured_ || measured_->profile == nullptr) {
    if (measured_)
      coloured(kErrorColour, measured_->error);
    else
      ImGui::TextDisabled("%s", kMeasuring);
    return actions;
  }
  const explore::Profile& profile = *measured_->profile;
  ProfilePlot plot{profile, surface_->planet_radius_m(), nullptr, path_.from_height_m(), path_.to_height_m()};
  const bool has_sight = measured_->sight && points().size() == 2;
  if (has_sight) plot.sight = &*measured_->sight;
  const std::optional<double> cursor_m = draw_profile_plot(plot, static_cast<double>(room.x), height, widgets);
  marked_.reset();
  marked_frame_ = ImGui::GetFrameCount();
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 10);
  widgets.text("##file", file_, "file to write: .csv, .geojson or .gpkg; ~/ is the home folder");
  ImGui::SameLine();
  if (widgets.button("Save##profile",
                     "the profile as a table (.csv), or path and points as features (.geojson, .gpkg)"))
    save(actions);
  ImGui::SameLine();
  if (widgets.button("Copy##profile", "the figures of path and line of sight as text")) copy(actions);
  ImGui::SameLine();
  if (cursor_m) {
    const paging::ProfilePoint& point = explore::nearest_point(profile, *cursor_m);
    marked_ = point.place;
    ImGui::TextUnformatted((explore::measured_length_text(point.distance_m) + ": " +
                            (point.nodata ? std::string("no data")
                                          : base::format_display(point.height_m, 1) + " m, slope " +
                                                base::format_display(point.slope_deg, 1) + "\u00b0") +
                            "   " + explore::coordinates_text(point.place))
                               .c_str());
  } else {
    ImGui::TextDisabled("above %s, a point every %s; %s",
                        paging::describe_datum(surface_->planet().meta()).c_str(),
                        explore::measured_length_text(profile.step_m).c_str(),
                        has_sight ? "with the line of sight" : "the line of sight does not follow this path");
  }
  return actions;
}

void MeasurePanel::save(MeasureActions& actions) const {
  actions.message_is_error = true;
  if (file_.empty()) {
    actions.message = "enter a file name for the profile";
    return;
  }
  try {
    const std::filesystem::path path = in_home(file_);
    std::error_code ignored;
    const bool existed = std::filesystem::exists(path, ignored);
    const paging::PlanetMeta& meta = surface_->planet().meta();
    const explore::Profile& profile = *measured_->profile;
    explore::write_result(path,
                          explore::profile_layer(explore::profile_json(profile, measured_->ground, meta),
                                                 measured_->request.places),
                          explore::result_info("profile: the ground along great circles", meta),
                          explore::to_csv(profile));
    const std::filesystem::path whole = std::filesystem::absolute(path, ignored);
    actions.message = (existed ? "profile replaced: " : "profile saved: ") + (ignored ? path : whole).string();
    actions.message_is_error = false;
  } catch (const std::exception& e) {
    actions.message = e.what();
  }
}

std::string MeasurePanel::results_text() const {
  std::vector<explore::ReadOutLine> lines;
  for (std::size_t n = 0; n < points().size(); ++n)
    lines.push_back({explore::path_point_name(n), explore::coordinates_text(points()[n])});
  const explore::Profile& profile = *measured_->profile;
  const auto height = [](double height_m) { return base::format_display(height_m, 1) + " m"; };
  lines.push_back({"Great circle", explore::measured_length_text(profile.length_m)});
  lines.push_back({"Over ground", explore::measured_length_text(profile.ground_length_m)});
  lines.push_back({"Lowest", height(profile.lowest_m)});
  lines.push_back({"Highest", height(profile.highest_m)});
  if (measured_->sight) {
    const std::string first = explore::path_point_name(0);
    const std::string last = explore::path_point_name(points().size() - 1);
    lines.push_back(
        {"Line of sight",
         first + " and " + last + (measured_->sight->visible ? " see each other" : " do not see each other")});
    const explore::SightEnds ends{first, last, measured_->request.to_height_m,
                                  !measured_->request.scene.file.empty()};
    for (explore::ReadOutLine& line : explore::sight_lines(*measured_->sight, ends))
      lines.push_back(std::move(line));
  }
  for (explore::ReadOutLine& line : explore::ground_lines(measured_->ground, surface_->planet().meta()))
    lines.push_back(std::move(line));
  return explore::text_of_lines(lines);
}

void MeasurePanel::copy(MeasureActions& actions) const {
  ImGui::SetClipboardText(results_text().c_str());
  actions.message = "the figures are copied";
}

void MeasurePanel::draw_marks(ImDrawList& list, const explore::Session& session, const EyeImage& eye) {
  take();
  draw_measure_marks(list, session, {points(), measured_ ? measured_->profile.get() : nullptr, marked()}, eye);
}

}  // namespace vpe::window
