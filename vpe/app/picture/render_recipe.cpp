#include "vpe/app/picture/render_recipe.h"

#include <string_view>

#include "mars/geodesy/sphere.h"
#include "mars/sources/synthetic.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/app/picture/pose_option.h"
#include "vpe/base/file.h"
#include "vpe/base/json_integer.h"
#include "vpe/base/number.h"
#include "vpe/core/image/png_text.h"

namespace vpe::app {

namespace {

using base::format_number;
using nlohmann::ordered_json;

constexpr char kRecipeKeyword[] = "vpe";
constexpr std::uintmax_t kMostImageBytes = std::uintmax_t{1} << 32;

ordered_json eyes_json(const StereoArguments& stereo) {
  ordered_json out{
      {"layout", stereo.layout}, {"eye_base_m", stereo.eye_base_m}, {"convergence_m", stereo.convergence_m}};
  if (stereo.method.carries()) out["reproject_gap_px"] = stereo.method.gap_px;
  return out;
}

ordered_json recipe_json(const RenderRecipe& r) {
  ordered_json out{{"pose", pose_text(r.pose)}};
  if (r.cull_pose) out["cull_from"] = pose_text(*r.cull_pose);
  out["width"] = r.width;
  out["height"] = r.height;
  out["fov_deg"] = r.fov_deg;
  out["backend"] = core::to_string(r.backend);
  out["settings"] = r.settings;
  if (!r.interest.empty()) out["interest"] = r.interest;
  if (!r.stereo.layout.empty()) out["stereo"] = eyes_json(r.stereo);
  if (r.allow_underground) out["allow_underground"] = true;
  if (r.palette) out["palette"] = palette_json(r.palette);
  if (!r.earlier.empty()) out["earlier"] = r.earlier;
  return out;
}

RenderRecipe recipe_from(const nlohmann::json& top) {
  const nlohmann::json& from = top.at("recipe");
  RenderRecipe r;
  r.planet = top.at("planet").at("identity").get<std::string>();
  r.pose = parse_pose("pose", from.at("pose").get<std::string>()).pose;
  if (from.contains("cull_from"))
    r.cull_pose = parse_pose("cull_from", from["cull_from"].get<std::string>()).pose;
  const Size size = parse_size(std::to_string(base::json_integer<std::int64_t>(from.at("width"))) + "x" +
                               std::to_string(base::json_integer<std::int64_t>(from.at("height"))));
  r.width = size.width;
  r.height = size.height;
  r.fov_deg = from.at("fov_deg").get<double>();
  const auto backend = core::parse_backend(from.at("backend").get<std::string>());
  if (!backend) throw core::ImageError("its recipe names another backend");
  r.backend = *backend;
  r.settings = from.at("settings").get<std::vector<std::string>>();
  r.interest = from.value("interest", std::vector<std::string>());
  if (from.contains("stereo")) {
    const nlohmann::json& stereo = from["stereo"];
    r.stereo.layout = stereo.at("layout").get<std::string>();
    if (!core::parse_stereo(r.stereo.layout)) throw core::ImageError("its recipe names another stereo layout");
    r.stereo.eye_base_m = stereo.at("eye_base_m").get<double>();
    r.stereo.convergence_m = stereo.at("convergence_m").get<double>();
    if (stereo.contains("reproject_gap_px"))
      r.stereo.method = {"reproject", stereo["reproject_gap_px"].get<double>()};
  }
  r.allow_underground = from.value("allow_underground", false);
  r.earlier = from.value("earlier", std::string());
  return r;
}

}  // namespace

nlohmann::json palette_json(const std::optional<core::PaletteEnds>& palette) {
  if (!palette) return {};
  return {{"low", palette->low}, {"high", palette->high}};
}

std::vector<std::string> changed_settings(const core::Settings& settings, bool overlays) {
  std::vector<std::string> changed;
  for (const core::SettingInfo& info : core::Settings::list()) {
    if (!overlays && info.key.starts_with("overlay.")) continue;
    const std::string value = settings.get(info.key).value_or("");
    if (value != info.default_text) changed.push_back(std::string(info.key) + "=" + value);
  }
  return changed;
}

std::string pose_text(const mars::Pose& pose) {
  // One place has one text, so that equal images have equal files.
  return format_number(mars::normalize_lon_deg(pose.lon_deg)) + "," + format_number(pose.lat_deg) + "," +
         format_number(pose.alt_m) + "," + format_number(pose.yaw_deg) + "," + format_number(pose.pitch_deg) +
         "," + format_number(pose.roll_deg);
}

std::vector<core::PngText> recipe_texts(const RenderRecipe& recipe, const paging::PlanetMeta& planet,
                                        const ordered_json& certificate) {
  // Known only if ranges were asked for. Without it, equal images have equal files.
  ordered_json bounds = certificate;
  for (const char* eye : {"left", "right"}) {
    if (bounds.contains(eye)) bounds[eye].erase("picture_bound_px");
  }
  bounds.erase("picture_bound_px");
  const ordered_json json{{"version", version()},
                          {"planet",
                           {{"body", planet.body},
                            {"identity", recipe.planet},
                            {"illustration", planet.illustration},
                            {"synthetic", mars::synthetic_statement(planet.sources)}}},
                          {"recipe", recipe_json(recipe)},
                          {"certificate", bounds}};
  // A tEXt chunk holds ASCII.
  return {{"Software", std::string("vpe ") + version()},
          {kRecipeKeyword, json.dump(-1, ' ', true, ordered_json::error_handler_t::replace)}};
}

RenderRecipe read_recipe(const std::filesystem::path& image) {
  const auto refused = [&](const std::string& why) {
    return base::file_error("use", image, why, "give a PNG that 'vpe render' wrote");
  };
  const std::vector<std::uint8_t> bytes = base::read_file(image, kMostImageBytes);
  const auto texts = core::read_png_text(bytes);
  if (!texts) throw refused("no complete PNG");
  for (const core::PngText& text : *texts) {
    if (text.keyword != kRecipeKeyword) continue;
    try {
      return recipe_from(nlohmann::json::parse(text.text));
    } catch (const nlohmann::json::exception& e) {
      throw refused(e.what());
    } catch (const core::ImageError& e) {
      throw refused(e.what());
    } catch (const UsageError& e) {
      throw refused(e.what());
    }
  }
  throw refused("it holds no recipe");
}

core::TiffMetadata range_metadata(const mars::Pose& pose, const core::View& view,
                                  const paging::PlanetMeta& planet) {
  const core::SubRectangle part = core::drawn_part(view);
  const glm::dvec2 principal_px =
      glm::dvec2(0.5 * view.width, 0.5 * view.height) + view.principal_offset_px - glm::dvec2(part.x, part.y);
  core::TiffMetadata metadata;
  metadata.bands = {{"range", "m"}};
  metadata.nodata = "inf";
  metadata.items = {{"meaning", "distance from the camera to the ground along the ray of the pixel's centre"},
                    {"sky", "inf"},
                    {"camera_lon_deg", format_number(mars::normalize_lon_deg(pose.lon_deg))},
                    {"camera_lat_deg", format_number(pose.lat_deg)},
                    {"camera_alt_m", format_number(pose.alt_m)},
                    {"camera_yaw_deg", format_number(pose.yaw_deg)},
                    {"camera_pitch_deg", format_number(pose.pitch_deg)},
                    {"camera_roll_deg", format_number(pose.roll_deg)},
                    {"focal_px", format_number(core::focal_px(view))},
                    {"principal_point_px", format_number(principal_px.x) + "," + format_number(principal_px.y)},
                    {"vertical_fov_deg", format_number(view.fov_deg)},
                    {"planet_body", planet.body},
                    {"planet_radius_m", format_number(planet.radius_m)},
                    {"planet_identity", planet.identity}};
  metadata.software = std::string("vpe ") + version();
  return metadata;
}

}  // namespace vpe::app
