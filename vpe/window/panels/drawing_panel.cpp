#include "vpe/window/panels/drawing_panel.h"

#include <algorithm>
#include <array>

#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/explore/measure/read_out.h"
#include "vpe/explore/results/path_results.h"
#include "vpe/explore/results/result_files.h"
#include "vpe/window/panels/file_names.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

using explore::Drawing;
using explore::DrawingKind;
using explore::Drawings;

namespace {

constexpr std::array<std::pair<const char*, DrawingKind>, 3> kTools{
    {{"Point", DrawingKind::kPoint}, {"Line", DrawingKind::kLine}, {"Polygon", DrawingKind::kPolygon}}};

std::string degrees_text(double value_deg, int decimals, const std::optional<double>& error_deg) {
  return base::format_fixed(value_deg, decimals) +
         (error_deg ? " \u00b1 " + base::format_fixed(*error_deg, decimals) : "") + "\u00b0";
}

std::string slope_text(const explore::GroundStatistics& statistics) {
  return "mean " + degrees_text(statistics.mean_slope_deg, 1, {}) + ", 90 % < " +
         degrees_text(statistics.slope_90_deg, 1, {});
}

std::string dip_text(const explore::GroundStatistics& statistics) {
  const auto& plane = statistics.plane;
  if (!plane) return "unknown";
  return degrees_text(plane->dip_deg, 2, plane->dip_error_deg) + " towards " +
         degrees_text(plane->dip_azimuth_deg, 0, {});
}

std::string strike_text(const explore::GroundStatistics& statistics) {
  const auto& plane = statistics.plane;
  return plane ? degrees_text(plane->strike_deg, 0, plane->strike_error_deg) : "unknown";
}

void add_lines(const ValueTable& table, const Drawing& drawing, const MeasuredDrawing& measured,
               const paging::PlanetMeta& meta) {
  for (const explore::ReadOutLine& line :
       explore::drawing_ground_lines({drawing, measured.sphere, *measured.ground, measured.along, meta}))
    table.add(line.label.c_str(), line.text);
}

std::string percent(double share) { return std::to_string(static_cast<int>(share * 100)) + " % measured"; }

}  // namespace

DrawingPanel::DrawingPanel(explore::FlightController& flights, std::shared_ptr<const paging::Surface> surface,
                           std::filesystem::path folder, std::function<void()> notify)
    : surface_(std::move(surface)),
      folder_(std::move(folder)),
      notify_(std::move(notify)),
      sketch_(drawings_),
      flight_undo_(flights),
      measurer_(std::make_unique<DrawingMeasurer>(surface_, notify_)) {
  history_.join(drawings_);
  history_.join(flight_undo_);
}

void DrawingPanel::set_surface(std::shared_ptr<const paging::Surface> surface) {
  surface_ = std::move(surface);
  marks_.clear();
  measurer_ = std::make_unique<DrawingMeasurer>(surface_, notify_);
}

void DrawingPanel::report(const std::string& problem) {
  if (problem.empty()) return;
  actions_.message = problem;
  actions_.message_is_error = true;
}

void DrawingPanel::tell(const std::string& text) {
  actions_.message = text;
  actions_.message_is_error = false;
}

void DrawingPanel::draw(Widgets& widgets) {
  shown_frame_ = ImGui::GetFrameCount();
  begin_part("draw");
  draw_tools(widgets);
  draw_list(widgets);
  const Drawings::Shared selected = drawings_.find(sketch_.selected());
  measurer_->request(selected);
  if (selected) draw_selected(*selected, widgets);
  draw_files(widgets);
  ImGui::EndChild();
}

void DrawingPanel::draw_tools(Widgets& widgets) {
  for (const auto& [label, kind] : kTools) {
    bool is_chosen = sketch_.tool() == kind;
    if (widgets.toggle(
            label, is_chosen,
            "Click in the view or on the map. Double click or Enter ends, Backspace takes a vertex back, "
            "Esc cancels."))
      sketch_.choose(is_chosen ? std::optional(kind) : std::nullopt);
    ImGui::SameLine();
  }
  const std::string undo_text = history_.undo_text();
  const std::string redo_text = history_.redo_text();
  if (widgets.button("Undo##drawings", ("Ctrl+Z: " + undo_text).c_str())) undo(false);
  ImGui::SameLine();
  if (widgets.button("Redo##drawings", ("Ctrl+Shift+Z: " + redo_text).c_str())) undo(true);
  if (!abandoned_.empty() &&
      widgets.button("Restore##drawings", ("add the unsaved drawings " + abandoned_.front().string()).c_str()))
    actions_.restore = abandoned_.front();
  if (!sketch_.unfinished().empty())
    ImGui::TextDisabled("%d vertices; Enter ends", static_cast<int>(sketch_.unfinished().size()));
  else
    ImGui::TextDisabled("%s", sketch_.tool() ? "Click to place a vertex." : "Drag a vertex to move it.");
}

void DrawingPanel::draw_list(Widgets& widgets) {
  begin_part("drawings", ImVec2(0, ImGui::GetFrameHeightWithSpacing() * 5), true);
  // The list may change while it is drawn.
  const std::vector<Drawings::Shared> all(drawings_.all().begin(), drawings_.all().end());
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(all.size()));
  while (clipper.Step()) {
    for (int n = clipper.DisplayStart; n < clipper.DisplayEnd; ++n) {
      const Drawing& drawing = *all[static_cast<std::size_t>(n)];
      ImGui::PushID(static_cast<int>(drawing.id));
      bool visible = drawing.visible;
      if (ImGui::Checkbox("##visible", &visible)) report(drawings_.show(drawing.id, visible));
      widgets.record("visible " + drawing.name);
      ImGui::SameLine();
      const bool is_mixing = mixing_ && mixing_->first == drawing.id;
      const base::Rgb shown = is_mixing ? mixing_->second : drawing.colour;
      std::array<float, 3> colour{static_cast<float>(shown.r) / 255, static_cast<float>(shown.g) / 255,
                                  static_cast<float>(shown.b) / 255};
      if (ImGui::ColorEdit3("##colour", colour.data(), ImGuiColorEditFlags_NoInputs)) {
        const auto byte = [](float x) {
          return static_cast<std::uint8_t>(std::clamp(x, 0.0F, 1.0F) * 255 + 0.5F);
        };
        mixing_ = {drawing.id, base::Rgb{byte(colour[0]), byte(colour[1]), byte(colour[2])}};
      }
      widgets.record("colour " + drawing.name);
      // A colour is one step once it is chosen.
      if (is_mixing && !ImGui::IsAnyItemActive()) {
        report(drawings_.recolour(drawing.id, mixing_->second));
        sketch_.set_colour(mixing_->second);
        mixing_.reset();
      }
      ImGui::SameLine();
      if (ImGui::Selectable(drawing.name.c_str(), drawing.id == sketch_.selected())) sketch_.select(drawing.id);
      widgets.record("drawing " + drawing.name);
      ImGui::PopID();
    }
  }
  ImGui::EndChild();
}

void DrawingPanel::draw_selected(const Drawing& drawing, Widgets& widgets) {
  ImGui::PushID(static_cast<int>(drawing.id));
  std::string name = drawing.name;
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 3);
  if (widgets.text("Name", name)) report(drawings_.rename(drawing.id, name));
  const auto at = std::find_if(drawings_.all().begin(), drawings_.all().end(),
                               [&drawing](const Drawings::Shared& d) { return d->id == drawing.id; });
  const auto position = static_cast<std::size_t>(at - drawings_.all().begin());
  if (widgets.button("Delete##drawing")) report(drawings_.remove(drawing.id));
  ImGui::SameLine();
  ImGui::BeginDisabled(position == 0);
  if (widgets.button("Up", "earlier in the list; later ones are drawn over earlier ones"))
    report(drawings_.reorder(drawing.id, position - 1));
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(position + 1 >= drawings_.size());
  if (widgets.button("Down", "later in the list")) report(drawings_.reorder(drawing.id, position + 1));
  ImGui::EndDisabled();
  draw_measures(drawing);
  draw_results(drawing, widgets);
  draw_vertices(drawing, widgets);
  ImGui::PopID();
}

void DrawingPanel::draw_measures(const Drawing& drawing) {
  const MeasuredDrawing* m = measurer_->measured();
  const std::string waiting = m == nullptr ? percent(measurer_->progress()) : "unknown";
  const ValueTable table("measures");
  const auto ground = [&](const auto& text) { return m != nullptr && m->ground ? text(*m->ground) : waiting; };
  const auto height = [](double height_m) { return base::format_display(height_m, 1) + " m"; };
  if (drawing.kind == DrawingKind::kPoint) {
    table.add("Place", base::format_display(drawing.vertices[0].lon_deg, 6) + ", " +
                           base::format_display(drawing.vertices[0].lat_deg, 6));
    table.add("Elevation", ground([&](const explore::GroundMeasures& g) { return height(g.lowest_m); }));
    if (m != nullptr && m->ground) add_lines(table, drawing, *m, surface_->planet().meta());
    return;
  }
  const bool is_polygon = drawing.kind == DrawingKind::kPolygon;
  table.add(is_polygon ? "Outline" : "Great circle",
            m != nullptr ? explore::measured_length_text(m->sphere.length_m) : waiting);
  table.add("Over ground",
            ground([](const explore::GroundMeasures& g) { return explore::measured_length_text(g.length_m); }));
  table.add("Lowest", ground([&](const explore::GroundMeasures& g) { return height(g.lowest_m); }));
  table.add("Highest", ground([&](const explore::GroundMeasures& g) { return height(g.highest_m); }));
  if (is_polygon) {
    if (m != nullptr && !m->sphere.area_m2) {
      table.add("Area", m->sphere.no_area);
    } else {
      table.add("Area", m != nullptr ? explore::measured_area_text(*m->sphere.area_m2) : waiting);
      table.add("Area of ground", ground([](const explore::GroundMeasures& g) {
                  if (!g.area) return std::string("unknown");
                  std::string text = explore::measured_area_text(g.area->area_m2);
                  if (g.area->is_exact) return text;
                  return text + " at posts of " + explore::measured_length_text(g.area->spacing_m) +
                         "; twice as far apart: " + explore::measured_area_text(g.area->coarser_area_m2);
                }));
      const auto statistics = [&](const auto& text) {
        return ground([&](const explore::GroundMeasures& g) {
          return g.statistics ? text(*g.statistics) : std::string("unknown");
        });
      };
      table.add("Slope", statistics(slope_text));
      table.add("Dip", statistics(dip_text));
      table.add("Strike", statistics(strike_text));
      table.add("Above the rim", statistics([](const explore::GroundStatistics& s) {
                  return s.over_rim ? explore::measured_volume_text(s.over_rim->above_m3) : "unknown";
                }));
      table.add("Below the rim", statistics([](const explore::GroundStatistics& s) {
                  return s.over_rim ? explore::measured_volume_text(s.over_rim->below_m3) : "unknown";
                }));
    }
  }
  if (m != nullptr && m->ground) add_lines(table, drawing, *m, surface_->planet().meta());
  if (m != nullptr && !m->error.empty()) table.add("", m->error);
}

// Draws buttons that save and copy what was measured.
void DrawingPanel::draw_results(const Drawing& drawing, Widgets& widgets) {
  const MeasuredDrawing* m = measurer_->measured();
  const bool is_measured = m != nullptr && m->ground.has_value();
  ImGui::BeginDisabled(!is_measured);
  const bool saves = widgets.button("Save measures",
                                    "beside the file below, its name with -measures: .geojson, .gpkg or .csv");
  ImGui::SameLine();
  const bool copies = widgets.button("Copy measures", "as text");
  ImGui::EndDisabled();
  if (!is_measured || !(saves || copies)) return;
  const explore::DrawingResults results{drawing, m->sphere, *m->ground, m->along, surface_->planet().meta()};
  if (saves) return save_results(results);
  ImGui::SetClipboardText(explore::drawing_text(results).c_str());
  tell("the measures are copied");
}

void DrawingPanel::save_results(const explore::DrawingResults& results) {
  try {
    std::filesystem::path path = file("");
    const std::string extension = path.has_extension() ? path.extension().string() : ".geojson";
    path.replace_filename(path.stem().string() + "-measures" + extension);
    const mars::FeatureLayer layer = explore::drawing_layer(results);
    explore::write_result(path, layer, explore::result_info("measure: a drawing on the ground", results.meta),
                          explore::csv_of_layer(layer));
    tell("measures: " + path.string());
  } catch (const std::exception& e) {
    report(e.what());
  }
}

void DrawingPanel::draw_vertices(const Drawing& drawing, Widgets& widgets) {
  if (drawing.kind == DrawingKind::kPoint) return;
  begin_part("vertices", ImVec2(0, ImGui::GetFrameHeightWithSpacing() * 4), true);
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(drawing.vertices.size()));
  while (clipper.Step()) {
    for (int n = clipper.DisplayStart; n < clipper.DisplayEnd; ++n) {
      const auto index = static_cast<std::size_t>(n);
      const std::string number = std::to_string(n + 1);
      const mars::LonLat place = drawing.vertices[index];
      if (widgets.button(("x##vertex " + number).c_str(), "remove this vertex"))
        report(drawings_.remove_vertex(drawing.id, index));
      ImGui::SameLine();
      const bool is_last = index + 1 == drawing.vertices.size();
      ImGui::BeginDisabled(is_last && drawing.kind == DrawingKind::kLine);
      if (widgets.button(("+##vertex " + number).c_str(),
                         "insert a vertex in the middle of the edge after it")) {
        const mars::LonLat next = drawing.vertices[is_last ? 0 : index + 1];
        const glm::dvec3 middle = mars::slerp(mars::direction(place), mars::direction(next), 0.5);
        report(drawings_.insert_vertex(drawing.id, index + 1, mars::lon_lat(middle)));
      }
      ImGui::EndDisabled();
      ImGui::SameLine();
      ImGui::Text("%d  %s, %s", n + 1, base::format_display(place.lon_deg, 5).c_str(),
                  base::format_display(place.lat_deg, 5).c_str());
    }
  }
  ImGui::EndChild();
}

void DrawingPanel::draw_files(Widgets& widgets) {
  ImGui::Separator();
  ImGui::SetNextItemWidth(-1);
  widgets.text("##drawing file", file_, "file to write or to open; ~/ is the home folder");
  if (widgets.button("Save GeoJSON")) save_geojson();
  ImGui::SameLine();
  if (widgets.button("Save CSV##drawings", "a line for each vertex, with the elevation")) save_csv();
  ImGui::SameLine();
  if (widgets.button("Open##drawings", "add the drawings of a GeoJSON file")) open();
  if (widgets.button("Save project", "Ctrl+S: view, settings, drawings, bookmarks and flight in one file"))
    actions_.saves_project = true;
}

// Returns the file with this extension, or as it is typed if that is empty.
std::filesystem::path DrawingPanel::file(const char* extension) const {
  std::filesystem::path path = in_home(file_.empty() ? "drawings.geojson" : file_);
  if (path.is_relative()) path = folder_ / path;
  if (*extension != '\0') path.replace_extension(extension);
  return path;
}

void DrawingPanel::save_geojson() {
  try {
    const std::filesystem::path path = file(file_.ends_with(".json") ? ".json" : ".geojson");
    const paging::PlanetMeta& meta = surface_->planet().meta();
    base::write_file(path, explore::to_geojson(drawings_.all(), {meta.body, meta.radius_m}));
    drawings_.mark_saved();
    tell("drawings: " + path.string());
  } catch (const std::exception& e) {
    report(e.what());
  }
}

void DrawingPanel::save_csv() {
  try {
    const std::filesystem::path path = file(".csv");
    base::write_file(path,
                     explore::to_csv(drawings_.all(), [this](mars::LonLat place) -> std::optional<double> {
                       const paging::SurfacePoint point = surface_->at(mars::direction(place));
                       return point.nodata ? std::nullopt : std::optional(point.height_m);
                     }));
    tell("vertices of the drawings: " + path.string());
  } catch (const std::exception& e) {
    report(e.what());
  }
}

void DrawingPanel::open() {
  try {
    const std::filesystem::path path = file("");
    const std::vector<std::uint8_t> bytes = base::read_file(path, explore::DrawingFileLimits::kMostBytes);
    explore::ParsedGeoJson parsed =
        explore::parse_geojson({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path.string());
    if (!parsed.error.empty()) return report(parsed.error);
    const std::string& body = surface_->planet().meta().body;
    if (parsed.planet && parsed.planet->body != body)
      return report(path.string() + ": these are drawings on " + parsed.planet->body + ", and the planet is " +
                    body);
    const std::size_t count = parsed.drawings.size();
    const std::string problem =
        drawings_.add_all(std::move(parsed.drawings), "open " + path.filename().string());
    if (!problem.empty()) return report(problem);
    std::string text = std::to_string(count) + " drawings from " + path.string();
    for (const std::string& note : parsed.notes) text += "; " + note;
    tell(text);
  } catch (const std::exception& e) {
    report(e.what());
  }
}

}  // namespace vpe::window
