#include "vpe/app/panorama/panorama_recipe.h"

#include <cmath>
#include <type_traits>
#include <utility>

#include "mars/geodesy/sphere.h"
#include "panorama/image/metadata_error.h"

namespace vpe::app {

namespace {

using nlohmann::json;
using panorama::MetadataError;
using panorama::PlanOptions;

template <class Value>
void put(nlohmann::ordered_json& out, const char* key, const std::optional<Value>& value) {
  if (value) out[key] = *value;
}

[[noreturn]] void refuse(const char* key) {
  throw MetadataError(std::string("recipe: ") + key + " is of the wrong type");
}

template <class Value>
std::optional<Value> find(const json& from, const char* key) {
  const auto found = from.find(key);
  if (found == from.end()) return std::nullopt;
  try {
    // The library makes a whole number of any other and of what does not fit.
    if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>) {
      const bool fits = found->is_number_unsigned() ? std::in_range<Value>(found->get<std::uint64_t>())
                                                    : std::in_range<Value>(found->get<std::int64_t>());
      if (!found->is_number_integer() || !fits) refuse(key);
    }
    return found->get<Value>();
  } catch (const json::exception&) {
    refuse(key);
  }
}

template <class Value>
Value needed(const json& from, const char* key) {
  if (auto value = find<Value>(from, key)) return *value;
  throw MetadataError(std::string("recipe: ") + key + " is missing");
}

const json& object(const json& from, const char* key) {
  const auto found = from.is_object() ? from.find(key) : from.end();
  if (found == from.end() || !found->is_object()) {
    throw MetadataError(std::string("recipe: ") + key + " is missing or no object {...}");
  }
  return *found;
}

nlohmann::ordered_json plan_json(const PlanOptions& plan) {
  nlohmann::ordered_json out;
  out["projection"] = panorama::to_string(plan.kind);
  if (plan.kind == panorama::MapKind::kFacets) out["facets"] = plan.facets;
  out["yaw_deg"] = plan.yaw_deg;
  if (plan.arc) out["from_deg"] = plan.arc->from_deg;
  if (plan.arc) out["to_deg"] = plan.arc->to_deg;
  put(out, "lowest_deg", plan.lowest_deg);
  put(out, "highest_deg", plan.highest_deg);
  put(out, "width", plan.width_px);
  put(out, "degrees_per_pixel", plan.degrees_per_pixel);
  return out;
}

PlanOptions plan_from(const json& from) {
  using panorama::MapKind;
  PlanOptions plan;
  const auto name = needed<std::string>(from, "projection");
  bool is_known = false;
  for (const MapKind kind : {MapKind::kCylinder, MapKind::kEquirectangular, MapKind::kFacets}) {
    if (name == panorama::to_string(kind)) plan.kind = kind;
    is_known = is_known || name == panorama::to_string(kind);
  }
  if (!is_known) throw MetadataError("recipe: projection '" + name + "' is not known");
  plan.facets = find<int>(from, "facets").value_or(plan.facets);
  plan.yaw_deg = needed<double>(from, "yaw_deg");
  const auto from_deg = find<double>(from, "from_deg");
  if (from_deg) plan.arc = {*from_deg, needed<double>(from, "to_deg")};
  plan.lowest_deg = find<double>(from, "lowest_deg");
  plan.highest_deg = find<double>(from, "highest_deg");
  plan.width_px = find<std::int64_t>(from, "width");
  plan.degrees_per_pixel = find<double>(from, "degrees_per_pixel");
  return plan;
}

nlohmann::ordered_json stereo_json(const panorama::EyePair& eyes) {
  nlohmann::ordered_json out;
  out["layout"] = core::to_string(eyes.layout);
  out["eye_base_m"] = eyes.base_m;
  put(out, "nearest_m", eyes.nearest_m);
  return out;
}

panorama::EyePair stereo_from(const json& from) {
  panorama::EyePair eyes;
  const auto layout = core::parse_stereo(needed<std::string>(from, "layout"));
  if (!layout) throw MetadataError("recipe: stereo: layout is not sbs, ou or anaglyph");
  eyes.layout = *layout;
  eyes.base_m = needed<double>(from, "eye_base_m");
  eyes.nearest_m = find<double>(from, "nearest_m");
  if (const std::string trouble = panorama::check(eyes); !trouble.empty())
    throw MetadataError("recipe: stereo: " + trouble);
  return eyes;
}

}  // namespace

nlohmann::ordered_json to_json(const PanoramaRecipe& recipe) {
  nlohmann::ordered_json out;
  out["planet"] = {{"file", recipe.planet}, {"identity", recipe.identity}};
  out["backend"] = recipe.backend;
  out["eye"] = {
      {"lon_deg", recipe.camera.lon_deg}, {"lat_deg", recipe.camera.lat_deg}, {"alt_m", recipe.camera.alt_m}};
  out["plan"] = plan_json(recipe.plan);
  std::string planes;
  for (const panorama::Plane plane : recipe.planes)
    planes += (planes.empty() ? "" : ",") + std::string(panorama::info_of(plane).name);
  out["planes"] = planes;
  if (recipe.stereo) out["stereo"] = stereo_json(*recipe.stereo);
  out["interest"] = recipe.interest;
  out["memory_mb"] = recipe.memory_mb;
  out["allow_incomplete"] = recipe.allow_incomplete;
  if (!recipe.names_checksum.empty()) out["names_checksum"] = recipe.names_checksum;
  nlohmann::ordered_json settings;
  for (const core::SettingInfo& info : core::Settings::list())
    settings[std::string(info.key)] = recipe.settings.get(info.key).value_or("");
  out["settings"] = settings;
  return out;
}

PanoramaRecipe recipe_from(const json& from) {
  PanoramaRecipe recipe;
  const json& planet = object(from, "planet");
  recipe.planet = needed<std::string>(planet, "file");
  recipe.identity = needed<std::string>(planet, "identity");
  recipe.backend = needed<std::string>(from, "backend");
  const json& camera = object(from, "eye");
  recipe.camera.lon_deg = needed<double>(camera, "lon_deg");
  recipe.camera.lat_deg = needed<double>(camera, "lat_deg");
  recipe.camera.alt_m = needed<double>(camera, "alt_m");
  if (!mars::is_valid({recipe.camera.lon_deg, recipe.camera.lat_deg}) || !std::isfinite(recipe.camera.alt_m)) {
    throw MetadataError("recipe: eye is no place; latitudes are -90 to 90");
  }
  recipe.plan = plan_from(object(from, "plan"));
  try {
    recipe.planes = panorama::parse_planes(needed<std::string>(from, "planes"));
  } catch (const panorama::PlanError& e) {
    throw MetadataError(std::string("recipe: ") + e.what());
  }
  if (from.contains("stereo")) recipe.stereo = stereo_from(object(from, "stereo"));
  recipe.interest = needed<std::vector<std::string>>(from, "interest");
  recipe.memory_mb = needed<int>(from, "memory_mb");
  recipe.allow_incomplete = needed<bool>(from, "allow_incomplete");
  recipe.names_checksum = find<std::string>(from, "names_checksum").value_or("");
  for (const auto& [key, text] : object(from, "settings").items()) {
    const std::string trouble =
        text.is_string() ? recipe.settings.set(key, text.get<std::string>()) : "it is not a text";
    if (!trouble.empty()) throw MetadataError("recipe: settings: " + key + ": " + trouble);
  }
  return recipe;
}

}  // namespace vpe::app
