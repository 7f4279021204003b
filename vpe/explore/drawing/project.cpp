#include "vpe/explore/drawing/project.h"

#include <array>
#include <stdexcept>
#include <system_error>

#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/explore/files/toml_text.h"

namespace vpe::explore {

namespace fs = std::filesystem;

namespace {

std::string path_text(const fs::path& path, const fs::path& folder) {
  fs::path written = path;
  if (!path.empty() && path.is_absolute()) {
    const fs::path below = path.lexically_normal().lexically_relative(folder.lexically_normal());
    if (!below.empty() && *below.begin() != ".." && below != ".") written = below;
  }
  std::string text = toml_string(written.generic_string());
  if (text == "\"\"" && !path.empty())
    throw std::invalid_argument("a project file cannot name " + path.string() + ": the name is not UTF-8");
  return text;
}

std::string pose_text(const mars::Pose& p) {
  std::string text = "[";
  for (const double value : {p.lon_deg, p.lat_deg, p.alt_m, p.yaw_deg, p.pitch_deg, p.roll_deg})
    text += (text.size() > 1 ? ", " : "") + toml_number(value);
  return text + "]";
}

// Returns a text of several lines as a TOML string.
std::string lines_text(const std::string& text) {
  std::string out = "\"\"\"\n";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"\"\"";
}

std::string vertices_text(const std::vector<mars::LonLat>& vertices) {
  std::string text = "[";
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    text += n == 0 ? "" : n % 4 == 0 ? ",\n  " : ", ";
    text += "[" + toml_number(vertices[n].lon_deg) + ", " + toml_number(vertices[n].lat_deg) + "]";
  }
  return text + "]";
}

}  // namespace

bool is_project_file(const fs::path& file) { return file.extension() == ".vpeproj"; }

std::string to_text(const Project& project, const fs::path& folder) {
  const auto truth = [](bool value) { return value ? std::string("true") : std::string("false"); };
  std::string text = "# Project of vpe explore\nformat = " + std::to_string(ProjectLimits::kFormat) +
                     "\nplanet = " + path_text(project.planet, folder) + "\n";
  if (!project.flight.empty()) text += "flight = " + path_text(project.flight, folder) + "\n";
  if (project.flight_text) text += "flight_text = " + lines_text(scripts::to_text(*project.flight_text)) + "\n";
  if (!project.hotspots.empty()) text += "hotspots = " + path_text(project.hotspots, folder) + "\n";
  text += "\n[view]\n";
  if (project.pose) text += "pose = " + pose_text(*project.pose) + "\n";
  text += "fov_deg = " + toml_number(project.fov_deg) + "\n";
  text += "drawn_by = " + toml_string(std::string(core::to_string(project.drawn_by))) + "\n";
  text += "panels = " + truth(project.panels) + "\nlarge_map = " + truth(project.large_map) + "\n";
  text +=
      std::string("map = ") + (project.map_style == MapStyle::kImagery ? "\"imagery\"\n" : "\"elevation\"\n");
  if (!project.settings.empty()) text += "\n[settings]\n";
  for (const auto& [key, value] : project.settings)
    text += toml_string(key) + " = " + toml_string(value) + "\n";
  for (const core::InterestRegion& r : project.regions) {
    text += "\n[[region]]\nlon_deg = " + toml_number(r.lon_deg) + "\nlat_deg = " + toml_number(r.lat_deg) +
            "\nradius_m = " + toml_number(r.radius_m) + "\nlevels = " + std::to_string(r.levels) + "\n";
  }
  for (const Bookmark& b : project.bookmarks) {
    text += "\n[[bookmark]]\nkey = " + std::to_string(b.key) + "\nname = " + toml_string(b.name) +
            "\npose = " + pose_text(b.view.pose) + "\nfov_deg = " + toml_number(b.view.fov_deg) + "\n";
  }
  for (const Drawing& d : project.drawings) {
    text += "\n[[drawing]]\nkind = " + toml_string(std::string(to_string(d.kind))) +
            "\nname = " + toml_string(d.name) + "\ncolour = " + toml_string(colour_text(d.colour)) +
            "\nvisible = " + truth(d.visible) + "\nvertices = " + vertices_text(d.vertices) + "\n";
  }
  return text;
}

ParsedProject load_project(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = base::read_file(file, ProjectLimits::kMostBytes);
  return parse_project({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
}

void save_project(const Project& project, const fs::path& file) {
  std::error_code ignored;
  const fs::path whole = fs::absolute(file, ignored);
  base::write_file(file, to_text(project, whole.parent_path()));
}

}  // namespace vpe::explore
