#include "objects/files/scene_writer.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "objects/files/scene_limits.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/base/quote.h"

namespace objects {

namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 3> kUpWords{"auto", "y", "z"};

// Returns the number as TOML reads it back to the bit. Whole numbers have no point.
std::string toml_number(double value) {
  const std::string text = vpe::base::format_number(value);
  return text == "-0" ? "-0.0" : text;  // a whole number has no sign of zero
}

// Returns the text in quotation marks. `problem` is what the readers say of it.
std::string in_quotes(const std::string& text, const std::string& problem) {
  if (!problem.empty()) throw std::invalid_argument(vpe::base::quote_text(text) + ": " + problem);
  // Three apostrophes would be taken for a text of several lines.
  const bool has_three = text.find("'''") != std::string::npos;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '\'' && has_three) {
      out += "\\u0027";
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  out += '"';
  try {
    (void)toml::parse("a = " + out);
  } catch (const toml::parse_error&) {
    throw std::invalid_argument(vpe::base::quote_text(text) + ": expected a text in UTF-8");
  }
  return out;
}

std::string name_in_quotes(const std::string& name) { return in_quotes(name, problem_of_name(name)); }

// Returns the path of a model in a scene file; model_path() returns the model for it.
std::string path_text(const fs::path& model, const fs::path& scene_file) {
  const fs::path whole = model.lexically_normal();
  fs::path text = fs::absolute(whole).lexically_normal();
  if (whole.is_absolute() == scene_file.is_absolute()) {
    const fs::path folder = scene_file.parent_path().lexically_normal();
    const fs::path relative = whole.lexically_relative(folder.empty() ? fs::path(".") : folder);
    // Not so where the folder begins with "..".
    if (!relative.empty() && model_path(scene_file, relative.string()) == whole) text = relative;
  }
  return in_quotes(text.string(), problem_of_path(text.string()));
}

std::string place_list(const mars::LonLat& place) {
  return toml_number(place.lon_deg) + ", " + toml_number(place.lat_deg);
}

// Returns true for places of one object that differ in nothing but place and heading.
bool is_alike(const Placing& a, const Placing& b) {
  return a.height_kind == b.height_kind && a.height_m == b.height_m && a.pitch_deg == b.pitch_deg &&
         a.roll_deg == b.roll_deg && a.follows_slope == b.follows_slope && a.scale == b.scale;
}

// A member that is added to an entry must be written too: the structured bindings below do not compile until it is.
class SceneTomlWriter {
 public:
  SceneTomlWriter(const SceneFile& scene, const fs::path& file) : file_(file) {
    const auto& [path, models, objects, scatters, paths, posters, kiosks] = scene;
    text_ = "version = 1\n";
    for (const ModelEntry& model : models) model_names_.push_back(name_in_quotes(model.name));
    for (const ModelEntry& model : models) write_model(model);
    for (const ObjectEntry& object : objects) write_object(object);
    for (const PathEntry& entry : paths) write_path(entry);
    for (const ScatterEntry& scatter : scatters) write_scatter(scatter);
    for (const PosterEntry& poster : posters) write_poster(poster);
    for (const KioskEntry& kiosk : kiosks) write_kiosk(kiosk);
  }

  std::string take() { return std::move(text_); }

 private:
  void begin(std::string_view table) { text_ += "\n[[" + std::string(table) + "]]\n"; }
  void add(std::string_view key, const std::string& value) { text_ += std::string(key) + " = " + value + "\n"; }
  void add_number(std::string_view key, double value, double usual) {
    if (value != usual || std::signbit(value) != std::signbit(usual)) add(key, toml_number(value));
  }
  void add_name(const std::string& name) {
    if (!name.empty()) add("name", name_in_quotes(name));
  }
  const std::string& model_name(std::size_t model) const {
    if (model >= model_names_.size()) throw std::invalid_argument("a scene names a model that is not there");
    return model_names_[model];
  }

  void write_model(const ModelEntry& model) {
    const auto& [name, file, unit_m, up, formula] = model;
    if (formula) return write_volume(name, *formula);
    begin("model");
    add("name", name_in_quotes(name));
    add("file", path_text(file, file_));
    add_number("unit_m", unit_m, 1);
    if (up != UpAxis::kAuto) add("up", "\"" + std::string(kUpWords[static_cast<std::size_t>(up)]) + "\"");
  }

  void write_volume(const std::string& name, const VolumeFormula& formula) {
    constexpr std::array<std::string_view, 3> kKinds{"dust-devil", "cloud", "plume"};
    const auto& [kind, height_m, radius_m, optical_depth, lean_m, colour, seed, voxels] = formula;
    begin("volume");
    add("name", name_in_quotes(name));
    add("kind", "\"" + std::string(kKinds[static_cast<std::size_t>(kind)]) + "\"");
    add("height_m", toml_number(height_m));
    add("radius_m", toml_number(radius_m));
    add("optical_depth", toml_number(optical_depth));
    add_number("lean_m", lean_m, 0);
    add("colour", "[" + std::to_string(colour.r) + ", " + std::to_string(colour.g) + ", " +
                      std::to_string(colour.b) + "]");
    add("seed", std::to_string(seed));
    add("voxels", std::to_string(voxels));
  }

  void write_object(const ObjectEntry& object) {
    const auto& [name, model, places, interest_levels, ground] = object;
    for (std::size_t first = 0; first < places.size();) {
      std::size_t end = first + 1;
      while (end < places.size() && is_alike(places[first], places[end])) ++end;
      begin("object");
      add("model", model_name(model));
      add_name(name);
      write_places(places, first, end);
      add_number("interest_levels", interest_levels, 0);
      write_ground(ground);
      first = end;
    }
  }

  void write_ground(const GroundRole& ground) {
    const auto& [kind, voxel_m, solid_above_per_m] = ground;
    if (kind == GroundRole::Kind::kNone) return;
    add("ground", kind == GroundRole::Kind::kCut ? "\"cut\"" : "\"add\"");
    add_number("voxel_m", voxel_m, 0);
    add_number("solid_above", solid_above_per_m, 0);
  }

  void write_places(const std::vector<Placing>& places, std::size_t first, std::size_t end) {
    const auto& [place, height_kind, height_m, heading_deg, pitch_deg, roll_deg, follows_slope, scale] =
        places[first];
    if (end - first == 1) {
      add("lon", toml_number(place.lon_deg));
      add("lat", toml_number(place.lat_deg));
    } else {
      text_ += "at = [\n";
      for (std::size_t n = first; n < end; ++n)
        text_ += "  [" + place_list(places[n].place) + ", " + toml_number(places[n].heading_deg) + "],\n";
      text_ += "]\n";
    }
    if (height_kind == HeightKind::kAltitude)
      add("altitude", toml_number(height_m));
    else
      add_number("height", height_m, 0);
    if (end - first == 1) add_number("heading", heading_deg, 0);
    add_number("pitch", pitch_deg, 0);
    add_number("roll", roll_deg, 0);
    add_number("scale", scale, 1);
    add_align(follows_slope);
  }

  void add_align(bool follows_slope) {
    if (follows_slope) add("align", "\"slope\"");
  }

  void write_path(const PathEntry& path) {
    const auto& [name, model, points, scale, wheelbase_m, track_m] = path;
    begin("path");
    add("model", model_name(model));
    add_name(name);
    add_number("scale", scale, 1);
    add_number("wheelbase_m", wheelbase_m, 0);
    add_number("track_m", track_m, 0);
    text_ += "points = [\n";
    for (const auto& [time_s, place, heading_deg, height_m] : points) {
      text_ += "  [" + toml_number(time_s) + ", " + place_list(place);
      if (heading_deg) {
        text_ += ", " + toml_number(*heading_deg);
      } else if (height_m != 0) {
        text_ += ", \"way\"";
      }
      if (height_m != 0) text_ += ", " + toml_number(height_m);
      text_ += "],\n";
    }
    text_ += "]\n";
  }

  void write_scatter(const ScatterEntry& scatter) {
    const auto& [name, models, polygon, seed, distribution, least_diameter_m, most_diameter_m, buried,
                 follows_slope, tumbles, most, where] = scatter;
    begin("scatter");
    add_name(name);
    std::string list;
    for (const std::size_t model : models) list += (list.empty() ? "" : ", ") + model_name(model);
    add("models", "[" + list + "]");
    text_ += "polygon = [\n";
    for (const mars::LonLat& corner : polygon) text_ += "  [" + place_list(corner) + "],\n";
    text_ += "]\n";
    add("seed", std::to_string(seed));
    if (const auto* power = std::get_if<PowerLaw>(&distribution)) {
      const auto& [density_per_m2, exponent] = *power;
      add("density_per_m2", toml_number(density_per_m2));
      add("exponent", toml_number(exponent));
    } else {
      add("rock_abundance", toml_number(std::get<RockAbundance>(distribution).k));
    }
    add("diameter_m", "[" + toml_number(least_diameter_m) + ", " + toml_number(most_diameter_m) + "]");
    add("buried", toml_number(buried));
    add_align(follows_slope);
    if (tumbles) add("tumble", "true");
    if (most != 0) add("most", std::to_string(most));
  }

  void write_poster(const PosterEntry& poster) {
    constexpr std::array<std::string_view, 4> kForms{"pane", "billboard", "photograph", "dome"};
    const auto& [name, file, form, place, height_kind, height_m, opacity, width_m, tall_m, heading_deg,
                 pitch_deg, roll_deg, fov_deg, distance_m, radius_m, fade_m, is_cylinder, replaces_ground] =
        poster;
    begin("picture");
    add_name(name);
    add("file", path_text(file, file_));
    add("form", "\"" + std::string(kForms[static_cast<std::size_t>(form)]) + "\"");
    if (place) {
      add("lon", toml_number(place->lon_deg));
      add("lat", toml_number(place->lat_deg));
      add(height_kind == HeightKind::kAltitude ? "altitude" : "height", toml_number(height_m));
    }
    add_number("opacity", opacity, 1);
    if (form == PosterForm::kPane || form == PosterForm::kBillboard) {
      add("width_m", toml_number(width_m));
      add_number("tall_m", tall_m, 0);
    }
    if (form == PosterForm::kPane) {
      add_number("heading", heading_deg, 0);
      add_number("tilt", pitch_deg, 0);
    } else if (form == PosterForm::kPhotograph) {
      add("yaw", toml_number(heading_deg));
      add_number("pitch", pitch_deg, 0);
      add_number("roll", roll_deg, 0);
      add("fov", toml_number(fov_deg));
      add("distance_m", toml_number(distance_m));
    } else if (form == PosterForm::kDome) {
      add("radius_m", toml_number(radius_m));
      add("fade_m", toml_number(fade_m));
      if (is_cylinder) add("shape", "\"cylinder\"");
      add_number("heading", heading_deg, 0);
      if (replaces_ground) add("replaces_ground", "true");
    }
  }

  void write_kiosk(const KioskEntry& kiosk) {
    const auto& [name, place, heading_deg, size_m, panorama, hotspots, beside_m] = kiosk;
    begin("kiosk");
    add("size_m", toml_number(size_m));
    if (!hotspots.empty()) {
      add("hotspots", path_text(hotspots, file_));
      add("beside_m", toml_number(beside_m));
      return;
    }
    add_name(name);
    add("lon", toml_number(place.lon_deg));
    add("lat", toml_number(place.lat_deg));
    add_number("heading", heading_deg, 0);
    if (!panorama.empty()) add("panorama", path_text(panorama, file_));
  }

  fs::path file_;
  std::vector<std::string> model_names_;  // in quotation marks
  std::string text_;
};

}  // namespace

std::string to_toml(const SceneFile& scene, const fs::path& file) {
  std::string text = SceneTomlWriter(scene, file).take();
  if (const std::string problem = problem_of_size(text); !problem.empty())
    throw std::invalid_argument("the scene is too large for a file: " + problem);
  return text;
}

void write_scene_file(const SceneFile& scene, const fs::path& file) {
  vpe::base::write_file(file, to_toml(scene, file));
}

}  // namespace objects
