#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "objects/files/scene_file.h"
#include "objects/files/scene_limits.h"
#include "vpe/base/quote.h"
#include "vpe/core/json_text.h"

namespace objects {

namespace {

using SceneJson = nlohmann::json;

class SceneJsonReader {
 public:
  explicit SceneJsonReader(const std::filesystem::path& path) { scene_.path = path; }

  SceneFile read(const SceneJson& root) {
    const SceneJson* type = root.is_object() ? member(root, "type") : nullptr;
    if (type == nullptr || *type != "FeatureCollection") fail("", "expected a FeatureCollection of GeoJSON");
    const SceneJson* features = member(root, "features");
    if (features == nullptr || !features->is_array()) fail("features", "expected a list of features");
    if (features->size() > kMostInstances) fail("features", too_many_instances());
    for (std::size_t n = 0; n < features->size(); ++n)
      read_feature((*features)[n], "features[" + std::to_string(n) + "]");
    return std::move(scene_);
  }

 private:
  [[noreturn]] void fail(const std::string& at, const std::string& what) const {
    throw std::runtime_error(scene_.path.string() + ": " + (at.empty() ? what : at + ": " + what));
  }

  static std::string found(const SceneJson& json) {
    if (json.is_structured()) return json.is_array() ? "a list" : "an object";
    return vpe::base::quote_text(json.is_string() ? json.get_ref<const std::string&>()
                                                  : vpe::core::json_text(json));
  }

  // Returns nullptr also for null.
  static const SceneJson* member(const SceneJson& object, const char* key) {
    const auto at = object.find(key);
    return at == object.end() || at->is_null() ? nullptr : &*at;
  }

  double checked(const SceneJson& json, const NumberRange& range, const std::string& at) const {
    const double value = json.is_number() ? json.get<double>() : 0;
    if (!json.is_number() || !is_within(value, range))
      fail(at, "expected " + range_text(range) + ", found " + found(json));
    return value;
  }

  double number(const SceneJson& properties, const char* key, double usual, const NumberRange& range,
                const std::string& at) const {
    const SceneJson* json = member(properties, key);
    return json == nullptr ? usual : checked(*json, range, at + "." + key);
  }

  std::string text(const SceneJson& json, const std::string& at) const {
    if (!json.is_string()) fail(at, "expected a text, found " + found(json));
    return json.get<std::string>();
  }

  void read_feature(const SceneJson& feature, const std::string& at) {
    const SceneJson* type = feature.is_object() ? member(feature, "type") : nullptr;
    if (type == nullptr || *type != "Feature") fail(at, "expected a Feature of GeoJSON");
    const SceneJson* geometry = member(feature, "geometry");
    const SceneJson* kind = geometry != nullptr && geometry->is_object() ? member(*geometry, "type") : nullptr;
    if (kind == nullptr || *kind != "Point") fail(at + ".geometry", "expected a Point");
    const SceneJson* coordinates = member(*geometry, "coordinates");
    const std::string where = at + ".geometry.coordinates";
    if (coordinates == nullptr || !coordinates->is_array() || coordinates->size() < 2 ||
        coordinates->size() > 3)
      fail(where, "expected [longitude, latitude]");
    Placing placing;
    placing.place = {mars::normalize_lon_deg(checked((*coordinates)[0], kLonRange_deg, where + "[0]")),
                     checked((*coordinates)[1], kLatRange_deg, where + "[1]")};
    const SceneJson* properties = member(feature, "properties");
    if (properties == nullptr || !properties->is_object())
      fail(at + ".properties", "expected an object with a \"model\"");
    read_properties(*properties, placing, at + ".properties");
  }

  void read_properties(const SceneJson& properties, Placing& placing, const std::string& at) {
    ObjectEntry object;
    const SceneJson* model = member(properties, "model");
    if (model == nullptr) fail(at + ".model", "expected the path of a model file");
    object.model = model_of(text(*model, at + ".model"), at + ".model");
    if (const SceneJson* name = member(properties, "name")) {
      object.name = text(*name, at + ".name");
      const std::string problem = object.name.empty() ? "" : problem_of_name(object.name);
      if (!problem.empty()) fail(at + ".name", problem + ", found " + found(*name));
    }
    placing.height_m = number(properties, "height", 0, kHeightRange_m, at);
    if (member(properties, "altitude") != nullptr) {
      if (member(properties, "height") != nullptr)
        fail(at + ".altitude", "expected altitude or height, not both");
      placing.height_m = number(properties, "altitude", 0, kHeightRange_m, at);
      placing.height_kind = HeightKind::kAltitude;
    }
    placing.heading_deg = number(properties, "heading", 0, kAngleRange_deg, at);
    placing.pitch_deg = number(properties, "pitch", 0, kAngleRange_deg, at);
    placing.roll_deg = number(properties, "roll", 0, kAngleRange_deg, at);
    placing.scale = number(properties, "scale", 1, kScaleRange, at);
    if (const SceneJson* align = member(properties, "align")) {
      if (*align != "vertical" && *align != "slope")
        fail(at + ".align", "expected vertical or slope, found " + found(*align));
      placing.follows_slope = *align == "slope";
    }
    object.places.push_back(placing);
    scene_.objects.push_back(std::move(object));
  }

  std::size_t model_of(const std::string& path, const std::string& at) {
    if (const std::string problem = problem_of_path(path); !problem.empty())
      fail(at, problem + ", found " + vpe::base::quote_text(path));
    const auto [known, is_new] = models_.try_emplace(path, scene_.models.size());
    if (is_new) scene_.models.push_back({path, model_path(scene_.path, path)});
    return known->second;
  }

  SceneFile scene_;
  std::map<std::string, std::size_t> models_;
};

}  // namespace

SceneFile parse_scene_geojson(std::string_view text, const std::filesystem::path& path) {
  const std::string problem = problem_of_size(text);
  if (!problem.empty()) throw std::runtime_error(path.string() + ": " + problem);
  SceneJson root;
  try {
    root = SceneJson::parse(text);
  } catch (const SceneJson::parse_error& e) {
    const auto until = text.begin() + static_cast<std::ptrdiff_t>(std::min(e.byte, text.size()));
    throw std::runtime_error(path.string() + ":" + std::to_string(1 + std::count(text.begin(), until, '\n')) +
                             ": not JSON; a file of GeoJSON is expected");
  } catch (const SceneJson::exception&) {
    throw std::runtime_error(path.string() + ": has a number that is too large");
  }
  return SceneJsonReader(path).read(root);
}

}  // namespace objects
