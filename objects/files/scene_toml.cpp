#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>

#include "objects/files/poster_toml.h"
#include "objects/files/scene_file.h"
#include "objects/files/scene_limits.h"
#include "objects/files/volume_model_file.h"
#include "vpe/base/quote.h"
#include "vpe/base/toml_table.h"

namespace objects {

namespace {

using vpe::base::TomlTable;

class SceneTomlReader {
 public:
  explicit SceneTomlReader(const std::filesystem::path& path) : file_(path.string()) { scene_.path = path; }

  SceneFile read(const toml::table& root) {
    const TomlTable top(root, "the file", file_);
    top.require_known({"version", "model", "volume", "object", "scatter", "path", "picture", "kiosk"});
    if (!top.has("version")) top.fail("version is missing; expected version = 1");
    top.integer("version", 1, 1);
    each(top, "model", "[[model]]", [this](const TomlTable& table) { read_model(table); });
    each(top, "volume", "[[volume]]", [this](const TomlTable& table) { read_volume(table); });
    each(top, "object", "[[object]]", [this](const TomlTable& table) { read_object(table); });
    each(top, "scatter", "[[scatter]]", [this](const TomlTable& table) { read_scatter(table); });
    each(top, "path", "[[path]]", [this](const TomlTable& table) { read_path(table); });
    each(top, "picture", "[[picture]]", [this](const TomlTable& table) {
      if (scene_.posters.size() == kMostPosters)
        table.fail("expected at most " + std::to_string(kMostPosters) + " tables [[picture]]");
      scene_.posters.push_back(read_poster(table, scene_.path));
    });
    each(top, "kiosk", "[[kiosk]]", [this](const TomlTable& table) {
      count_instances(table, 1);
      scene_.kiosks.push_back(read_kiosk(table, scene_.path));
    });
    return std::move(scene_);
  }

 private:
  void each(const TomlTable& top, std::string_view key, std::string_view title,
            const std::function<void(const TomlTable&)>& read_one) const {
    if (!top.has(key)) return;
    const toml::node& node = top.at(key);
    const toml::array* tables = node.as_array();
    if (tables == nullptr) top.fail_expecting(node, key, "tables " + std::string(title));
    for (const toml::node& table : *tables) {
      if (!table.is_table()) top.fail_expecting(table, key, "tables " + std::string(title));
      read_one(TomlTable(*table.as_table(), title, file_));
    }
  }

  void read_model(const TomlTable& table) {
    table.require_known({"name", "file", "unit_m", "up"});
    ModelEntry model;
    model.name = table.text("name", problem_of_name);
    model.file = model_path(scene_.path, table.text("file", problem_of_path));
    model.unit_m = table.number("unit_m", kUnitRange_m, 1);
    if (table.has("up")) model.up = static_cast<UpAxis>(table.choice("up", {"auto", "y", "z"}));
    add_model(table, std::move(model));
  }

  // Models and volumes have their names in common.
  void add_model(const TomlTable& table, ModelEntry model) {
    if (!models_.try_emplace(model.name, scene_.models.size()).second)
      table.fail(table.at("name"), "there are two models " + vpe::base::quote_text(model.name));
    scene_.models.push_back(std::move(model));
  }

  void read_volume(const TomlTable& table) {
    table.require_known(
        {"name", "kind", "height_m", "radius_m", "optical_depth", "lean_m", "colour", "seed", "voxels"});
    VolumeFormula formula;
    formula.kind = static_cast<VolumeKind>(table.choice("kind", {"dust-devil", "cloud", "plume"}));
    formula.height_m = table.number("height_m", kVolumeSizeRange_m);
    formula.radius_m = table.number("radius_m", kVolumeSizeRange_m);
    formula.optical_depth = table.number("optical_depth", kOpticalDepthRange, formula.optical_depth);
    formula.lean_m = table.number("lean_m", kLeanRange_m, formula.lean_m);
    if (formula.kind == VolumeKind::kCloud) formula.colour = {225, 220, 215, 255};
    if (table.has("colour")) {
      const toml::array& parts = table.list_of(table.at("colour"), "colour", 3, 3, "[red, green, blue]");
      const auto channel = [&](std::size_t n) {
        return static_cast<std::uint8_t>(std::lround(table.number_of(parts[n], "colour", kChannelRange)));
      };
      formula.colour = {channel(0), channel(1), channel(2), 255};
    }
    if (table.has("seed")) {
      formula.seed =
          static_cast<std::uint64_t>(table.integer("seed", 0, std::numeric_limits<std::int64_t>::max()));
    }
    if (table.has("voxels")) {
      formula.voxels = static_cast<int>(
          table.integer("voxels", VolumeFormulaLimits::kLeastVoxels, VolumeFormulaLimits::kMostVoxels));
    }
    if (const std::string problem = check(formula); !problem.empty()) table.fail("[[volume]]: " + problem);
    ModelEntry model;
    model.name = table.text("name", problem_of_name);
    model.formula = formula;
    add_model(table, std::move(model));
  }

  void read_object(const TomlTable& table) {
    table.require_known({"name", "model", "lon", "lat", "at", "height", "altitude", "heading", "pitch", "roll",
                         "scale", "align", "interest_levels", "ground", "voxel_m", "solid_above"});
    ObjectEntry object;
    object.name = name_of(table);
    object.model = model_of(table, table.at("model"), "model");
    object.interest_levels = table.number("interest_levels", kInterestRange, 0);
    Placing placing;
    placing.height_m = table.number("height", kHeightRange_m, 0);
    if (table.has("altitude")) {
      if (table.has("height")) table.fail(table.at("altitude"), "expected altitude or height, not both");
      placing.height_m = table.number("altitude", kHeightRange_m);
      placing.height_kind = HeightKind::kAltitude;
    }
    placing.heading_deg = table.number("heading", kAngleRange_deg, 0);
    placing.pitch_deg = table.number("pitch", kAngleRange_deg, 0);
    placing.roll_deg = table.number("roll", kAngleRange_deg, 0);
    placing.scale = table.number("scale", kScaleRange, 1);
    placing.follows_slope = follows_slope(table);
    read_ground(table, object);
    if (table.has("at")) {
      read_replicas(table, placing, object);
    } else {
      placing.place = {mars::normalize_lon_deg(table.number("lon", kLonRange_deg)),
                       table.number("lat", kLatRange_deg)};
      object.places.push_back(placing);
    }
    count_instances(table, object.places.size());
    scene_.objects.push_back(std::move(object));
  }

  void read_ground(const TomlTable& table, ObjectEntry& object) const {
    if (table.has("ground")) {
      object.ground.kind =
          table.choice("ground", {"add", "cut"}) == 0 ? GroundRole::Kind::kAdd : GroundRole::Kind::kCut;
    }
    for (const char* key : {"voxel_m", "solid_above"}) {
      if (table.has(key) && !table.has("ground"))
        table.fail(table.at(key), std::string(key) +
                                      " is for objects that are part of the ground; add ground = "
                                      "\"add\" or \"cut\"");
    }
    if (table.has("voxel_m")) object.ground.voxel_m = table.number("voxel_m", kGroundVoxelRange_m);
    if (!table.has("solid_above")) return;
    const ModelEntry& model = scene_.models[object.model];
    if (!model.formula && !is_volume_path(model.file))
      table.fail(table.at("solid_above"), "solid_above is for volumes, and " +
                                              vpe::base::quote_text(model.name) + " is none; leave it out");
    object.ground.solid_above_per_m = table.number("solid_above", kExtinctionRange_per_m);
  }

  void read_replicas(const TomlTable& table, const Placing& like, ObjectEntry& object) {
    if (table.has("lon") || table.has("lat"))
      table.fail(table.at("at"), "expected at, or lon and lat, not both");
    const toml::array& all = table.list("at", "[lon, lat] or [lon, lat, heading]");
    if (all.size() > kMostInstances) table.fail(all, too_many_instances());
    object.places.reserve(all.size());
    for (const toml::node& node : all) {
      const toml::array& parts = table.list_of(node, "at", 2, 3, "[lon, lat] or [lon, lat, heading]");
      Placing placing = like;
      placing.place = place_of(table, parts, 0);
      if (parts.size() == 3) placing.heading_deg = table.number_of(parts[2], "heading", kAngleRange_deg);
      object.places.push_back(placing);
    }
  }

  void read_scatter(const TomlTable& table) {
    table.require_known({"name", "models", "polygon", "seed", "density_per_m2", "exponent", "rock_abundance",
                         "diameter_m", "buried", "align", "tumble", "most"});
    ScatterEntry scatter;
    scatter.where = table.where();
    scatter.name = name_of(table);
    for (const toml::node& node : table.list("models", "names of models"))
      scatter.models.push_back(model_of(table, node, "models"));
    read_polygon(table, scatter);
    if (table.has("seed")) {
      scatter.seed =
          static_cast<std::uint64_t>(table.integer("seed", 0, std::numeric_limits<std::int64_t>::max()));
    }
    read_distribution(table, scatter);
    const toml::node& node = table.at("diameter_m");
    const toml::array& diameters = table.list_of(node, "diameter_m", 2, 2, "[least, most]");
    scatter.least_diameter_m = table.number_of(diameters[0], "diameter_m", kDiameterRange_m);
    scatter.most_diameter_m = table.number_of(diameters[1], "diameter_m", kDiameterRange_m);
    if (scatter.most_diameter_m < scatter.least_diameter_m)
      table.fail(node, "diameter_m: expected [least, most], found the larger one first");
    if (scatter.most_diameter_m == scatter.least_diameter_m && table.has("rock_abundance"))
      table.fail(node, "diameter_m: expected two diameters for rock_abundance, found one");
    scatter.buried = table.number("buried", kShareRange, scatter.buried);
    scatter.follows_slope = follows_slope(table);
    scatter.tumbles = table.has("tumble") && table.truth("tumble");
    if (table.has("most")) scatter.most = static_cast<std::size_t>(table.integer("most", 1, kMostInstances));
    scene_.scatters.push_back(std::move(scatter));
  }

  static void read_polygon(const TomlTable& table, ScatterEntry& scatter) {
    const toml::array& corners = table.list("polygon", "corners [lon, lat]");
    if (corners.size() < 3 || corners.size() > kMostPolygonCorners) {
      table.fail_expecting(corners, "polygon",
                           "3 to " + std::to_string(kMostPolygonCorners) + " corners [lon, lat]");
    }
    for (const toml::node& corner : corners)
      scatter.polygon.push_back(place_of(table, table.list_of(corner, "polygon", 2, 2, "[lon, lat]"), 0));
  }

  static void read_distribution(const TomlTable& table, ScatterEntry& scatter) {
    const bool is_power = table.has("density_per_m2") || table.has("exponent");
    if (table.has("rock_abundance") == is_power)
      table.fail("expected rock_abundance, or density_per_m2 and exponent, in [[scatter]]");
    if (is_power)
      scatter.distribution = PowerLaw{table.number("density_per_m2", kDensityRange_per_m2),
                                      table.number("exponent", kExponentRange)};
    else
      scatter.distribution = RockAbundance{table.number("rock_abundance", kAbundanceRange)};
  }

  void read_path(const TomlTable& table) {
    table.require_known({"name", "model", "points", "scale", "wheelbase_m", "track_m"});
    PathEntry path;
    path.name = name_of(table);
    path.model = model_of(table, table.at("model"), "model");
    path.scale = table.number("scale", kScaleRange, 1);
    if (table.has("wheelbase_m") || table.has("track_m")) {
      path.wheelbase_m = table.number("wheelbase_m", kWheelRange_m);
      path.track_m = table.number("track_m", kWheelRange_m);
    }
    constexpr std::string_view kForm = "[seconds, lon, lat], then heading and height if wanted";
    for (const toml::node& node : table.list("points", kForm)) {
      const toml::array& parts = table.list_of(node, "points", 3, 5, kForm);
      PathPoint point{table.number_of(parts[0], "time", kTimeRange_s), place_of(table, parts, 1)};
      const bool is_along_way = parts.size() > 4 && parts[3].value<std::string>() == "way";
      if (parts.size() > 3 && !is_along_way)
        point.heading_deg = table.number_of(parts[3], "heading", kAngleRange_deg);
      if (parts.size() > 4) point.height_m = table.number_of(parts[4], "height", kHeightRange_m);
      if (!path.points.empty() && point.time_s <= path.points.back().time_s)
        table.fail_expecting(parts[0], "time", "a later one than that of the point before");
      path.points.push_back(point);
    }
    count_instances(table, 1);
    scene_.paths.push_back(std::move(path));
  }

  static bool follows_slope(const TomlTable& table) {
    return table.has("align") && table.choice("align", {"vertical", "slope"}) == 1;
  }

  static std::string name_of(const TomlTable& table) {
    return table.has("name") ? table.text("name", problem_of_name) : "";
  }

  static mars::LonLat place_of(const TomlTable& table, const toml::array& parts, std::size_t first) {
    return {mars::normalize_lon_deg(table.number_of(parts[first], "lon", kLonRange_deg)),
            table.number_of(parts[first + 1], "lat", kLatRange_deg)};
  }

  std::size_t model_of(const TomlTable& table, const toml::node& node, std::string_view key) const {
    const auto* name = node.as_string();
    if (name == nullptr) table.fail_expecting(node, key, "the name of a model");
    const auto found = models_.find(name->get());
    if (found == models_.end())
      table.fail(node, "there is no [[model]] with the name " + vpe::base::quote_text(name->get()));
    return found->second;
  }

  void count_instances(const TomlTable& table, std::size_t more) {
    instances_ += more;
    if (instances_ > kMostInstances) table.fail(too_many_instances());
  }

  std::string file_;
  SceneFile scene_;
  std::map<std::string, std::size_t> models_;
  std::size_t instances_ = 0;
};

}  // namespace

SceneFile parse_scene_toml(std::string_view text, const std::filesystem::path& path) {
  const std::string problem = problem_of_size(text);
  if (!problem.empty()) throw std::runtime_error(path.string() + ":1: " + problem);
  return SceneTomlReader(path).read(vpe::base::parse_toml(text, path.string()));
}

}  // namespace objects
