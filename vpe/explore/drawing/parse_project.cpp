// Reading of project files.
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "vpe/base/number.h"
#include "vpe/base/quote.h"
#include "vpe/base/toml_table.h"
#include "vpe/core/appearance/settings.h"
#include "vpe/core/view.h"
#include "vpe/explore/drawing/project.h"

namespace vpe::explore {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kMostShownBytes = 200;  // of a value in a message

std::string shown_value(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (node.is_array() && node.as_array()->size() > 8)
    return "a list of " + std::to_string(node.as_array()->size());
  std::ostringstream out;
  node.visit([&out](const auto& value) { out << value; });
  return base::quote_text(std::move(out).str().substr(0, kMostShownBytes));
}

std::optional<double> finite_number(const toml::node& node) {
  if (const auto* value = node.as_floating_point(); value != nullptr && std::isfinite(value->get()))
    return value->get();
  if (const auto* value = node.as_integer()) return static_cast<double>(value->get());
  return std::nullopt;
}

std::string joined(std::initializer_list<std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

class ProjectReader {
 public:
  ProjectReader(const fs::path& file, ParsedProject& out) : file_(file), out_(out) {
    std::error_code ignored;
    folder_ = fs::absolute(file, ignored).parent_path();
  }

  void read(std::string_view text) {
    toml::table top;
    try {
      top = base::parse_toml(text, file_.string(), /*has_long_texts=*/true);
    } catch (const std::runtime_error& e) {
      out_.errors.emplace_back(e.what());
      return;
    }
    const toml::node* format = top.get("format");
    if (format == nullptr) {
      out_.errors.push_back(file_.string() + ":1: expected 'format = 1', as in every project file");
      return;
    }
    if (!format->is_integer() || format->as_integer()->get() != ProjectLimits::kFormat) {
      fault(*format, "expected format = " + std::to_string(ProjectLimits::kFormat) + ", found " +
                         shown_value(*format) + "; a newer vpe reads newer formats");
      return;
    }
    known(top, "a project",
          {"format", "planet", "flight", "flight_text", "hotspots", "view", "settings", "region", "bookmark",
           "drawing"});
    path(top, "planet", project_.planet);
    path(top, "flight", project_.flight);
    path(top, "hotspots", project_.hotspots);
    read_flight(top);
    read_view(top);
    read_settings(top);
    each(top, "region", ProjectLimits::kMostRegions, [this](const toml::table& t) { read_region(t); });
    each(top, "bookmark", ProjectLimits::kMostBookmarks, [this](const toml::table& t) { read_bookmark(t); });
    each(top, "drawing", DrawingLimits::kMostDrawings, [this](const toml::table& t) { read_drawing(t); });
    if (out_.errors.empty()) out_.project = std::move(project_);
  }

 private:
  void fault(const toml::node& node, const std::string& what) {
    if (out_.errors.size() < ProjectLimits::kMostErrors)
      out_.errors.push_back(file_.string() + ":" + std::to_string(node.source().begin.line) + ": " + what);
  }

  void known(const toml::table& table, const std::string& where, std::initializer_list<std::string_view> keys) {
    for (const auto& [key, node] : table) {
      if (std::find(keys.begin(), keys.end(), key.str()) == keys.end())
        fault(node,
              "unknown key " + base::quote_text(key.str()) + "; keys of " + where + " are " + joined(keys));
    }
  }

  void text(const toml::table& table, const char* key, std::string& out) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    if (node->is_string())
      out = node->as_string()->get();
    else
      fault(*node, std::string(key) + ": expected a text in quotes, found " + shown_value(*node));
  }
  void truth(const toml::table& table, const char* key, bool& out) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    if (node->is_boolean())
      out = node->as_boolean()->get();
    else
      fault(*node, std::string(key) + ": expected true or false, found " + shown_value(*node));
  }
  void number(const toml::table& table, const char* key, double low, double high, double& out) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    const std::optional<double> value = finite_number(*node);
    if (value && *value >= low && *value <= high)
      out = *value;
    else
      fault(*node, std::string(key) + ": expected a number from " + base::format_number(low) + " to " +
                       base::format_number(high) + ", found " + shown_value(*node));
  }
  void integer(const toml::table& table, const char* key, int low, int high, int& out) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    const auto* value = node->as_integer();
    if (value != nullptr && value->get() >= low && value->get() <= high)
      out = static_cast<int>(value->get());
    else
      fault(*node, std::string(key) + ": expected an integer from " + std::to_string(low) + " to " +
                       std::to_string(high) + ", found " + shown_value(*node));
  }
  template <class Value>
  void choice(const toml::table& table, const char* key, Value& out,
              std::initializer_list<std::pair<std::string_view, Value>> words) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return;
    std::string allowed;
    for (const auto& [word, value] : words) {
      if (node->is_string() && node->as_string()->get() == word) {
        out = value;
        return;
      }
      allowed += (allowed.empty() ? "\"" : ", \"") + std::string(word) + "\"";
    }
    fault(*node, std::string(key) + ": expected one of " + allowed + ", found " + shown_value(*node));
  }
  void path(const toml::table& table, const char* key, fs::path& out) {
    std::string name;
    text(table, key, name);
    if (!name.empty()) out = (folder_ / name).lexically_normal();
  }

  // Checks the view with the limits of bookmarks.
  std::optional<mars::Pose> pose(const toml::table& table, double fov_deg) {
    const toml::node* node = table.get("pose");
    if (node == nullptr) return std::nullopt;
    mars::Pose pose;
    const std::array<double*, 6> fields{&pose.lon_deg, &pose.lat_deg,   &pose.alt_m,
                                        &pose.yaw_deg, &pose.pitch_deg, &pose.roll_deg};
    const toml::array* list = node->as_array();
    bool is_good = list != nullptr && list->size() == fields.size();
    for (std::size_t n = 0; is_good && n < fields.size(); ++n) {
      const std::optional<double> value = finite_number((*list)[n]);
      is_good = value.has_value();
      if (is_good) *fields[n] = *value;
    }
    if (!is_good) {
      fault(*node,
            "pose: expected [longitude, latitude, altitude, yaw, pitch, roll], found " + shown_value(*node));
      return std::nullopt;
    }
    if (const std::string problem = problem_of(SavedView{pose, fov_deg}); !problem.empty()) {
      fault(*node, "pose: " + problem);
      return std::nullopt;
    }
    return pose;
  }

  template <class Read>
  void each(const toml::table& top, const char* key, std::size_t most, Read&& read_one) {
    const toml::node* node = top.get(key);
    if (node == nullptr) return;
    const toml::array* list = node->as_array();
    if (list == nullptr) return fault(*node, std::string(key) + ": expected [[" + key + "]]");
    if (list->size() > most)
      return fault((*list)[most], "expected at most " + std::to_string(most) + " of [[" + key + "]], found " +
                                      std::to_string(list->size()));
    for (const toml::node& entry : *list) {
      if (const toml::table* table = entry.as_table())
        read_one(*table);
      else
        fault(entry, std::string(key) + ": expected [[" + key + "]]");
    }
  }

  void read_flight(const toml::table& top) {
    std::string lines;
    text(top, "flight_text", lines);
    if (lines.empty()) return;
    const toml::node& node = *top.get("flight_text");
    if (!project_.flight.empty()) return fault(node, "expected either flight or flight_text, found both");
    // The text begins on the line after its quotes.
    scripts::ParsedFlight parsed = scripts::parse_flight(lines, file_.string());
    for (scripts::FlightError& error : parsed.errors) {
      error.line += static_cast<int>(node.source().begin.line);
      if (out_.errors.size() < ProjectLimits::kMostErrors) out_.errors.push_back(scripts::to_string(error));
    }
    project_.flight_text = std::move(parsed.flight);
  }

  void read_view(const toml::table& top) {
    const toml::node* node = top.get("view");
    if (node == nullptr) return;
    const toml::table* view = node->as_table();
    if (view == nullptr) return fault(*node, "expected a table [view]");
    known(*view, "[view]", {"pose", "fov_deg", "drawn_by", "panels", "large_map", "map"});
    number(*view, "fov_deg", core::ViewLimits::kMinFov_deg, core::ViewLimits::kMaxFov_deg, project_.fov_deg);
    project_.pose = pose(*view, project_.fov_deg);
    choice<core::DrawnBy>(
        *view, "drawn_by", project_.drawn_by,
        {{"auto", core::DrawnBy::kAuto}, {"polygon", core::DrawnBy::kPolygon}, {"ray", core::DrawnBy::kRay}});
    truth(*view, "panels", project_.panels);
    truth(*view, "large_map", project_.large_map);
    choice<MapStyle>(*view, "map", project_.map_style,
                     {{"elevation", MapStyle::kElevation}, {"imagery", MapStyle::kImagery}});
  }

  void read_settings(const toml::table& top) {
    const toml::node* node = top.get("settings");
    if (node == nullptr) return;
    const toml::table* table = node->as_table();
    if (table == nullptr) return fault(*node, "expected a table [settings]");
    core::Settings settings;
    for (const auto& [key, value] : *table) {
      const std::string name(key.str());
      if (!value.is_string()) {
        fault(value, name + ": expected the value as a text in quotes, found " + shown_value(value) +
                         (value.is_table() ? "; keys with dots stand in quotes too" : ""));
        continue;
      }
      if (const std::string problem = settings.set(name, value.as_string()->get()); !problem.empty())
        fault(value, problem);
      else
        project_.settings.emplace_back(name, value.as_string()->get());
    }
  }

  void need(const toml::table& table, const char* what, std::initializer_list<std::string_view> keys) {
    for (const std::string_view key : keys)
      if (!table.contains(key)) fault(table, std::string("[[") + what + "]] needs the key " + std::string(key));
  }

  void read_region(const toml::table& table) {
    known(table, "[[region]]", {"lon_deg", "lat_deg", "radius_m", "levels"});
    need(table, "region", {"lon_deg", "lat_deg", "radius_m", "levels"});
    core::InterestRegion region;
    number(table, "lon_deg", -360, 360, region.lon_deg);
    number(table, "lat_deg", -90, 90, region.lat_deg);
    number(table, "radius_m", 0, core::InterestLimits::kMaxRadius_m, region.radius_m);
    integer(table, "levels", -core::InterestLimits::kMaxLevels, core::InterestLimits::kMaxLevels,
            region.levels);
    project_.regions.push_back(region);
  }

  void read_bookmark(const toml::table& table) {
    known(table, "[[bookmark]]", {"key", "name", "pose", "fov_deg"});
    need(table, "bookmark", {"pose"});
    Bookmark bookmark;
    integer(table, "key", 0, 9, bookmark.key);
    text(table, "name", bookmark.name);
    number(table, "fov_deg", core::ViewLimits::kMinFov_deg, core::ViewLimits::kMaxFov_deg,
           bookmark.view.fov_deg);
    const std::size_t before = out_.errors.size();
    if (const auto at = pose(table, bookmark.view.fov_deg)) bookmark.view.pose = *at;
    if (out_.errors.size() != before) return;
    Bookmarks checked;
    for (const Bookmark& other : project_.bookmarks) {
      if (bookmark.key != 0 && other.key == bookmark.key)
        return fault(table, "expected each key once, found " + std::to_string(bookmark.key) + " again");
    }
    if (const std::string problem = checked.put(bookmark); !problem.empty()) return fault(table, problem);
    project_.bookmarks.push_back(std::move(bookmark));
  }

  void read_drawing(const toml::table& table) {
    known(table, "[[drawing]]", {"kind", "name", "colour", "visible", "vertices"});
    need(table, "drawing", {"kind", "vertices"});
    const std::size_t before = out_.errors.size();
    Drawing drawing;
    choice<DrawingKind>(
        table, "kind", drawing.kind,
        {{"point", DrawingKind::kPoint}, {"line", DrawingKind::kLine}, {"polygon", DrawingKind::kPolygon}});
    text(table, "name", drawing.name);
    truth(table, "visible", drawing.visible);
    if (const toml::node* node = table.get("colour")) {
      const auto colour = node->is_string() ? parse_colour(node->as_string()->get()) : std::nullopt;
      if (colour)
        drawing.colour = *colour;
      else
        fault(*node, "colour: expected a text such as \"#ffd65a\", found " + shown_value(*node));
    }
    if (const toml::node* node = table.get("vertices")) read_vertices(*node, drawing.vertices);
    if (out_.errors.size() != before) return;
    if (const std::string problem = problem_of(drawing); !problem.empty()) return fault(table, problem);
    vertices_ += drawing.vertices.size();
    if (vertices_ > DrawingLimits::kMostVerticesOfAll)
      return fault(table, "all drawings together have at most " +
                              std::to_string(DrawingLimits::kMostVerticesOfAll) + " vertices");
    project_.drawings.push_back(std::move(drawing));
  }

  void read_vertices(const toml::node& node, std::vector<mars::LonLat>& out) {
    const toml::array* list = node.as_array();
    if (list == nullptr)
      return fault(node, "vertices: expected [[LONGITUDE, LATITUDE], ...], found " + shown_value(node));
    for (const toml::node& entry : *list) {
      const toml::array* pair = entry.as_array();
      const auto lon = pair != nullptr && pair->size() == 2 ? finite_number((*pair)[0]) : std::nullopt;
      const auto lat = pair != nullptr && pair->size() == 2 ? finite_number((*pair)[1]) : std::nullopt;
      if (!lon || !lat)
        return fault(entry, "vertices: expected [LONGITUDE, LATITUDE], found " + shown_value(entry));
      const mars::LonLat place{mars::normalize_lon_deg(*lon), *lat};
      if (const std::string problem = problem_of_place(place); !problem.empty()) return fault(entry, problem);
      out.push_back(place);
    }
  }

  const fs::path& file_;
  ParsedProject& out_;
  fs::path folder_;
  Project project_;
  std::size_t vertices_ = 0;
};

}  // namespace

ParsedProject parse_project(std::string_view text, const fs::path& file) {
  ParsedProject out;
  if (text.size() > ProjectLimits::kMostBytes)
    out.errors.push_back(file.string() + ":1: expected at most " +
                         std::to_string(ProjectLimits::kMostBytes >> 20U) + " MiB");
  else
    ProjectReader(file, out).read(text);
  return out;
}

}  // namespace vpe::explore
