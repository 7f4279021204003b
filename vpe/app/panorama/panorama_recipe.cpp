// The recipe of a panorama as JSON.
#include <cmath>
#include <type_traits>
#include <utility>

#include "mars/geodesy/sphere.h"
#include "panorama/image/metadata_error.h"
#include "vpe/app/panorama/panorama_request.h"
#include "vpe/base/json_integer.h"
#include "vpe/warp/carry.h"

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
    if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>)
      return base::json_integer<Value>(*found);
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

// Returns the object under a key.
const json& object(const json& from, const char* key) {
  const auto found = from.is_object() ? from.find(key) : from.end();
  if (found == from.end() || !found->is_object()) {
    throw MetadataError(std::string("recipe: ") + key + " is missing or not an object {...}");
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
  put(out, "carried_gap_px", eyes.carried_gap_px);
  return out;
}

panorama::EyePair stereo_from(const json& from) {
  panorama::EyePair eyes;
  const auto layout = core::parse_stereo(needed<std::string>(from, "layout"));
  if (!layout) throw MetadataError("recipe: stereo: layout is not sbs, ou or anaglyph");
  eyes.layout = *layout;
  eyes.base_m = needed<double>(from, "eye_base_m");
  eyes.nearest_m = find<double>(from, "nearest_m");
  eyes.carried_gap_px = find<double>(from, "carried_gap_px");
  if (eyes.carried_gap_px &&
      !(*eyes.carried_gap_px > 0 && *eyes.carried_gap_px <= warp::CarryLimits::kMaxGap_px))
    throw MetadataError("recipe: stereo: carried_gap_px is not above 0 and at most 16");
  if (const std::string trouble = panorama::check(eyes); !trouble.empty())
    throw MetadataError("recipe: stereo: " + trouble);
  return eyes;
}

core::Backend backend_from(const std::string& text) {
  const auto backend = core::parse_backend(text);
  if (!backend) throw MetadataError("recipe: backend '" + text + "' is not known");
  return *backend;
}

std::string layers_text(const std::vector<panorama::Plane>& layers) {
  std::string text;
  for (const panorama::Plane layer : layers)
    text += (text.empty() ? "" : ",") + std::string(panorama::info_of(layer).name);
  return text;
}

void set_setting(core::Settings& settings, const std::string& key, const json& value) {
  const std::string trouble =
      value.is_string() ? settings.set(key, value.get<std::string>()) : "it is not a text";
  if (!trouble.empty()) throw MetadataError("recipe: settings: " + key + ": " + trouble);
}

}  // namespace

nlohmann::ordered_json recipe_json(const PanoramaRequest& request) {
  nlohmann::ordered_json out;
  out["planet"] = {{"file", request.planet}, {"identity", request.identity}};
  out["backend"] = core::to_string(request.backend);
  out["eye"] = {{"lon_deg", request.camera.lon_deg},
                {"lat_deg", request.camera.lat_deg},
                {"alt_m", request.camera.alt_m}};
  out["plan"] = plan_json(request.map);
  out["planes"] = layers_text(request.layers);
  if (request.stereo) out["stereo"] = stereo_json(*request.stereo);
  out["interest"] = request.interest;
  out["memory_mb"] = request.memory_mb;
  out["allow_incomplete"] = request.allow_incomplete;
  if (!request.names_checksum.empty()) out["names_checksum"] = request.names_checksum;
  if (!request.layers_checksum.empty()) out["layers_checksum"] = request.layers_checksum;
  if (!request.scene_checksum.empty()) out["scene_checksum"] = request.scene_checksum;
  nlohmann::ordered_json settings;
  for (const core::SettingInfo& info : core::Settings::list())
    settings[std::string(info.key)] = request.settings.get(info.key).value_or("");
  out["settings"] = settings;
  return out;
}

PanoramaRequest request_from_recipe(const json& from) {
  PanoramaRequest request;
  const json& planet = object(from, "planet");
  request.planet = needed<std::string>(planet, "file");
  request.identity = needed<std::string>(planet, "identity");
  request.backend = backend_from(needed<std::string>(from, "backend"));
  const json& camera = object(from, "eye");
  request.camera.lon_deg = needed<double>(camera, "lon_deg");
  request.camera.lat_deg = needed<double>(camera, "lat_deg");
  request.camera.alt_m = needed<double>(camera, "alt_m");
  if (!mars::is_valid({request.camera.lon_deg, request.camera.lat_deg}) ||
      !std::isfinite(request.camera.alt_m)) {
    throw MetadataError("recipe: eye: not a valid place; latitudes are -90 to 90");
  }
  request.map = plan_from(object(from, "plan"));
  try {
    request.layers = panorama::parse_planes(needed<std::string>(from, "planes"));
  } catch (const panorama::PlanError& e) {
    throw MetadataError(std::string("recipe: ") + e.what());
  }
  if (from.contains("stereo")) request.stereo = stereo_from(object(from, "stereo"));
  request.interest = needed<std::vector<std::string>>(from, "interest");
  request.memory_mb = needed<int>(from, "memory_mb");
  request.allow_incomplete = needed<bool>(from, "allow_incomplete");
  request.names_checksum = find<std::string>(from, "names_checksum").value_or("");
  request.layers_checksum = find<std::string>(from, "layers_checksum").value_or("");
  request.scene_checksum = find<std::string>(from, "scene_checksum").value_or("");
  for (const auto& [key, value] : object(from, "settings").items()) set_setting(request.settings, key, value);
  return request;
}

}  // namespace vpe::app
